// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "decompress.hpp"

#include <bzlib.h>
#include <lz4frame.h>
#include <zstd.h>

#include <algorithm>
#include <memory>

#include "loopmark/recordings/recording.hpp"

namespace loopmark::recordings::internal {
namespace {

constexpr std::size_t kFirstBytes = std::size_t{1} << 20U;  // the output starts so small, and doubles

/// One step of a decoder: reads from `in` (and takes off what it read), writes into [out, out + room).
struct Step {
  std::size_t written = 0;
  bool ended = false;  ///< the frame is whole
  std::string problem;
};

class Zstd {
 public:
  Step step(std::string_view& in, char* out, std::size_t room) {
    ZSTD_inBuffer source{in.data(), in.size(), 0};
    ZSTD_outBuffer sink{out, room, 0};
    const std::size_t left = ZSTD_decompressStream(stream_.get(), &sink, &source);
    in.remove_prefix(source.pos);
    if (ZSTD_isError(left) != 0U) {
      return {sink.pos, false, ZSTD_getErrorName(left)};
    }
    return {sink.pos, left == 0 && in.empty(), ""};
  }

 private:
  std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> stream_{ZSTD_createDCtx(), ZSTD_freeDCtx};
};

class Lz4 {
 public:
  Lz4() { LZ4F_createDecompressionContext(&context_, LZ4F_VERSION); }
  ~Lz4() { LZ4F_freeDecompressionContext(context_); }
  Lz4(const Lz4&) = delete;
  Lz4& operator=(const Lz4&) = delete;

  Step step(std::string_view& in, char* out, std::size_t room) {
    std::size_t written = room;
    std::size_t taken = in.size();
    const std::size_t left = LZ4F_decompress(context_, out, &written, in.data(), &taken, nullptr);
    if (LZ4F_isError(left) != 0U) {
      return {0, false, LZ4F_getErrorName(left)};
    }
    in.remove_prefix(taken);
    return {written, left == 0 && in.empty(), ""};
  }

 private:
  LZ4F_dctx* context_ = nullptr;
};

class Bz2 {
 public:
  Bz2() { BZ2_bzDecompressInit(&stream_, 0, 0); }
  ~Bz2() { BZ2_bzDecompressEnd(&stream_); }
  Bz2(const Bz2&) = delete;
  Bz2& operator=(const Bz2&) = delete;

  Step step(std::string_view& in, char* out, std::size_t room) {
    stream_.next_in = const_cast<char*>(in.data());  // the library's interface is older than const; it only reads
    stream_.avail_in = static_cast<unsigned>(in.size());
    stream_.next_out = out;
    stream_.avail_out = static_cast<unsigned>(room);
    const int result = BZ2_bzDecompress(&stream_);
    in.remove_prefix(in.size() - stream_.avail_in);
    Step step{room - stream_.avail_out, result == BZ_STREAM_END, ""};
    if (result != BZ_OK && result != BZ_STREAM_END) {
      step.problem = "bzip2 error " + std::to_string(result);
    }
    return step;
  }

 private:
  bz_stream stream_{};
};

/// Runs a decoder until its frame ends, its input is used up, or it writes more than `most`.
template <class Decoder>
Decompressed run(std::string_view in, std::uint64_t first_room, std::uint64_t most) {
  Decoder decoder;
  Decompressed result;
  std::string& out = result.bytes;
  std::size_t filled = 0;
  out.resize(static_cast<std::size_t>(std::min<std::uint64_t>(std::max<std::uint64_t>(first_room, 64), most + 1)));
  while (true) {
    const std::size_t before = in.size();
    const Step step = decoder.step(in, out.data() + filled, out.size() - filled);
    filled += step.written;
    if (!step.problem.empty() || step.ended || filled > most) {
      result.problem =
          filled > most ? "it holds more than the promised " + std::to_string(most) + " bytes" : step.problem;
      break;
    }
    if (filled == out.size()) {
      out.resize(static_cast<std::size_t>(std::min<std::uint64_t>(2 * out.size(), most + 1)));
    } else if (step.written == 0 && in.size() == before) {
      result.problem = "it ends too early";
      break;
    }
  }
  out.resize(static_cast<std::size_t>(std::min<std::uint64_t>(filled, most)));
  return result;
}

Decompressed run_any(Compression compression, std::string_view block, std::uint64_t first_room, std::uint64_t most) {
  switch (compression) {
    case Compression::kZstd:
      return run<Zstd>(block, first_room, most);
    case Compression::kLz4:
      return run<Lz4>(block, first_room, most);
    case Compression::kBz2:
      return run<Bz2>(block, first_room, most);
    case Compression::kNone:
      break;
  }
  return {std::string(block), ""};
}

}  // namespace

Decompressed decompress(Compression compression, std::string_view block, std::uint64_t promised) {
  if (promised > kMostBytes) {
    return {"", "it promises " + std::to_string(promised) + " bytes, more than the " + std::to_string(kMostBytes) +
                    " that are read at once"};
  }
  // A promise is believed at once up to a ratio that real clouds stay far below; beyond it the output grows as it
  // comes.
  const std::uint64_t first =
      std::min<std::uint64_t>(promised + 1, std::max<std::uint64_t>(kFirstBytes, 32 * block.size()));
  Decompressed result = run_any(compression, block, first, promised);
  if (result.problem.empty() && result.bytes.size() != promised) {
    result.problem = "it holds " + std::to_string(result.bytes.size()) + " bytes where " + std::to_string(promised) +
                     " are promised";
  }
  return result;
}

Decompressed decompress_zstd_message(std::string_view frame) {
  return run<Zstd>(frame, std::min(kFirstBytes, 8 * frame.size()), kMostBytes);
}

std::string compress(Compression compression, std::string_view bytes) {
  std::string out;
  if (compression == Compression::kZstd) {
    out.resize(ZSTD_compressBound(bytes.size()));
    out.resize(ZSTD_compress(out.data(), out.size(), bytes.data(), bytes.size(), 1));
  } else if (compression == Compression::kLz4) {
    // ROS 1's own LZ4 reads independent blocks with a checksum at the end only.
    LZ4F_preferences_t preferences{};
    preferences.frameInfo.blockSizeID = LZ4F_max1MB;
    preferences.frameInfo.blockMode = LZ4F_blockIndependent;
    preferences.frameInfo.contentChecksumFlag = LZ4F_contentChecksumEnabled;
    out.resize(LZ4F_compressFrameBound(bytes.size(), &preferences));
    out.resize(LZ4F_compressFrame(out.data(), out.size(), bytes.data(), bytes.size(), &preferences));
  } else if (compression == Compression::kBz2) {
    unsigned size = static_cast<unsigned>(bytes.size() + bytes.size() / 100 + 600);  // the bound of bzip2's manual
    out.resize(size);
    BZ2_bzBuffToBuffCompress(out.data(), &size, const_cast<char*>(bytes.data()), static_cast<unsigned>(bytes.size()), 9,
                             0, 0);
    out.resize(size);
  } else {
    out = bytes;
  }
  return out;
}

}  // namespace loopmark::recordings::internal
