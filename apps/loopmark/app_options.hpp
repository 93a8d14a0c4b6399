// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "loopmark/registration/engine_options.hpp"

namespace loopmark::app {

/// Every option of every room; the sections of the YAML file.
struct AppOptions {
  EngineOptions registration;
};

template <class Visitor>
void describe(Visitor& v, AppOptions& o) {
  v.section("registration", o.registration, "global registration of two scans");
}

}  // namespace loopmark::app
