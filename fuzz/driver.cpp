// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
// libFuzzer's way into one target: LOOPMARK_FUZZ_TARGET.
#include <cstdint>

#include "targets.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  loopmark::fuzz::LOOPMARK_FUZZ_TARGET({reinterpret_cast<const char*>(data), size});
  return 0;
}
