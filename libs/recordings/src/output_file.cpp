// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "output_file.hpp"

#include "loopmark/core/error.hpp"

namespace loopmark::recordings::internal {

OutputFile::OutputFile(const std::filesystem::path& file) : path_(file), partial_(file.string() + ".partial") {
  if (std::filesystem::exists(file)) {
    throw InputError(file.string(), "", "is there already", "nothing is overwritten: name another file");
  }
  out_.open(partial_, std::ios::binary | std::ios::trunc);
  if (!out_) {
    fail();
  }
}

OutputFile::~OutputFile() {
  if (!finished_) {
    out_.close();
    std::error_code error;
    std::filesystem::remove(partial_, error);
  }
}

void OutputFile::fail() const {
  throw InputError(partial_.string(), "", std::string("cannot be written: ") + std::strerror(errno));
}

void OutputFile::append(std::string_view bytes) {
  if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    fail();
  }
  size_ += bytes.size();
}

void OutputFile::replace(std::uint64_t offset, std::string_view bytes) {
  out_.seekp(static_cast<std::streamoff>(offset));
  if (!out_.write(bytes.data(), static_cast<std::streamsize>(bytes.size()))) {
    fail();
  }
  out_.seekp(0, std::ios::end);
}

void OutputFile::finish() {
  out_.close();
  if (!out_) {
    fail();
  }
  std::filesystem::rename(partial_, path_);
  finished_ = true;
}

}  // namespace loopmark::recordings::internal
