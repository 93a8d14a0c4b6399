// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <map>
#include <vector>

#include "decompress.hpp"
#include "loopmark/recordings/recording_writer.hpp"
#include "output_file.hpp"

namespace loopmark::recordings::internal {

class McapWriter : public RecordingWriter {
 public:
  McapWriter(const std::filesystem::path& file, Compression compression);
  std::uint32_t add_channel(const Channel& channel) override;
  void write(std::uint32_t channel, std::int64_t time_ns, std::string_view message) override;
  void finish() override;

 private:
  void end_chunk();
  void add_chunk_index(std::uint64_t begin, std::uint64_t length, std::uint64_t packed);

  OutputFile file_;
  Compression compression_;
  std::string definitions_;    ///< of all channels, for the summary
  std::string chunk_indexes_;  ///< for the summary
  std::vector<std::uint64_t> counts_;
  std::string chunk_;                             ///< records of the chunk in the making
  std::map<std::uint32_t, std::string> indexes_;  ///< its messages by channel: (time, offset) pairs
  std::uint64_t chunk_start_ = ~std::uint64_t{0}, chunk_end_ = 0;
  std::uint64_t start_ = ~std::uint64_t{0}, end_ = 0;
  std::uint32_t chunks_ = 0;
};

}  // namespace loopmark::recordings::internal
