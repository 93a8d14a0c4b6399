// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "packet_message.hpp"

namespace loopmark::io::internal {

PointFile finish_sweep(packets::SweepCloud sweep, const LogOptions& options) {
  PointFile file;
  file.dropped.no_return = sweep.without_echo;
  file.cloud = filter_invalid(std::move(sweep.cloud), options, file.dropped);
  if (sweep.started) {
    file.first_time_s = 1e-9 * static_cast<double>(sweep.start_ns);
  }
  return file;
}

}  // namespace loopmark::io::internal
