// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/config/node.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void yaml(std::string_view bytes) {
  reading([&] { config::parse_yaml(std::string(bytes), "fuzz.yaml"); });
}

}  // namespace loopmark::fuzz
