// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "support.hpp"

#include <fstream>

#include "loopmark/storage/files.hpp"

namespace loopmark::fuzz {
namespace fs = std::filesystem;
namespace {

struct Folder {
  Folder() {
    const fs::path memory = "/dev/shm";
    path = storage::make_private_folder(fs::exists(memory) ? memory : fs::temp_directory_path(), "loopmark-fuzz-");
  }
  ~Folder() {
    std::error_code ignored;
    fs::remove_all(path, ignored);
  }
  fs::path path;
};

}  // namespace

const fs::path& scratch() {
  static const Folder folder;
  return folder.path;
}

fs::path written(const std::string& name, std::string_view bytes) {
  const fs::path path = scratch() / name;
  std::ofstream(path, std::ios::binary) << bytes;
  return path;
}

std::vector<std::string_view> parts(std::string_view bytes, std::size_t count) {
  std::vector<std::string_view> result;
  while (result.size() < count) {
    const std::size_t end = result.size() + 1 < count ? bytes.find('\0') : std::string_view::npos;
    result.push_back(bytes.substr(0, end));
    bytes.remove_prefix(end == std::string_view::npos ? bytes.size() : end + 1);
  }
  return result;
}

}  // namespace loopmark::fuzz
