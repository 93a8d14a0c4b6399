// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "loopmark/mapping/registrar.hpp"

namespace loopmark::mapping {

/// Registration by the engine.
std::shared_ptr<const Registrar> engine_registrar(const registration::EngineOptions& options);

}  // namespace loopmark::mapping
