// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Recordings of messages by topic: MCAP files, ROS 1 bags, ROS 2 bags. Read front to back without their index, so that
/// a file that was cut off gives what is whole, and with memory that does not grow with the file.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "loopmark/core/error.hpp"

namespace loopmark::recordings {

/// How the fields of a message are laid out as bytes.
enum class Encoding { kCdr, kRos1, kOther };

/// One topic as one writer wrote it.
struct Channel {
  std::string topic;
  std::string type;                      ///< "sensor_msgs/PointCloud2"; ROS 2's "/msg/" is left out
  Encoding encoding = Encoding::kOther;  ///< of its messages
  std::string encoding_name;             ///< as the file says it
  std::string definition;                ///< the message definition in ROS's language; empty where there is none
  std::string md5;                       ///< ROS 1's sum of the definition; bags have it
};

/// Where a message lies; enough to read it again.
struct MessageRef {
  std::uint32_t channel = 0;  ///< index into Recording::channels()
  std::uint32_t file = 0;     ///< of a recording that was split
  std::int64_t time_ns = 0;   ///< when it was recorded, since 1970
  std::uint64_t block = 0;    ///< the compressed chunk's place in the file; 0: none
  std::uint64_t offset = 0;   ///< in the file or the chunk; a row's number in a database
  std::uint32_t size = 0;     ///< bytes
};

/// How much of a channel's messages a walk needs: bytes from their beginning.
using BytesWanted = std::function<std::size_t(const Channel&)>;
inline constexpr std::size_t kAllBytes = static_cast<std::size_t>(-1);

/// Receives each message of a walk; `bytes` holds what was wanted and lives until it returns.
using MessageVisitor = std::function<void(const MessageRef&, std::string_view bytes)>;

/// A message, a chunk or a record beyond this many bytes is refused: no sensor writes such, and a damaged length must
/// not take the machine's memory. (A cloud of 128 beams and 4096 columns with 48 bytes a point has 25 MB.)
inline constexpr std::size_t kMostBytes = std::size_t{128} << 20U;

class Recording {
 public:
  virtual ~Recording() = default;
  /// "mcap", "rosbag1", "rosbag2".
  virtual std::string format() const = 0;
  /// Files in their order.
  virtual const std::vector<std::filesystem::path>& files() const = 0;
  /// Those that walks have met so far; their number only grows. Not to be asked during a walk in another thread.
  virtual const std::vector<Channel>& channels() const = 0;
  /// All messages in the order of the file. Not thread-safe. What is damaged ends up in problems().
  virtual void walk(const BytesWanted& wanted, const MessageVisitor& visit) = 0;
  /// The bytes of one message. Thread-safe. Throws InputError with the file and the place.
  virtual std::string read(const MessageRef& message) const = 0;
  /// What the walks found damaged, each with its file and place.
  virtual const std::vector<std::string>& problems() const = 0;
};

/// True when the file begins like one of this kind (or, for a bare database, is SQLite's).
bool is_mcap(const std::filesystem::path& file);
bool is_rosbag(const std::filesystem::path& file);
bool is_sqlite(const std::filesystem::path& file);

/// Throw InputError when the file cannot be read at all: not there, wrong version, encrypted.
std::unique_ptr<Recording> open_mcap(const std::filesystem::path& file);
std::unique_ptr<Recording> open_rosbag(const std::filesystem::path& file);

/// A ROS 2 bag: the folder with metadata.yaml, a folder of .db3 or .mcap files, or one .db3. Split files are read in
/// order; zstd by file or by message is undone. Throws InputError.
std::unique_ptr<Recording> open_rosbag2(const std::filesystem::path& folder_or_file);

/// "sensor_msgs/msg/Imu" -> "sensor_msgs/Imu".
std::string plain_type(std::string_view type);

}  // namespace loopmark::recordings
