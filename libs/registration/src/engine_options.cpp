// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/engine_options.hpp"

#include <algorithm>

namespace loopmark::registration {

bool asks(const EngineOptions& options, const std::string& source) {
  return std::find(options.sources.begin(), options.sources.end(), source) != options.sources.end();
}

void check(const EngineOptions& options) {
  require_option(!options.sources.empty(), "sources", "at least one is needed: features, bev, landmarks");
  for (const std::string& source : options.sources) {
    const bool known = source == kFeatures || source == kBev || source == kLandmarks;
    require_option(known, "sources", "no source is called '" + source + "' (there are: features, bev, landmarks)");
  }
}

}  // namespace loopmark::registration
