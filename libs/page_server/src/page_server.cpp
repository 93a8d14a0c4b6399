// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/page_server/page_server.hpp"

#include <httplib.h>
#include <sys/random.h>
#include <sys/socket.h>

#include <array>
#include <atomic>
#include <chrono>
#include <mutex>
#include <stdexcept>
#include <thread>
#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::page_server {
namespace {

constexpr const char* kLoopback = "127.0.0.1";
constexpr std::size_t kMaxRequest = 65536;  // bytes; the page sends the name of a loop

/// 128 random bits as hexadecimal digits.
std::string random_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw std::runtime_error("the system has no random numbers");
  }
  std::string token;
  for (const unsigned char byte : bytes) {
    constexpr const char* kDigits = "0123456789abcdef";
    token += kDigits[byte >> 4];
    token += kDigits[byte & 15];
  }
  return token;
}

/// Whether a Host header names this machine, at whatever port (a tunnel may come from another one).
bool is_loopback(const std::string& host) {
  const std::string name = host.substr(0, host.rfind(':'));
  return name == kLoopback || name == "localhost";
}

void protect(httplib::Response& response) {
  response.set_header("Cache-Control", "no-store");
  response.set_header("Content-Security-Policy", "frame-ancestors 'none'");
  response.set_header("Cross-Origin-Resource-Policy", "same-origin");
  response.set_header("Referrer-Policy", "no-referrer");
  response.set_header("X-Content-Type-Options", "nosniff");
}

}  // namespace

struct PageServer::State {
  Handlers handlers;
  std::string token = random_token();
  httplib::Server server;
  std::mutex one_at_a_time;
  int port = 0;

  void set_up() {
    server.set_payload_max_length(kMaxRequest);
    // Without httplib's SO_REUSEPORT: a port that another server listens on is taken.
    server.set_socket_options([](socket_t socket) {
      const int yes = 1;
      ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
    server.set_pre_routing_handler([](const httplib::Request& request, httplib::Response& response) {
      protect(response);
      if (is_loopback(request.get_header_value("Host"))) {
        return httplib::Server::HandlerResponse::Unhandled;
      }
      response.status = 403;
      return httplib::Server::HandlerResponse::Handled;
    });
    server.Get("/" + token + "/", [this](const httplib::Request&, httplib::Response& response) {
      const std::lock_guard lock(one_at_a_time);
      response.set_content(handlers.page(), "text/html; charset=utf-8");
    });
    server.Post("/" + token + "/([a-z]+)",
                [this](const httplib::Request& request, httplib::Response& response) { act(request, response); });
  }

  void act(const httplib::Request& request, httplib::Response& response) {
    const std::lock_guard lock(one_at_a_time);
    try {
      response.set_content(handlers.act(request.matches[1], request.body), "text/html; charset=utf-8");
    } catch (const InputError& problem) {
      response.status = 400;
      response.set_content(problem.what(), "text/plain; charset=utf-8");
    }
  }
};

PageServer::PageServer(Handlers handlers, int port) : state_(std::make_unique<State>()) {
  state_->handlers = std::move(handlers);
  state_->set_up();
  if (port == 0) {
    state_->port = state_->server.bind_to_any_port(kLoopback);
  } else if (state_->server.bind_to_port(kLoopback, port)) {
    state_->port = port;
  }
  if (state_->port <= 0) {
    throw InputError("port " + std::to_string(port), "", "cannot be listened on",
                     "choose another, or leave --port out");
  }
}

PageServer::~PageServer() = default;

int PageServer::port() const { return state_->port; }

std::string PageServer::url() const {
  return "http://" + std::string(kLoopback) + ":" + std::to_string(state_->port) + "/" + state_->token + "/";
}

void PageServer::run(const std::function<bool()>& stop) {
  using std::chrono::milliseconds;
  std::atomic<bool> ended = false;
  std::thread listener([&] {
    state_->server.listen_after_bind();
    ended = true;
  });
  while (!ended && !state_->server.is_running()) {
    std::this_thread::sleep_for(milliseconds(1));  // a server that does not run yet cannot be stopped
  }
  while (!ended && !stop()) {
    std::this_thread::sleep_for(milliseconds(100));
  }
  const bool by_itself = ended;
  state_->server.stop();
  listener.join();
  if (by_itself) {
    throw std::runtime_error("the server of the page ended by itself");
  }
}

}  // namespace loopmark::page_server
