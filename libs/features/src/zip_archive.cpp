// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "zip_archive.hpp"

#include <zlib.h>

#include <cstdint>
#include <cstring>
#include <vector>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::features::internal {
namespace {

// All members, unpacked. Two million points with 64 numbers each.
constexpr std::uint64_t kLargest = std::uint64_t{1} << 29U;
constexpr const char* kRemedy = "write it again with numpy.savez";

/// Little-endian numbers of an archive; every access is checked.
class Bytes {
 public:
  Bytes(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

  template <class Unsigned>
  Unsigned number(std::uint64_t at) const {
    Unsigned value = 0;
    std::memcpy(&value, part(at, sizeof value).data(), sizeof value);
    return value;
  }

  std::string_view part(std::uint64_t at, std::uint64_t size) const {
    if (at > bytes_.size() || size > bytes_.size() - at) {
      throw InputError(file_, "byte " + std::to_string(at), "the archive is cut off or damaged", kRemedy);
    }
    return bytes_.substr(at, size);
  }

 private:
  std::string_view bytes_;
  const std::string& file_;
};

struct Member {
  std::string name;
  std::uint16_t method = 0;
  std::uint32_t crc = 0;
  std::uint64_t packed = 0;
  std::uint64_t size = 0;
  std::uint64_t header = 0;  ///< place of the local header
};

std::uint64_t find_end_record(std::string_view bytes, const std::string& file) {
  const std::size_t at = bytes.rfind(std::string_view("PK\5\6", 4));
  if (at == std::string_view::npos) {
    throw InputError(file, "", "not a .npz archive, or cut off", kRemedy);
  }
  return at;
}

/// Replaces the 32-bit sizes that are full by those of the ZIP64 field.
void read_zip64(const Bytes& bytes, std::uint64_t at, std::uint64_t end, Member& member) {
  while (at + 4 <= end) {
    const auto id = bytes.number<std::uint16_t>(at);
    const auto length = bytes.number<std::uint16_t>(at + 2);
    std::uint64_t value = at + 4;
    for (std::uint64_t* field : {&member.size, &member.packed, &member.header}) {
      if (id == 1 && *field == 0xFFFFFFFFU) {
        *field = bytes.number<std::uint64_t>(value);
        value += 8;
      }
    }
    at += 4U + length;
  }
}

std::string inflate_member(std::string_view packed, const Member& member, const std::string& file) {
  constexpr std::uint64_t kBestRatio = 1100;  // deflate cannot do better than 1032
  if (member.size > kBestRatio * (packed.size() + 1)) {
    throw InputError(file, member.name, "the sizes in the archive cannot be right", kRemedy);
  }
  std::string out(member.size, '\0');
  z_stream stream{};
  stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data()));
  stream.avail_in = static_cast<uInt>(packed.size());
  stream.next_out = reinterpret_cast<Bytef*>(out.data());
  stream.avail_out = static_cast<uInt>(out.size());
  const bool ready = inflateInit2(&stream, -MAX_WBITS) == Z_OK;
  const bool whole = ready && inflate(&stream, Z_FINISH) == Z_STREAM_END && stream.total_out == out.size();
  if (ready) {
    inflateEnd(&stream);
  }
  if (!whole) {
    throw InputError(file, member.name, "the compressed data is damaged", kRemedy);
  }
  return out;
}

std::string extract(const Bytes& bytes, const Member& member, const std::string& file) {
  const std::uint64_t data = member.header + 30U + bytes.number<std::uint16_t>(member.header + 26) +
                             bytes.number<std::uint16_t>(member.header + 28);
  const std::string_view packed = bytes.part(data, member.packed);
  if (member.method != 0 && member.method != Z_DEFLATED) {
    throw InputError(file, member.name, "packed by a method other than deflate", kRemedy);
  }
  std::string content = member.method == 0 ? std::string(packed) : inflate_member(packed, member, file);
  if (storage::crc32(content) != member.crc) {
    throw InputError(file, member.name, "the checksum does not fit: the file is damaged", kRemedy);
  }
  return content;
}

/// Sizes of all members so far: no byte of the file belongs to two of them.
class Budget {
 public:
  Budget(std::uint64_t file_bytes, const std::string& file) : file_bytes_(file_bytes), file_(file) {}

  void take(const Member& member) {
    if (member.size > kLargest - size_) {
      throw InputError(file_, member.name, "the archive unpacks to more than 512 MiB", "store fewer descriptors");
    }
    size_ += member.size;
    if (member.packed > file_bytes_ - packed_) {
      throw InputError(file_, member.name, "the members of the archive overlap", kRemedy);
    }
    packed_ += member.packed;
  }

 private:
  std::uint64_t file_bytes_;
  const std::string& file_;
  std::uint64_t size_ = 0;
  std::uint64_t packed_ = 0;
};

Member read_member(const Bytes& bytes, std::uint64_t& at, const std::string& file) {
  if (bytes.part(at, 4) != std::string_view("PK\1\2", 4)) {
    throw InputError(file, "byte " + std::to_string(at), "the directory of the archive is damaged", kRemedy);
  }
  const auto name_length = bytes.number<std::uint16_t>(at + 28);
  const auto extra_length = bytes.number<std::uint16_t>(at + 30);
  Member member;
  member.name = std::string(bytes.part(at + 46, name_length));
  member.method = bytes.number<std::uint16_t>(at + 10);
  member.crc = bytes.number<std::uint32_t>(at + 16);
  member.packed = bytes.number<std::uint32_t>(at + 20);
  member.size = bytes.number<std::uint32_t>(at + 24);
  member.header = bytes.number<std::uint32_t>(at + 42);
  const std::uint64_t extra = at + 46U + name_length;
  read_zip64(bytes, extra, extra + extra_length, member);
  at = extra + extra_length + bytes.number<std::uint16_t>(at + 32);
  return member;
}

}  // namespace

std::map<std::string, std::string> unzip(std::string_view content, const std::string& file) {
  const Bytes bytes(content, file);
  const std::uint64_t end = find_end_record(content, file);
  const auto count = bytes.number<std::uint16_t>(end + 10);
  std::uint64_t at = bytes.number<std::uint32_t>(end + 16);
  std::vector<Member> directory;
  Budget budget(content.size(), file);
  for (std::uint16_t k = 0; k < count; ++k) {
    directory.push_back(read_member(bytes, at, file));
    budget.take(directory.back());
  }
  std::map<std::string, std::string> members;
  for (const Member& member : directory) {
    members[member.name] = extract(bytes, member, file);
  }
  return members;
}

}  // namespace loopmark::features::internal
