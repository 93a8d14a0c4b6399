// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/storage/output_folder.hpp"

#include <system_error>

#include "loopmark/core/error.hpp"

namespace loopmark::storage {

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_(std::move(folder)) {
  std::string name = folder_.lexically_normal().string();
  while (name.size() > 1 && name.back() == '/') {
    name.pop_back();
  }
  folder_ = name;
  partial_ = name + ".partial";
  std::error_code error;
  if (std::filesystem::exists(folder_, error)) {
    throw InputError(folder_.string(), "", "exists already", "choose another folder, or remove it first");
  }
  std::filesystem::remove_all(partial_, error);
  std::filesystem::create_directories(partial_, error);
  if (error) {
    throw InputError(partial_.string(), "", "cannot make the folder: " + error.message(),
                     "check the rights of its parent");
  }
}

void OutputFolder::finish() {
  std::error_code error;
  std::filesystem::rename(partial_, folder_, error);
  if (error) {
    throw InputError(folder_.string(), "", "cannot rename " + partial_.string() + ": " + error.message());
  }
}

}  // namespace loopmark::storage
