// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "loopmark/map_page/answers.hpp"

namespace loopmark::map_page::internal {

/// Names, kinds and words of the answers.
nlohmann::ordered_json answers_json(const AnswerLayer& layer);

/// Their numbers, as columns.
std::string answer_blocks(const AnswerLayer& layer);

}  // namespace loopmark::map_page::internal
