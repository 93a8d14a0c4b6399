// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "bag_metadata.hpp"

#include <unistd.h>
#include <yaml-cpp/yaml.h>
#include <zstd.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <memory>

#include "loopmark/core/error.hpp"
#include "loopmark/core/progress.hpp"

namespace loopmark::recordings::internal {
namespace fs = std::filesystem;
namespace {

constexpr std::size_t kMostMetadata = std::size_t{16} << 20U;  // bytes of metadata.yaml; real ones have some kB

bool has_extension(const fs::path& file, std::initializer_list<const char*> extensions) {
  return std::any_of(extensions.begin(), extensions.end(), [&](const char* e) { return file.extension() == e; });
}

bool is_bag_file(const fs::path& file) {
  const fs::path inner = file.extension() == ".zstd" ? file.stem() : file;
  return has_extension(inner, {".db3", ".mcap"});
}

/// The number at the end of "bag_12.db3"; files without one come first.
long split_number(const fs::path& file) {
  std::string stem = file.filename().string();
  stem = stem.substr(0, stem.find('.'));
  const std::size_t digits = stem.find_last_not_of("0123456789") + 1;
  return digits < stem.size() && stem.size() - digits < 10 ? std::stol(stem.substr(digits)) : -1;
}

std::vector<fs::path> files_in(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code error;
  for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
    if (is_bag_file(it->path()) && it->is_regular_file(error)) {
      files.push_back(it->path());
    }
  }
  std::sort(files.begin(), files.end(), [](const fs::path& a, const fs::path& b) {
    return std::pair(split_number(a), a) < std::pair(split_number(b), b);
  });
  return files;
}

BagMetadata understand(const fs::path& file, const YAML::Node& root) {
  const YAML::Node info = root["rosbag2_bagfile_information"];
  if (!info || !info.IsMap()) {
    throw InputError(
        file.string(), "", "no section rosbag2_bagfile_information",
        "make it anew with: ros2 bag reindex, or move it away: the files beside it are then read by themselves");
  }
  BagMetadata metadata;
  const std::string format = info["compression_format"].as<std::string>("");
  const std::string mode = info["compression_mode"].as<std::string>("");
  if (!format.empty() && format != "zstd") {
    throw InputError(file.string(), "", "messages compressed as '" + format + "', which is not zstd");
  }
  metadata.compressed_messages = mode == "MESSAGE" || mode == "message";
  for (const YAML::Node& entry : info["relative_file_paths"]) {
    const fs::path name = entry.as<std::string>();
    const bool inside = name.is_relative() && name.lexically_normal().begin()->string() != "..";
    const fs::path direct = file.parent_path() / name;
    // Old recorders wrote "bag/bag_0.db3" as seen from the folder above.
    metadata.files.push_back(inside && fs::exists(direct) ? direct : file.parent_path() / name.filename());
  }
  return metadata;
}

}  // namespace

BagMetadata read_bag_metadata(const fs::path& path) {
  std::error_code error;
  if (!fs::is_directory(path, error)) {
    return {{path}, false};
  }
  const fs::path file = path / "metadata.yaml";
  BagMetadata metadata;
  if (fs::exists(file, error)) {
    if (fs::file_size(file, error) > kMostMetadata) {
      throw InputError(file.string(), "", "metadata of more than 16 MB");
    }
    try {
      metadata = understand(file, YAML::LoadFile(file.string()));
    } catch (const YAML::Exception& problem) {
      throw InputError(file.string(), std::to_string(problem.mark.line + 1), "is no valid YAML: " + problem.msg,
                       "make it anew with: ros2 bag reindex");
    }
  }
  if (metadata.files.empty()) {
    metadata.files = files_in(path);
  }
  if (metadata.files.empty()) {
    throw InputError(path.string(), "", "a ROS 2 bag without .db3 or .mcap files");
  }
  return metadata;
}

UnpackedFile::UnpackedFile(const fs::path& compressed) {
  log(Severity::kInfo, compressed.string() + ": unpacking into " + fs::temp_directory_path().string());
  std::string name =
      (fs::temp_directory_path() / ("loopmark_XXXXXX" + compressed.stem().extension().string())).string();
  const int handle = ::mkstemps(name.data(), static_cast<int>(compressed.stem().extension().string().size()));
  if (handle < 0) {
    throw InputError(name, "", "cannot be made", "set TMPDIR to a folder with room for the unpacked bag");
  }
  ::close(handle);
  path_ = name;
  std::ifstream in(compressed, std::ios::binary);
  std::ofstream out(path_, std::ios::binary);
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> stream(ZSTD_createDCtx(), ZSTD_freeDCtx);
  std::vector<char> source(ZSTD_DStreamInSize()), sink(ZSTD_DStreamOutSize());
  std::string problem = in ? "" : "cannot be read";
  std::size_t left = 0;
  while (problem.empty() && in) {
    in.read(source.data(), static_cast<std::streamsize>(source.size()));
    ZSTD_inBuffer input{source.data(), static_cast<std::size_t>(in.gcount()), 0};
    while (problem.empty() && input.pos < input.size) {
      ZSTD_outBuffer output{sink.data(), sink.size(), 0};
      left = ZSTD_decompressStream(stream.get(), &output, &input);
      problem = ZSTD_isError(left) != 0U ? ZSTD_getErrorName(left) : "";
      if (!out.write(sink.data(), static_cast<std::streamsize>(output.pos))) {
        problem = "no room for it in " + fs::temp_directory_path().string() + "; set TMPDIR to another folder";
      }
    }
  }
  out.close();
  if (!problem.empty() || !out) {
    fs::remove(path_);
    throw InputError(compressed.string(), "", "cannot be unpacked: " + problem);
  }
  if (left != 0) {
    log(Severity::kWarning, compressed.string() + ": was cut off; what is whole is used");
  }
}

UnpackedFile::~UnpackedFile() {
  std::error_code error;
  fs::remove(path_, error);
}

}  // namespace loopmark::recordings::internal
