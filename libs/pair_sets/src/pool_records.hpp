// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <map>
#include <memory>
#include <vector>

#include "loopmark/pair_sets/candidate_pool.hpp"
#include "loopmark/storage/record_file.hpp"

namespace loopmark::pair_sets::internal {

/// The blocks of a candidate pool that are done, kept in a record file (or nowhere, for an empty path).
class PoolRecords {
 public:
  /// Reads what is there. Throws InputError when it is of other drives or options.
  PoolRecords(const std::filesystem::path& path, const std::vector<Drive>& drives, std::size_t spacing,
              const BalanceOptions& options);

  const std::vector<RegistrationPair>* find(std::size_t block) const;
  void add(std::size_t block, const std::vector<RegistrationPair>& pairs);

 private:
  std::map<std::size_t, std::vector<RegistrationPair>> found_;
  std::unique_ptr<storage::RecordWriter> writer_;
};

}  // namespace loopmark::pair_sets::internal
