// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Sensory frames of an MRPT rawlog, one by one as a live system would hand them over, into a mapper; the map as an
/// mrpt::maps::CSimpleMap. Usage: mrpt_front_end LOG.rawlog RUN
#include <mrpt/maps/CSimpleMap.h>
#include <mrpt/obs/CRawlog.h>

#include <cstdio>
#include <exception>

#include "loopmark/map_export/products.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"
#include "loopmark/registration/pair_registration.hpp"

namespace {

mrpt::maps::CSimpleMap map_of(const mrpt::obs::CRawlog& frames, const char* run) {
  const loopmark::map_store::RunFolder folder = loopmark::map_store::RunFolder::create(run);
  loopmark::mapping::Mapper mapper(folder, {}, loopmark::registration::engine_registration({}),
                                   loopmark::odometry::Compensation::kCompensated, {});
  for (const auto& object : frames) {
    mrpt::obs::CSensoryFrame frame;
    if (const auto one = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) frame.insert(one);
    if (const auto many = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) frame = *many;
    if (auto scan = loopmark::mrpt_bridge::scan_from_sensory_frame(frame)) {
      scan->index = mapper.scans().size();
      mapper.add(*scan);
    }
  }
  mapper.close_loops();
  loopmark::map_export::write_mrpt_products(folder, mapper.scans(), mapper.loops(), mapper.solve());
  mrpt::maps::CSimpleMap map;
  map.loadFromFile((folder / "map.simplemap").string());
  return map;
}

}  // namespace

int main(int argc, char** argv) try {
  mrpt::obs::CRawlog frames;
  if (argc != 3 || !frames.loadFromRawLogFile(argv[1])) {
    std::fprintf(stderr, "usage: mrpt_front_end LOG.rawlog RUN\n");
    return 2;
  }
  std::printf("a CSimpleMap of %zu keyframes\n", map_of(frames, argv[2]).size());
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
