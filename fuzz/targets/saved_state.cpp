// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/odometry/odometry.hpp"
#include "loopmark/storage/byte_stream.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void saved_state(std::string_view bytes) {
  reading([&] {
    odometry::Odometry odometry({}, odometry::Compensation::kCompensated, {});
    odometry.set_state(storage::sealed(std::string(bytes)));
  });
}

}  // namespace loopmark::fuzz
