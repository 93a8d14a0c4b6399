// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>

#include "bag_metadata.hpp"
#include "loopmark/recordings/recording.hpp"
#include "sqlite_bag.hpp"

namespace loopmark::recordings::internal {

/// The files of one ROS 2 bag in order, each opened as what it is.
class Rosbag2Reader : public Recording {
 public:
  explicit Rosbag2Reader(const std::filesystem::path& folder_or_file);
  std::string format() const override { return "rosbag2"; }
  const std::vector<std::filesystem::path>& files() const override { return files_; }
  const std::vector<Channel>& channels() const override { return channels_; }
  void walk(const BytesWanted& wanted, const MessageVisitor& visit) override;
  std::string read(const MessageRef& message) const override;
  const std::vector<std::string>& problems() const override { return problems_; }

 private:
  struct Part {
    std::unique_ptr<SqliteBag> database;  ///< one of the two
    std::unique_ptr<Recording> mcap;
    std::vector<std::uint32_t> numbers;  ///< its channels -> channels_
  };

  void open_part(const std::filesystem::path& file);
  const std::vector<Channel>& channels_of(const Part& part) const;
  std::uint32_t number_of(Part& part, std::uint32_t channel);

  BagMetadata metadata_;
  std::vector<std::filesystem::path> files_;
  std::vector<std::unique_ptr<UnpackedFile>> unpacked_;
  std::vector<Part> parts_;
  std::vector<Channel> channels_;
  std::map<std::string, std::uint32_t> known_;  ///< topic and type -> channels_
  std::vector<std::string> lasting_problems_;   ///< found when it was opened
  std::vector<std::string> problems_;
};

}  // namespace loopmark::recordings::internal
