// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <utility>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::map_store {
namespace fs = std::filesystem;
namespace {

constexpr const char* kPartial = ".partial";

fs::path plain(const fs::path& run) {
  const std::string text = run.string();
  fs::path result = text.size() > 1 && text.back() == '/' ? fs::path(text.substr(0, text.size() - 1)) : run;
  return result.extension() == kPartial ? result.replace_extension() : result;
}

/// "." for a name without a folder.
fs::path folder_of(const fs::path& path) { return path.has_parent_path() ? path.parent_path() : fs::path("."); }

fs::path partial(const fs::path& run) { return fs::path(plain(run).string() + kPartial); }

/// RUN.before-1, or the first number that is free.
fs::path free_before(const fs::path& name) {
  fs::path before;
  for (std::size_t i = 1; before.empty() || fs::exists(before); ++i) {
    before = name.string() + ".before-" + std::to_string(i);
  }
  return before;
}

/// Whether all of a run is there. A revision that was killed at its very end leaves the old run as RUN.partial.
bool is_whole(const fs::path& run) {
  std::error_code error;
  return fs::exists(run / "manifest.json", error) &&
         storage::read_file(run / "manifest.json").find("\"sha256\": {") != std::string::npos;
}

/// Empties what a killed process left, unless it can be resumed. A whole run is never thrown away.
void clear(const fs::path& path, const fs::path& name) {
  if (fs::exists(name) && is_whole(path)) {
    fs::copy(path, free_before(name), fs::copy_options::recursive | fs::copy_options::create_hard_links);
  } else if (fs::exists(path / "records/job.json")) {
    throw InputError(path.string(), "", "an interrupted run is there",
                     "continue it with: loopmark map --resume " + name.string() + ", or delete it");
  }
  for (const fs::directory_entry& entry : fs::directory_iterator(path)) {
    fs::remove_all(entry.path());
  }
}

}  // namespace

RunFolder::RunFolder(fs::path path, fs::path name) : path_(std::move(path)), name_(std::move(name)) {}

/// Holds a folder against other processes while it lives.
class FolderHold {
 public:
  explicit FolderHold(const fs::path& folder) : folder_(::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC)) {
    if (folder_ >= 0 && ::flock(folder_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK) {
      ::close(folder_);
      throw InputError(folder.string(), "", "another process is making this run", "wait for it, or stop it");
    }
  }
  ~FolderHold() { ::close(folder_); }
  FolderHold(const FolderHold&) = delete;
  FolderHold& operator=(const FolderHold&) = delete;

 private:
  int folder_;
};

void RunFolder::hold() { hold_ = std::make_shared<const FolderHold>(path_); }

RunFolder RunFolder::create(const fs::path& run) {
  if (fs::exists(plain(run))) {
    throw InputError(plain(run).string(), "", "is there already and is never overwritten",
                     "choose another name for -o");
  }
  return make(run);
}

/// RUN.partial with nothing in it but the folders of a run.
RunFolder RunFolder::make(const fs::path& run) {
  RunFolder folder(partial(run), plain(run));
  std::error_code error;
  if (const fs::path parent = folder.path_.parent_path(); !parent.empty()) {
    fs::create_directories(parent, error);
  }
  const bool begun = !fs::create_directory(folder.path_, error) && !error;
  if (!error) {
    folder.hold();
    if (begun) {
      clear(folder.path_, folder.name_);
    }
    fs::create_directory(folder.path_ / "records", error);
  }
  if (!error) {
    fs::create_directory(folder.path_ / "keyframes", error);
  }
  if (error) {
    std::error_code ignored;
    fs::remove(folder.path_ / "records", ignored);
    fs::remove(folder.path_, ignored);
    throw InputError(folder.path_.string(), "", "cannot be made: " + error.message(),
                     "choose a folder that can be written for -o");
  }
  return folder;
}

RunFolder RunFolder::resume(const fs::path& run) {
  if (fs::exists(plain(run))) {
    throw InputError(plain(run).string(), "", "the run is whole", "there is nothing to resume");
  }
  if (!fs::exists(partial(run) / "records")) {
    throw InputError(partial(run).string(), "", "there is no interrupted run",
                     "start one with: loopmark map LOG -o RUN");
  }
  RunFolder folder(partial(run), plain(run));
  folder.hold();
  return folder;
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
  open(run);
  return make(run);
}

fs::path RunFolder::keyframe(std::size_t number, const std::string& ending) const {
  char text[32];
  std::snprintf(text, sizeof text, "%06zu.", number);
  return path_ / "keyframes" / (text + ending);
}

void RunFolder::finish() {
  storage::sync_file_system(path_);
  std::error_code error;
  fs::rename(path_, name_, error);
  if (error) {
    throw InputError(path_.string(), "", "cannot be renamed to " + name_.string() + ": " + error.message());
  }
  path_ = name_;
  hold_.reset();
  storage::sync_folder(folder_of(path_));
}

fs::path RunFolder::finish_revision() {
  const fs::path before = free_before(name_);
  storage::sync_file_system(path_);
  // Both names change hands at once where the file system can do that, so that RUN is there at any moment.
  if (::renameat2(AT_FDCWD, path_.c_str(), AT_FDCWD, name_.c_str(), RENAME_EXCHANGE) == 0) {
    fs::rename(path_, before);
    path_ = name_;
    hold_.reset();
    storage::sync_folder(folder_of(path_));
  } else {
    fs::rename(name_, before);
    finish();
  }
  return before;
}

}  // namespace loopmark::map_store
