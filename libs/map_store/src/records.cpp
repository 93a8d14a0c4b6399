// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/map_store/records.hpp"

#include "loopmark/map_store/line_text.hpp"

namespace loopmark::map_store {

const char* name(ScanState state) {
  switch (state) {
    case ScanState::kTracked:
      return "tracked";
    case ScanState::kRecovered:
      return "recovered";
    case ScanState::kNewSegment:
      return "new segment";
    case ScanState::kCopy:
      return "copy";
    case ScanState::kDamaged:
      break;
  }
  return "damaged";
}

std::string to_line(const ScanRecord& r) {
  LineWriter line;
  line.whole(r.scan).number(r.stamp_s).whole(static_cast<std::size_t>(r.state)).whole(r.segment);
  line.whole(r.keyframe ? *r.keyframe + 1 : 0).pose(r.T_segment_lidar).vector(r.velocity);
  line.number(r.inlier_share).number(r.residual_m).whole(r.degenerate).whole(static_cast<std::size_t>(r.tracking));
  return line.symmetric(r.covariance).rest(r.problem).text();
}

ScanRecord scan_from_line(const std::string& text) {
  LineReader line(text);
  ScanRecord r;
  r.scan = line.whole();
  r.stamp_s = line.number();
  r.state = static_cast<ScanState>(line.whole());
  r.segment = line.whole();
  if (const std::size_t keyframe = line.whole(); keyframe > 0) {
    r.keyframe = keyframe - 1;
  }
  r.T_segment_lidar = line.pose();
  r.velocity = line.vector();
  r.inlier_share = line.number();
  r.residual_m = line.number();
  r.degenerate = line.whole();
  r.tracking = static_cast<odometry::Tracking>(line.whole());
  r.covariance = line.symmetric();
  r.problem = line.rest();
  return r;
}

std::string to_line(const LoopRecord& r) {
  LineWriter line;
  line.whole(r.source).whole(r.target).word(r.origin).whole(r.answered ? 1 : 0).number(r.p_correct);
  line.pose(r.T_target_source).symmetric(r.covariance).whole(r.evidence.size());
  for (const auto& [word, value] : r.evidence) {
    line.word(word).number(value);
  }
  return line.rest(r.reason).text();
}

LoopRecord loop_from_line(const std::string& text) {
  LineReader line(text);
  LoopRecord r;
  r.source = line.whole();
  r.target = line.whole();
  r.origin = line.word();
  r.answered = line.whole() == 1;
  r.p_correct = line.number();
  r.T_target_source = line.pose();
  r.covariance = line.symmetric();
  for (std::size_t left = line.whole(); left > 0; --left) {
    const std::string word = line.word();
    r.evidence.emplace_back(word, line.number());
  }
  r.reason = line.rest();
  return r;
}

}  // namespace loopmark::map_store
