// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "commands.hpp"
#include "loopmark/core/interrupt.hpp"
#include "loopmark/page_server/page_server.hpp"
#include "loopmark/workflows/view_session.hpp"

namespace loopmark::app {
namespace {

struct ViewArguments {
  std::filesystem::path run;
  int port = 0;
  bool no_open = false;
};

constexpr const char* kExamples = R"(Examples:
  loopmark view runs/day1                        opens the map in the browser; Ctrl-C ends it
  loopmark view runs/day1 --no-open --port 8765  only prints the page's address
  ssh -L 8765:127.0.0.1:8765 host                then, on this machine, the address that view printed on the host
The page is that of report.html, and can change the run: veto or force a loop, try two places as one, see the map
solved again, undo, save. A change is kept in memory until it is saved; what was not saved is printed at the end as a
command. The server listens on this machine only, at an address that cannot be guessed.)";

void declare(CLI::App& command, ViewArguments& a) {
  command.add_option("RUN", a.run, "run folder of loopmark map")->required();
  command.add_option("--port", a.port, "port to listen on; else any that is free")->check(CLI::Range(1, 65535));
  command.add_flag("--no-open", a.no_open, "do not start a browser");
  command.footer(kExamples);
}

/// Starts the browser of the desktop. The address holds digits and letters only.
void open_browser(const std::string& url) {
  if (std::getenv("DISPLAY") == nullptr && std::getenv("WAYLAND_DISPLAY") == nullptr) {
    return;
  }
  if (std::system(("xdg-open " + url + " >/dev/null 2>&1 &").c_str()) != 0) {
    std::puts("no browser could be started: open the address yourself");
  }
}

int view(const ViewArguments& a) {
  workflows::ViewSession session(a.run);
  page_server::PageServer server(
      {[&] { return session.page(); },
       [&](const std::string& action, const std::string& words) { return session.act(action, words); }},
      a.port);
  std::printf("%s\nCtrl-C ends it\n", server.url().c_str());
  std::fflush(stdout);
  if (!a.no_open) {
    open_browser(server.url());
  }
  server.run([] { return interrupt_requested(); });
  const std::vector<std::string> unsaved = session.unsaved();
  if (!unsaved.empty()) {
    std::printf("not saved; to make these changes: loopmark loops %s", a.run.c_str());
    for (const std::string& option : unsaved) {
      std::printf(" %s", option.c_str());
    }
    std::puts("");
  }
  return 0;
}

}  // namespace

Action set_up_view(CLI::App& command, const Globals&) {
  auto arguments = std::make_shared<ViewArguments>();
  declare(command, *arguments);
  return [arguments] { return view(*arguments); };
}

}  // namespace loopmark::app
