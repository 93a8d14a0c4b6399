// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

#include "loopmark/bev/correlation.hpp"
#include "loopmark/core/options.hpp"

namespace loopmark::registration {

/// Options of the registration engine; the defaults are meant for every sensor and scene.
struct EngineOptions {
  double min_p_correct = 0.5;           ///< answers below this probability are withheld
  std::size_t landmarks = 16;           ///< hypotheses of landmarks (0: none); the others are the bird's-eye view's
  std::size_t candidates = 64;          ///< hypotheses that are looked at quickly
  std::size_t hypotheses = 10;          ///< the best of these are refined and verified
  bev::CorrelationOptions correlation;  ///< of the bird's-eye views
};

template <class Visitor>
void describe(Visitor& v, EngineOptions& o) {
  v.field("min_p_correct", o.min_p_correct, "answers below this probability are withheld");
  v.field("landmarks", o.landmarks, "hypotheses of landmarks (0: none); the others are the bird's-eye view's");
  v.field("candidates", o.candidates, "hypotheses that are looked at quickly");
  v.field("hypotheses", o.hypotheses, "the best of these are refined and verified");
  v.section("correlation", o.correlation, "search for hypotheses in the bird's-eye view");
}

}  // namespace loopmark::registration
