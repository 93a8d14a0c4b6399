// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag2_writer.hpp"

#include <algorithm>
#include <fstream>

namespace loopmark::recordings {
namespace internal {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kMessagesInTransaction = 200;

std::string ros2_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  return slash == std::string::npos ? type : type.substr(0, slash) + "/msg" + type.substr(slash);
}

}  // namespace

Rosbag2Writer::Rosbag2Writer(const fs::path& folder)
    : folder_(folder.has_filename() ? folder : folder.parent_path()),
      partial_(folder_.string() + ".partial"),
      file_name_(folder_.filename().string() + "_0.db3") {
  if (fs::exists(folder_)) {
    throw InputError(folder_.string(), "", "is there already", "nothing is overwritten: name another folder");
  }
  fs::remove_all(partial_);
  std::error_code error;
  if (!fs::create_directories(partial_, error)) {
    throw InputError(partial_.string(), "", "cannot be made: " + error.message());
  }
  sqlite3* opened = nullptr;
  const int code = sqlite3_open((partial_ / file_name_).c_str(), &opened);
  database_.reset(opened);
  require(code, SQLITE_OK);
  run("PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF;"
      "CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);"
      "INSERT INTO schema VALUES(3, 'humble');"
      "CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL, metadata TEXT NOT NULL);"
      "CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,"
      " serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL);"
      "CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL, timestamp INTEGER NOT NULL,"
      " data BLOB NOT NULL);"
      "CREATE INDEX timestamp_idx ON messages (timestamp ASC); BEGIN");
  sqlite3_stmt* statement = nullptr;
  require(sqlite3_prepare_v2(opened, "INSERT INTO messages(topic_id, timestamp, data) VALUES(?, ?, ?)", -1, &statement,
                             nullptr),
          SQLITE_OK);
  insert_.reset(statement);
}

Rosbag2Writer::~Rosbag2Writer() {
  insert_.reset();
  database_.reset();
  std::error_code error;
  if (!finished_) {
    fs::remove_all(partial_, error);
  }
}

void Rosbag2Writer::require(int code, int expected) {
  if (code != expected) {
    throw InputError((partial_ / file_name_).string(), "",
                     std::string("cannot be written: ") + sqlite3_errmsg(database_.get()));
  }
}

void Rosbag2Writer::run(const char* sql) {
  require(sqlite3_exec(database_.get(), sql, nullptr, nullptr, nullptr), SQLITE_OK);
}

std::uint32_t Rosbag2Writer::add_channel(const Channel& channel) {
  sqlite3_stmt* statement = nullptr;
  require(sqlite3_prepare_v2(database_.get(), "INSERT INTO topics VALUES(?, ?, ?, 'cdr', '')", -1, &statement, nullptr),
          SQLITE_OK);
  const std::unique_ptr<sqlite3_stmt, Close> row(statement);
  topics_.push_back({channel, 0});
  topics_.back().channel.type = ros2_type(channel.type);
  sqlite3_bind_int64(statement, 1, static_cast<std::int64_t>(topics_.size()));
  sqlite3_bind_text(statement, 2, channel.topic.c_str(), -1, SQLITE_TRANSIENT);
  sqlite3_bind_text(statement, 3, topics_.back().channel.type.c_str(), -1, SQLITE_TRANSIENT);
  require(sqlite3_step(statement), SQLITE_DONE);
  return static_cast<std::uint32_t>(topics_.size() - 1);
}

void Rosbag2Writer::write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) {
  sqlite3_bind_int64(insert_.get(), 1, static_cast<std::int64_t>(channel) + 1);
  sqlite3_bind_int64(insert_.get(), 2, time_ns);
  sqlite3_bind_blob64(insert_.get(), 3, message.data(), message.size(), SQLITE_STATIC);
  require(sqlite3_step(insert_.get()), SQLITE_DONE);
  sqlite3_reset(insert_.get());
  start_ns_ = messages_ == 0 ? time_ns : std::min(start_ns_, time_ns);
  end_ns_ = messages_ == 0 ? time_ns : std::max(end_ns_, time_ns);
  ++topics_.at(channel).count;
  if (++messages_ % kMessagesInTransaction == 0) {
    run("COMMIT; BEGIN");
  }
}

/// Version 5 of the metadata, as ROS 2 Humble writes it.
std::string Rosbag2Writer::metadata() const {
  const std::string span = "nanoseconds: " + std::to_string(end_ns_ - start_ns_) + "\n";
  const std::string start = "nanoseconds_since_epoch: " + std::to_string(start_ns_) + "\n";
  const std::string count = "message_count: " + std::to_string(messages_) + "\n";
  std::string text = "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n  duration:\n    " +
                     span + "  starting_time:\n    " + start + "  " + count + "  topics_with_message_count:\n";
  for (const Topic& topic : topics_) {
    text += "    - topic_metadata:\n        name: \"" + topic.channel.topic +
            "\"\n        type: " + topic.channel.type +
            "\n        serialization_format: cdr\n        offered_qos_profiles: \"\"\n      message_count: " +
            std::to_string(topic.count) + "\n";
  }
  text +=
      "  compression_format: \"\"\n  compression_mode: \"\"\n  relative_file_paths:\n    - \"" + file_name_ + "\"\n";
  return text + "  files:\n    - path: \"" + file_name_ + "\"\n      starting_time:\n        " + start +
         "      duration:\n        " + span + "      " + count;
}

void Rosbag2Writer::finish() {
  run("COMMIT");
  insert_.reset();
  database_.reset();
  std::ofstream out(partial_ / "metadata.yaml", std::ios::binary);
  out << metadata();
  out.close();
  if (!out) {
    throw InputError((partial_ / "metadata.yaml").string(), "", "cannot be written");
  }
  fs::rename(partial_, folder_);
  finished_ = true;
}

}  // namespace internal

std::unique_ptr<RecordingWriter> create_rosbag2(const std::filesystem::path& folder) {
  return std::make_unique<internal::Rosbag2Writer>(folder);
}

}  // namespace loopmark::recordings
