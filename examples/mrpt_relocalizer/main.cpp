// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Sensory frames of an MRPT rawlog, one by one as a live system would hand them over, placed in the map of a run: pose
/// and state of each. Usage: mrpt_relocalizer RUN LOG.rawlog
#include <mrpt/obs/CRawlog.h>
#include <mrpt/poses/CPose3DPDFGaussian.h>

#include <cstdio>

#include "loopmark/localization/relocalizer.hpp"
#include "loopmark/localization/run_place_map.hpp"
#include "loopmark/map_store/run_records.hpp"
#include "loopmark/mrpt_bridge/conversions.hpp"

int main(int argc, char** argv) try {
  mrpt::obs::CRawlog frames;
  if (argc != 3 || !frames.loadFromRawLogFile(argv[2])) {
    std::fprintf(stderr, "usage: mrpt_relocalizer RUN LOG.rawlog\n");
    return 2;
  }
  const auto run = loopmark::map_store::RunFolder::open(argv[1]);
  const auto records = loopmark::map_store::read_run_records(run);
  const auto solved = loopmark::mapping::solve_map(records.scans, records.loops, {}, {});
  loopmark::localization::Relocalizer relocalizer(loopmark::localization::open_place_map(run, solved, {}), {});
  for (const auto& object : frames) {
    mrpt::obs::CSensoryFrame frame;
    if (const auto one = std::dynamic_pointer_cast<mrpt::obs::CObservation>(object)) frame.insert(one);
    if (const auto many = std::dynamic_pointer_cast<mrpt::obs::CSensoryFrame>(object)) frame = *many;
    if (const auto scan = loopmark::mrpt_bridge::scan_from_sensory_frame(frame)) {
      const loopmark::localization::RelocalizedScan where = relocalizer.add(*scan);
      const auto pose = loopmark::mrpt_bridge::to_mrpt(where.T_map_lidar, where.covariance);
      std::printf("%.2f s  %s  P(correct) %.3f  %s\n", where.stamp_s, name(where.state), where.p_correct,
                  where.answered ? pose.mean.asString().c_str() : where.reason.c_str());
    }
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "error: %s\n", error.what());
  return 2;
}
