// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "saved_state.hpp"

#include <algorithm>

#include "loopmark/core/error.hpp"

#include "loopmark/storage/byte_stream.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/storage/sha256.hpp"

namespace loopmark::mapping::internal {
namespace fs = std::filesystem;
namespace {

constexpr std::uint64_t kFormat = 0x6c6d73746174 + 2;  // changes with what is written

fs::path state_file(const map_store::RunFolder& folder) { return folder / "records/odometry.state"; }
fs::path state_before(const map_store::RunFolder& folder) { return folder / "records/odometry.state.before"; }

SavedState from_bytes(const std::string& bytes) {
  const std::string content = storage::unsealed(bytes, "the saved state of the odometry");
  storage::ByteReader reader(content);
  if (reader.value<std::uint64_t>() != kFormat) {
    throw InputError("the saved state of the odometry is of another version of loopmark");
  }
  SavedState state;
  state.known = reader.value<std::size_t>();
  state.records_sha256 = reader.text();
  state.pending = reader.text();
  state.odometry = reader.text();
  return state;
}

}  // namespace

void write_state(const map_store::RunFolder& folder, const SavedState& state) {
  storage::ByteWriter writer;
  writer.value(kFormat);
  writer.value(state.known);
  writer.text(state.records_sha256);
  writer.text(state.pending);
  writer.text(state.odometry);
  std::error_code none_yet;
  fs::rename(state_file(folder), state_before(folder), none_yet);
  storage::write_file_atomically(state_file(folder), storage::sealed(writer.bytes()));
  storage::sync_folder(state_file(folder).parent_path());
}

bool has_state(const map_store::RunFolder& folder) {
  return fs::exists(state_file(folder)) || fs::exists(state_before(folder));
}

std::vector<SavedState> read_states(const map_store::RunFolder& folder) {
  std::vector<SavedState> states;
  for (const fs::path& file : {state_file(folder), state_before(folder)}) {
    try {
      states.push_back(from_bytes(storage::read_file(file)));
    } catch (const InputError&) {
      continue;  // not there, cut or damaged: the other one may do
    }
  }
  return states;
}

std::string sha256_of_records(const std::vector<std::string>& lines, std::size_t count) {
  storage::Sha256 sum;
  for (std::size_t i = 0; i < std::min(count, lines.size()); ++i) {
    sum.add(lines[i]);
    sum.add("\n");
  }
  return sum.hex();
}

}  // namespace loopmark::mapping::internal
