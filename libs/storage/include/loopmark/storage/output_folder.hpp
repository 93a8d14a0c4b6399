// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>

namespace loopmark::storage {

/// A folder that appears under its name only once it is whole.
class OutputFolder {
 public:
  /// Makes FOLDER.partial; an older .partial is replaced. Throws InputError when FOLDER exists or cannot be made.
  explicit OutputFolder(std::filesystem::path folder);
  const std::filesystem::path& partial() const { return partial_; }
  /// Gives it its name.
  void finish();

 private:
  std::filesystem::path folder_;
  std::filesystem::path partial_;
};

}  // namespace loopmark::storage
