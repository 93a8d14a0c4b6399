// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/run_folder.hpp"

#include <fcntl.h>

#include <cstdio>
#include <utility>

#include "loopmark/core/error.hpp"

namespace loopmark::map_store {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPartial = ".partial";

fs::path plain(const fs::path& run) {
  const std::string text = run.string();
  fs::path result = text.size() > 1 && text.back() == '/' ? fs::path(text.substr(0, text.size() - 1)) : run;
  return result.extension() == kPartial ? result.replace_extension() : result;
}

fs::path partial(const fs::path& run) { return fs::path(plain(run).string() + kPartial); }

}  // namespace

RunFolder::RunFolder(fs::path path, fs::path name) : path_(std::move(path)), name_(std::move(name)) {}

RunFolder RunFolder::create(const fs::path& run) {
  const fs::path name = plain(run);
  const fs::path path = partial(run);
  if (fs::exists(name)) {
    throw InputError(name.string(), "", "is there already and is never overwritten", "choose another name for -o");
  }
  if (fs::exists(path)) {
    throw InputError(path.string(), "", "an interrupted run is there",
                     "continue it with: loopmark map --resume " + name.string() + ", or delete it");
  }
  std::error_code error;
  fs::create_directories(path / "records", error);
  if (!error) {
    fs::create_directories(path / "keyframes", error);
  }
  if (error) {
    std::error_code ignored;
    fs::remove_all(path, ignored);
    throw InputError(path.string(), "", "cannot be made: " + error.message(),
                     "choose a folder that can be written for -o");
  }
  return {path, name};
}

RunFolder RunFolder::resume(const fs::path& run) {
  if (fs::exists(plain(run))) {
    throw InputError(plain(run).string(), "", "the run is whole", "there is nothing to resume");
  }
  if (!fs::exists(partial(run) / "records")) {
    throw InputError(partial(run).string(), "", "there is no interrupted run",
                     "start one with: loopmark map LOG -o RUN");
  }
  return {partial(run), plain(run)};
}

RunFolder RunFolder::open(const fs::path& run) {
  if (!fs::exists(plain(run) / "manifest.json")) {
    const bool interrupted = fs::exists(partial(run));
    throw InputError(plain(run).string(), "", interrupted ? "the run is not whole yet" : "there is no run",
                     interrupted ? "finish it with: loopmark map --resume " + plain(run).string() : "");
  }
  return {plain(run), plain(run)};
}

RunFolder RunFolder::revise(const fs::path& run) {
  const RunFolder old = open(run);
  const fs::path path = partial(run);
  if (fs::exists(path)) {
    throw InputError(path.string(), "", "an unfinished change of the run is there", "delete it, then try again");
  }
  std::error_code error;
  fs::create_directories(path / "records", error);
  if (error) {
    throw InputError(path.string(), "", "cannot be made: " + error.message(), "write a new run with -o");
  }
  return {path, old.path()};
}

fs::path RunFolder::keyframe(std::size_t number, const std::string& ending) const {
  char text[32];
  std::snprintf(text, sizeof text, "%06zu.", number);
  return path_ / "keyframes" / (text + ending);
}

void RunFolder::finish() {
  std::error_code error;
  fs::rename(path_, name_, error);
  if (error) {
    throw InputError(path_.string(), "", "cannot be renamed to " + name_.string() + ": " + error.message());
  }
  path_ = name_;
}

fs::path RunFolder::finish_revision() {
  fs::path before;
  for (std::size_t i = 1; before.empty() || fs::exists(before); ++i) {
    before = name_.string() + ".before-" + std::to_string(i);
  }
  // Both names change hands at once where the file system can do that, so that RUN is there at any moment.
  if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, name_.c_str(), RENAME_EXCHANGE) == 0) {
    fs::rename(path_, before);
    path_ = name_;
  } else {
    fs::rename(name_, before);
    finish();
  }
  return before;
}

}  // namespace loopmark::map_store
