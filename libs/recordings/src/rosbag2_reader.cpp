// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "rosbag2_reader.hpp"

#include "decompress.hpp"

namespace loopmark::recordings {
namespace internal {
namespace fs = std::filesystem;

Rosbag2Reader::Rosbag2Reader(const fs::path& path) : metadata_(read_bag_metadata(path)), files_(metadata_.files) {
  for (const fs::path& file : files_) {
    std::error_code error;
    if (!fs::exists(file, error)) {
      lasting_problems_.push_back(file.string() + ": a part of the bag is not there; the others are used");
      parts_.emplace_back();
      continue;
    }
    open_part(file);
  }
  if (lasting_problems_.size() == files_.size()) {
    throw InputError(path.string(), "", "none of the bag's " + std::to_string(files_.size()) + " files is there",
                     "the first would be " + files_.front().string());
  }
  problems_ = lasting_problems_;
}

void Rosbag2Reader::open_part(const fs::path& file) {
  Part part;
  fs::path readable = file;
  if (file.extension() == ".zstd") {
    unpacked_.push_back(std::make_unique<UnpackedFile>(file));
    readable = unpacked_.back()->path();
  }
  if (is_mcap(readable)) {
    part.mcap = open_mcap(readable);
  } else {
    part.database = std::make_unique<SqliteBag>(readable);
  }
  parts_.push_back(std::move(part));
  for (std::uint32_t i = 0; parts_.back().database && i < channels_of(parts_.back()).size(); ++i) {
    number_of(parts_.back(), i);
  }
}

const std::vector<Channel>& Rosbag2Reader::channels_of(const Part& part) const {
  return part.database ? part.database->channels() : part.mcap->channels();
}

std::uint32_t Rosbag2Reader::number_of(Part& part, std::uint32_t channel) {
  while (part.numbers.size() <= channel) {
    const Channel& next = channels_of(part)[part.numbers.size()];
    const auto [known, added] =
        known_.try_emplace(next.topic + "\n" + next.type, static_cast<std::uint32_t>(channels_.size()));
    if (added) {
      channels_.push_back(next);
    }
    part.numbers.push_back(known->second);
  }
  return part.numbers[channel];
}

/// Messages that are compressed one by one are decompressed before their bytes are shown.
void Rosbag2Reader::walk(const BytesWanted& wanted, const MessageVisitor& visit) {
  problems_ = lasting_problems_;
  std::size_t damaged = 0;
  const BytesWanted asked = [&](const Channel& channel) {
    return metadata_.compressed_messages && wanted(channel) > 0 ? kAllBytes : wanted(channel);
  };
  for (std::uint32_t k = 0; k < parts_.size(); ++k) {
    Part& part = parts_[k];
    const MessageVisitor pass_on = [&](const MessageRef& found, std::string_view bytes) {
      MessageRef message = found;
      message.channel = number_of(part, found.channel);
      message.file = k;
      if (!metadata_.compressed_messages || bytes.empty()) {
        return visit(message, bytes);
      }
      const Decompressed whole = decompress_zstd_message(bytes);
      damaged += whole.problem.empty() ? 0 : 1;
      visit(message, std::string_view(whole.bytes).substr(0, wanted(channels_[message.channel])));
    };
    if (part.database) {
      const std::string problem = part.database->walk(asked, pass_on);
      if (!problem.empty()) {
        problems_.push_back(problem);
      }
    } else if (part.mcap) {
      part.mcap->walk(asked, pass_on);
      problems_.insert(problems_.end(), part.mcap->problems().begin(), part.mcap->problems().end());
    }
  }
  if (damaged > 0) {
    problems_.push_back(files_.front().string() + ": " + std::to_string(damaged) + " messages cannot be decompressed");
  }
}

std::string Rosbag2Reader::read(const MessageRef& message) const {
  const Part& part = parts_.at(message.file);
  std::string bytes = part.database ? part.database->read(message) : part.mcap->read(message);
  if (!metadata_.compressed_messages) {
    return bytes;
  }
  Decompressed whole = decompress_zstd_message(bytes);
  if (!whole.problem.empty()) {
    throw InputError(files_[message.file].string(), "message " + std::to_string(message.offset),
                     "cannot be decompressed: " + whole.problem);
  }
  return std::move(whole.bytes);
}

}  // namespace internal

std::unique_ptr<Recording> open_rosbag2(const std::filesystem::path& folder_or_file) {
  return std::make_unique<internal::Rosbag2Reader>(folder_or_file);
}

}  // namespace loopmark::recordings
