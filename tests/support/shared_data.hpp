// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Real logs for the tests that use them. They are no part of the project: a test without them is skipped.
///
///   const auto log = testing_support::unpacked_log("kitti_raw_city");
///   if (!log) GTEST_SKIP() << "no shared logs";
#pragma once

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <string>

namespace loopmark::testing_support {

/// A file or folder below the shared folder ("logs/real_pairs"), if it is there.
inline std::optional<std::filesystem::path> shared_path(const std::string& relative) {
  const std::filesystem::path path = std::filesystem::path(LOOPMARK_SHARED_DIR) / relative;
  return std::filesystem::exists(path) ? std::optional(path) : std::nullopt;
}

/// Holds an exclusive lock on a file, between processes, until it goes out of scope.
class FileLock {
 public:
  explicit FileLock(const std::filesystem::path& path)
      : file_(::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)) {
    if (file_ < 0 || ::flock(file_, LOCK_EX) != 0) {
      throw std::runtime_error("cannot lock " + path.string());
    }
  }
  ~FileLock() { ::close(file_); }
  FileLock(const FileLock&) = delete;
  FileLock& operator=(const FileLock&) = delete;

 private:
  int file_;
};

/// The folder of the log `name`, unpacked from shared logs/<name>.tar.xz into the build folder on first use (other
/// tests that want it wait); nullopt when the archive is not there. With the environment variable LOOPMARK_LOGS_DIR,
/// logs that are unpacked there already are taken.
inline std::optional<std::filesystem::path> unpacked_log(const std::string& name) {
  if (const char* given = std::getenv("LOOPMARK_LOGS_DIR")) {
    const std::filesystem::path folder = std::filesystem::path(given) / name;
    if (std::filesystem::is_directory(folder)) {
      return folder;
    }
  }
  const auto archive = shared_path("logs/" + name + ".tar.xz");
  if (!archive) {
    return std::nullopt;
  }
  const std::filesystem::path logs = std::filesystem::path(LOOPMARK_TEST_DATA_DIR) / "logs";
  std::filesystem::create_directories(logs);
  const FileLock lock(logs / ("." + name + ".lock"));
  if (!std::filesystem::is_directory(logs / name)) {
    const std::filesystem::path part = logs / ("." + name + ".part");
    std::filesystem::remove_all(part);
    std::filesystem::create_directories(part);
    const std::string command = "tar -xJf '" + archive->string() + "' -C '" + part.string() + "'";
    if (std::system(command.c_str()) != 0) {
      throw std::runtime_error("cannot unpack " + archive->string());
    }
    std::filesystem::rename(part / name, logs / name);
    std::filesystem::remove_all(part);
  }
  return logs / name;
}

}  // namespace loopmark::testing_support
