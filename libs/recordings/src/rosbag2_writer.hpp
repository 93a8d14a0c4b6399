// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <sqlite3.h>

#include <vector>

#include "loopmark/recordings/recording_writer.hpp"

namespace loopmark::recordings::internal {

class Rosbag2Writer : public RecordingWriter {
 public:
  explicit Rosbag2Writer(const std::filesystem::path& folder);
  ~Rosbag2Writer() override;
  std::uint32_t add_channel(const Channel& channel) override;
  void write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) override;
  void finish() override;

 private:
  struct Topic {
    Channel channel;
    std::uint64_t count = 0;
  };
  struct Close {
    void operator()(sqlite3* database) const { sqlite3_close_v2(database); }
    void operator()(sqlite3_stmt* statement) const { sqlite3_finalize(statement); }
  };

  void run(const char* sql);
  void require(int code, int expected);
  std::string metadata() const;

  std::filesystem::path folder_, partial_;
  std::string file_name_;
  std::unique_ptr<sqlite3, Close> database_;
  std::unique_ptr<sqlite3_stmt, Close> insert_;
  std::vector<Topic> topics_;
  std::int64_t start_ns_ = 0, end_ns_ = 0;
  std::uint64_t messages_ = 0;
  bool finished_ = false;
};

}  // namespace loopmark::recordings::internal
