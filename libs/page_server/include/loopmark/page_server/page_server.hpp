// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A page for the person at this machine, from a server that nobody else can reach or guess.
#pragma once

#include <functional>
#include <memory>
#include <string>

namespace loopmark::page_server {

/// What the server gives. Called one at a time, from a thread of the server.
struct Handlers {
  std::function<std::string()> page;  ///< the page, as HTML
  /// What the page asks to be done: its name and what it sent with it. The answer is HTML. An InputError becomes an
  /// answer that tells the person what is wrong (status 400).
  std::function<std::string(const std::string& action, const std::string& body)> act;
};

/// Listens on the loopback interface only. The page has an address that cannot be guessed (128 random bits in its
/// path); every other address is answered with 404, and a request that was sent to another host's name with 403, so
/// that no page of the web can reach it through a name of its own (DNS rebinding).
class PageServer {
 public:
  /// `port` 0: any that is free. Throws InputError when the port cannot be had.
  PageServer(Handlers handlers, int port);
  ~PageServer();

  int port() const;
  std::string url() const;  ///< of the page

  /// Serves until `stop` returns true; looks every tenth of a second.
  void run(const std::function<bool()>& stop);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace loopmark::page_server
