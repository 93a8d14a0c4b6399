// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace loopmark::fuzz {

/// A folder in memory of this process, gone when it ends.
const std::filesystem::path& scratch();

/// Writes a file into the folder.
std::filesystem::path written(const std::string& name, std::string_view bytes);

/// The parts of the bytes between zero bytes, `count` of them; missing ones are empty.
std::vector<std::string_view> parts(std::string_view bytes, std::size_t count);

/// Calls what reads; input errors are what it should throw.
template <class Read>
void reading(const Read& read);

}  // namespace loopmark::fuzz

#include "loopmark/core/error.hpp"

template <class Read>
void loopmark::fuzz::reading(const Read& read) {
  try {
    read();
  } catch (const InputError&) {
    return;
  }
}
