// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "loopmark/slam/registrar.hpp"

namespace loopmark {

/// Registration by the engine.
std::shared_ptr<const Registrar> engine_registrar(const EngineOptions& options);

}  // namespace loopmark
