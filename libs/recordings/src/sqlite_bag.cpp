// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "sqlite_bag.hpp"

#include <algorithm>

#include "byte_source.hpp"

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kMostTopics = 65535;

std::string text_of(sqlite3_stmt* row, int column) {
  const auto* text = reinterpret_cast<const char*>(sqlite3_column_text(row, column));
  return text == nullptr ? "" : std::string(text, static_cast<std::size_t>(sqlite3_column_bytes(row, column)));
}

/// A path as part of a URI: the characters that mean something there are written as %XX.
std::string uri_of(const std::filesystem::path& file, const char* parameters) {
  std::string uri = "file:";
  for (const char c : std::filesystem::absolute(file).string()) {
    if (c == '%' || c == '?' || c == '#') {
      char escaped[4];
      std::snprintf(escaped, sizeof escaped, "%%%02X", static_cast<unsigned>(static_cast<unsigned char>(c)));
      uri += escaped;
    } else {
      uri += c;
    }
  }
  return uri + parameters;
}

}  // namespace

SqliteBag::SqliteBag(const std::filesystem::path& file) : path_(file) {
  if (!is_sqlite(file)) {
    throw InputError(file.string(), "byte 0", "this is no SQLite database");
  }
  open(uri_of(file, "?mode=ro"));
  try {
    read_topics();
  } catch (const InputError&) {
    std::error_code error;
    const bool log_beside = std::filesystem::exists(file.string() + "-wal", error);
    if (!log_beside) {
      throw;
    }
    // A write-ahead log beside the file in a folder that cannot be written to: what the file itself holds is read.
    open(uri_of(file, "?mode=ro&immutable=1"));
    read_topics();
  }
}

void SqliteBag::open(const std::string& uri) {
  sqlite3* opened = nullptr;
  const int code =
      sqlite3_open_v2(uri.c_str(), &opened, SQLITE_OPEN_READONLY | SQLITE_OPEN_URI | SQLITE_OPEN_FULLMUTEX, nullptr);
  database_.reset(opened);
  if (code != SQLITE_OK) {
    fail(code, "cannot be opened");
  }
  sqlite3_limit(opened, SQLITE_LIMIT_LENGTH, static_cast<int>(kMostBytes));
  sqlite3_db_config(opened, SQLITE_DBCONFIG_TRUSTED_SCHEMA, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_VIEW, 0, nullptr);
  sqlite3_db_config(opened, SQLITE_DBCONFIG_ENABLE_TRIGGER, 0, nullptr);
  sqlite3_busy_timeout(opened, 1000);
  // Of a file that was cut off SQLite reads what is there only with this; the connection cannot write.
  sqlite3_exec(opened, "PRAGMA writable_schema=ON", nullptr, nullptr, nullptr);
}

void SqliteBag::fail(int code, const std::string& what) const {
  const std::string why =
      what + " (SQLite: " + (database_ ? sqlite3_errmsg(database_.get()) : sqlite3_errstr(code)) + ")";
  switch (code & 0xFF) {
    case SQLITE_BUSY:
    case SQLITE_LOCKED:
      throw InputError(path_.string(), "", "another program is writing to this bag: " + why, "end the recording first");
    case SQLITE_CORRUPT:
    case SQLITE_NOTADB:
      throw InputError(path_.string(), "", "the database is damaged: " + why,
                       "what is whole can be saved with: sqlite3 FILE .recover | sqlite3 NEW.db3");
    default:
      throw InputError(path_.string(), "", why);
  }
}

SqliteBag::Statement SqliteBag::prepare(const std::string& sql) const {
  sqlite3_stmt* statement = nullptr;
  const int code = sqlite3_prepare_v2(database_.get(), sql.c_str(), -1, &statement, nullptr);
  if (code != SQLITE_OK) {
    fail(code, "this is no ROS 2 bag, or a damaged one");
  }
  return Statement(statement);
}

void SqliteBag::read_topics() {
  channels_.clear();
  numbers_.clear();
  const Statement rows = prepare("SELECT id, name, type, serialization_format FROM topics");
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(rows.get())) == SQLITE_ROW && channels_.size() < kMostTopics) {
    Channel channel{
        text_of(rows.get(), 1), plain_type(text_of(rows.get(), 2)), Encoding::kOther, text_of(rows.get(), 3), "", ""};
    if (channel.encoding_name == "cdr" || channel.encoding_name.empty()) {  // old recorders left it empty
      channel.encoding = Encoding::kCdr;
    }
    numbers_[sqlite3_column_int64(rows.get(), 0)] = static_cast<std::uint32_t>(channels_.size());
    channels_.push_back(std::move(channel));
  }
  if (code != SQLITE_DONE && code != SQLITE_ROW) {
    fail(code, "the table topics cannot be read");
  }
}

SqliteBag::Blob SqliteBag::blob_of(std::int64_t row) const {
  sqlite3_blob* blob = nullptr;
  const int code = sqlite3_blob_open(database_.get(), "main", "messages", "data", row, 0, &blob);
  if (code != SQLITE_OK) {
    fail(code, "message " + std::to_string(row) + " cannot be read");
  }
  return Blob(blob);
}

std::string SqliteBag::walk(const BytesWanted& wanted, const MessageVisitor& visit) const {
  // length() of a BLOB is known from the row's head; the pages with its bytes are not read for it.
  const Statement rows = prepare("SELECT id, topic_id, timestamp, length(data) FROM messages ORDER BY id");
  std::vector<std::size_t> want;
  for (const Channel& channel : channels_) {
    want.push_back(wanted(channel));
  }
  Blob blob;
  std::string bytes;
  std::int64_t last = 0;
  int code = SQLITE_ROW;
  while ((code = sqlite3_step(rows.get())) == SQLITE_ROW) {
    last = sqlite3_column_int64(rows.get(), 0);
    const auto number = numbers_.find(sqlite3_column_int64(rows.get(), 1));
    const std::int64_t length = sqlite3_column_int64(rows.get(), 3);
    if (number == numbers_.end() || length < 0 || length > static_cast<std::int64_t>(kMostBytes)) {
      continue;
    }
    MessageRef message;
    message.channel = number->second;
    message.time_ns = sqlite3_column_int64(rows.get(), 2);
    message.offset = static_cast<std::uint64_t>(last);
    message.size = static_cast<std::uint32_t>(length);
    bytes.resize(std::min<std::size_t>(want[number->second], message.size));
    if (!bytes.empty()) {
      if (blob && (code = sqlite3_blob_reopen(blob.get(), last)) != SQLITE_OK) {
        break;
      }
      blob = blob ? std::move(blob) : blob_of(last);
      if ((code = sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(bytes.size()), 0)) != SQLITE_OK) {
        break;
      }
    }
    visit(message, bytes);
  }
  return code == SQLITE_DONE ? ""
                             : path_.string() + ": the database is damaged behind message " + std::to_string(last) +
                                   " (SQLite: " + sqlite3_errmsg(database_.get()) + "); the messages before are used";
}

std::string SqliteBag::read(const MessageRef& message) const {
  const std::lock_guard lock(mutex_);
  const Blob blob = blob_of(static_cast<std::int64_t>(message.offset));
  std::string bytes(static_cast<std::size_t>(sqlite3_blob_bytes(blob.get())), '\0');
  const int code = sqlite3_blob_read(blob.get(), bytes.data(), static_cast<int>(bytes.size()), 0);
  if (code != SQLITE_OK) {
    fail(code, "message " + std::to_string(message.offset) + " cannot be read");
  }
  return bytes;
}

}  // namespace loopmark::recordings::internal

namespace loopmark::recordings {

bool is_sqlite(const std::filesystem::path& file) {
  return internal::first_bytes(file, 16) == std::string_view("SQLite format 3\0", 16);
}

}  // namespace loopmark::recordings
