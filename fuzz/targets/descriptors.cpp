// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/features/descriptor_file.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void descriptors(std::string_view bytes) {
  reading([&] { features::read_descriptors(written("descriptors.npz", bytes)); });
}

}  // namespace loopmark::fuzz
