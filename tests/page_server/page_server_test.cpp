// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/page_server/page_server.hpp"

#include <gtest/gtest.h>
#include <httplib.h>

#include <atomic>
#include <thread>

#include "loopmark/core/error.hpp"

namespace loopmark::page_server {
namespace {

/// A server that runs until the end of the scope.
class Running {
 public:
  Running()
      : server_({[] { return std::string("the page"); },
                 [](const std::string& action, const std::string& body) {
                   if (body == "wrong") {
                     throw InputError("body", "1", "makes no sense", "send another");
                   }
                   return action + " of " + body;
                 }},
                0),
        thread_([this] { server_.run([this] { return over_.load(); }); }) {}
  ~Running() {
    over_ = true;
    thread_.join();
  }
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  std::string path() const { return server_.url().substr(server_.url().find('/', 7)); }
  httplib::Client client() const {
    httplib::Client client("127.0.0.1", server_.port());
    client.set_connection_timeout(10);
    return client;
  }

 private:
  std::atomic<bool> over_ = false;
  PageServer server_;
  std::thread thread_;
};

TEST(PageServer, GivesThePageAtItsAddressAndNothingElse) {
  const Running server;
  httplib::Client client = server.client();
  const auto page = client.Get(server.path().c_str());
  ASSERT_TRUE(page);
  EXPECT_EQ(page->status, 200);
  EXPECT_EQ(page->body, "the page");
  for (const std::string& other :
       {std::string("/"), std::string("/index.html"), std::string("/0123456789abcdef0123456789abcdef/"),
        server.path() + "../etc/passwd", server.path() + "loops"}) {
    const auto answer = client.Get(other.c_str());
    ASSERT_TRUE(answer) << other;
    EXPECT_EQ(answer->status, 404) << other;
    EXPECT_EQ(answer->body, "") << other;
  }
}

TEST(PageServer, DoesWhatIsAskedAndTellsWhatIsWrong) {
  const Running server;
  httplib::Client client = server.client();
  const auto done = client.Post((server.path() + "loops").c_str(), "veto", "text/plain");
  ASSERT_TRUE(done);
  EXPECT_EQ(done->body, "loops of veto");
  const auto wrong = client.Post((server.path() + "loops").c_str(), "wrong", "text/plain");
  ASSERT_TRUE(wrong);
  EXPECT_EQ(wrong->status, 400);
  EXPECT_NE(wrong->body.find("makes no sense"), std::string::npos);
}

TEST(PageServer, RefusesRequestsThatWereSentToAnotherName) {
  const Running server;
  httplib::Client client = server.client();
  const auto answer = client.Get(server.path().c_str(), {{"Host", "rebound.example:80"}});
  ASSERT_TRUE(answer);
  EXPECT_EQ(answer->status, 403);
  EXPECT_EQ(answer->body, "");
  const auto tunnel = client.Get(server.path().c_str(), {{"Host", "localhost:8000"}});
  ASSERT_TRUE(tunnel);
  EXPECT_EQ(tunnel->status, 200);
}

TEST(PageServer, ForbidsFramesCachesAndGuesses) {
  const Running server;
  const auto page = server.client().Get(server.path().c_str());
  ASSERT_TRUE(page);
  EXPECT_EQ(page->get_header_value("Cache-Control"), "no-store");
  EXPECT_EQ(page->get_header_value("Content-Security-Policy"), "frame-ancestors 'none'");
  EXPECT_EQ(page->get_header_value("Referrer-Policy"), "no-referrer");
}

TEST(PageServer, EveryServerHasAnAddressOfItsOwn) {
  const Running one;
  const Running other;
  EXPECT_NE(one.path(), other.path());
  EXPECT_EQ(one.path().size(), 34U);
}

TEST(PageServer, APortThatIsTakenIsAnInputError) {
  PageServer first({[] { return std::string(); }, {}}, 0);
  EXPECT_THROW(PageServer({[] { return std::string(); }, {}}, first.port()), InputError);
}

}  // namespace
}  // namespace loopmark::page_server
