// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the numbers in a file's time field mean.
#pragma once

#include <optional>
#include <vector>

namespace loopmark::io::internal {

struct PointTimes {
  std::vector<float> offset_s;    ///< seconds; empty when the numbers cannot be times of one sweep
  std::optional<double> first_s;  ///< absolute time at offset 0, where the file has absolute times
};

/// Seconds, ms, us or ns, told apart by size: absolute times (since 1970) by their magnitude, relative ones by
/// their span, one sweep taking between 2 ms and 2 s. Absolute times become offsets from the earliest. `fraction`: the
/// numbers can hold fractions; whole numbers are never seconds.
PointTimes interpret_times(const std::vector<double>& values, bool fraction);

/// Offsets relative to `stamp_s` of times that count from `first_time_s`: a clock a whole number of quarter hours
/// off (time zones in file names) is put right; where the clocks have nothing to do with each other
/// (more than 2 s apart) the scan's stamp is taken for the start of its sweep.
void refer_to_stamp(std::vector<float>& offset_s, double first_time_s, double stamp_s);

}  // namespace loopmark::io::internal
