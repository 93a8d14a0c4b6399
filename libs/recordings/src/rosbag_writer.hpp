// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "decompress.hpp"
#include "loopmark/recordings/recording_writer.hpp"
#include "output_file.hpp"

namespace loopmark::recordings::internal {

class RosbagWriter : public RecordingWriter {
 public:
  RosbagWriter(const std::filesystem::path& file, Compression compression);
  std::uint32_t add_channel(const Channel& channel) override;
  void write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) override;
  void finish() override;

 private:
  void end_chunk();
  std::string bag_header(std::uint64_t index_begin) const;

  OutputFile file_;
  Compression compression_;
  std::vector<std::string> connections_;          ///< their records
  std::string chunk_;                             ///< records of the chunk in the making
  std::map<std::uint32_t, std::string> indexes_;  ///< its messages by connection: (time, offset) pairs
  std::uint64_t chunk_start_ = 0, chunk_end_ = 0;
  std::string chunk_infos_;
  std::uint32_t chunks_ = 0;
};

}  // namespace loopmark::recordings::internal
