// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "overlap_probe.hpp"

namespace loopmark::pair_sets::internal {

OverlapProbe::OverlapProbe(const Drive& drive, std::size_t place, PoolCost& cost)
    : drive_(drive), place_(place), source_(drive.load(place)), cost_(cost) {
  ++cost_.scans;
}

cloud::Overlap OverlapProbe::with(const Drive& target_drive, std::size_t target) {
  ++cost_.overlaps;
  ++cost_.scans;
  return cloud::overlap(source_, target_drive.load(target), T_target_source(target_drive, target));
}

RegistrationPair OverlapProbe::pair(const Drive& target_drive, std::size_t target,
                                    const cloud::Overlap& overlap) const {
  return make_pair({drive_.session, drive_.frames[place_], target_drive.frames[target], target_drive.session},
                   T_target_source(target_drive, target), overlap.source, overlap.symmetric);
}

}  // namespace loopmark::pair_sets::internal
