// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/record_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::storage {
namespace {

std::string checksum(std::string_view payload) {
  char text[16];
  std::snprintf(text, sizeof text, "%08x", crc32(payload));
  return text;
}

bool is_whole(std::string_view line) {
  return line.size() > 9 && line[8] == ' ' && line.substr(0, 8) == checksum(line.substr(9));
}

}  // namespace

RecordLines read_records(const std::filesystem::path& path) {
  RecordLines records = read_sound_records(path);
  if (records.damaged) {
    throw InputError(path.string(), "line " + std::to_string(records.lines.size() + 1),
                     "damaged record in the middle of the file",
                     "copy it again; what was interrupted may also delete it: its records are computed again");
  }
  return records;
}

RecordLines read_sound_records(const std::filesystem::path& path) {
  RecordLines records;
  if (!std::filesystem::exists(path)) {
    return records;
  }
  if (!std::filesystem::is_regular_file(path)) {
    throw InputError(path.string(), "", "cannot read: not a file but a folder, a pipe or a device");
  }
  const std::string content = read_file(path);
  std::size_t at = 0;
  while (at < content.size()) {
    const std::size_t end = content.find('\n', at);
    const bool last = end == std::string::npos || end + 1 == content.size();
    const std::string_view line = std::string_view(content).substr(at, end == std::string::npos ? end : end - at);
    if (end == std::string::npos || !is_whole(line)) {
      records.torn = last;
      records.damaged = !last;
      return records;
    }
    records.lines.emplace_back(line.substr(9));
    at = end + 1;
    records.whole_bytes = at;
  }
  return records;
}

RecordWriter::RecordWriter(const std::filesystem::path& path) : path_(path) {
  file_ = ::open(path.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
  if (file_ < 0) {
    throw InputError(path.string(), "", std::string("cannot write: ") + std::strerror(errno));
  }
  if (::flock(file_, LOCK_EX | LOCK_NB) != 0) {
    ::close(file_);
    throw InputError(path.string(), "", "another process is writing this file", "wait for it, or stop it");
  }
  RecordLines records;
  try {
    records = read_records(path);
  } catch (...) {
    ::close(file_);
    throw;
  }
  if (records.torn && ::ftruncate(file_, static_cast<off_t>(records.whole_bytes)) != 0) {
    ::close(file_);
    throw InputError(path.string(), "", std::string("cannot cut off a half-written record: ") + std::strerror(errno));
  }
}

RecordWriter::~RecordWriter() { ::close(file_); }

void RecordWriter::append(std::string_view payload) {
  std::string line = checksum(payload);
  line += ' ';
  line += payload;
  line += '\n';
  for (std::size_t done = 0; done < line.size();) {
    const ssize_t written = ::write(file_, line.data() + done, line.size() - done);
    if (written < 0 && errno == EINTR) {
      continue;
    }
    if (written <= 0) {
      throw InputError(path_.string(), "", std::string("cannot write: ") + std::strerror(errno),
                       "what is done is kept; make room and run the same command again");
    }
    done += static_cast<std::size_t>(written);
  }
}

void RecordWriter::sync() const {
  if (::fdatasync(file_) != 0 && errno != EINVAL) {  // EINVAL: this file system cannot
    throw InputError(path_.string(), "", std::string("cannot write to the disk: ") + std::strerror(errno),
                     "what is done is kept; make room and run the same command again");
  }
}

}  // namespace loopmark::storage
