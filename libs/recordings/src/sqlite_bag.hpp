// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One SQLite file of a ROS 2 bag (tables topics and messages), not trusted.
#pragma once

#include <sqlite3.h>

#include <filesystem>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "loopmark/recordings/recording.hpp"

namespace loopmark::recordings::internal {

class SqliteBag {
 public:
  /// Opens it for reading only. Throws InputError when it is no database, locked, or without the tables.
  explicit SqliteBag(const std::filesystem::path& file);

  const std::filesystem::path& path() const { return path_; }
  const std::vector<Channel>& channels() const { return channels_; }

  /// All messages by their row number, MessageRef::channel counting in channels(). Where the database is damaged the
  /// walk ends; the returned text says where, empty when all went well.
  std::string walk(const BytesWanted& wanted, const MessageVisitor& visit) const;

  /// Thread-safe. Throws InputError.
  std::string read(const MessageRef& message) const;

 private:
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
    void operator()(sqlite3_blob* blob) const { sqlite3_blob_close(blob); }
  };
  using Statement = std::unique_ptr<sqlite3_stmt, Close>;
  using Blob = std::unique_ptr<sqlite3_blob, Close>;

  void open(const std::string& uri);
  Statement prepare(const std::string& sql) const;
  void read_topics();
  [[noreturn]] void fail(int code, const std::string& what) const;
  Blob blob_of(std::int64_t row) const;

  std::filesystem::path path_;
  std::unique_ptr<sqlite3, Close> database_;
  std::vector<Channel> channels_;
  std::map<std::int64_t, std::uint32_t> numbers_;  ///< topics.id -> index into channels_
  mutable std::mutex mutex_;
};

}  // namespace loopmark::recordings::internal
