// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "answer_columns.hpp"

#include <cstdint>

#include "loopmark/web_page/block.hpp"

namespace loopmark::map_page::internal {

nlohmann::ordered_json answers_json(const AnswerLayer& layer) {
  nlohmann::ordered_json names = nlohmann::ordered_json::array();
  nlohmann::ordered_json words = nlohmann::ordered_json::array();
  for (const Answer& answer : layer.answers) {
    names.push_back(answer.name);
    words.push_back(answer.words);
  }
  return {{"kinds", layer.kinds}, {"names", names}, {"words", words}};
}

std::string answer_blocks(const AnswerLayer& layer) {
  std::vector<double> stamp;
  std::vector<float> position, truth, sigma, p, error_m, error_deg;
  std::vector<std::uint8_t> kind, placed, wrong;
  for (const Answer& answer : layer.answers) {
    stamp.push_back(answer.stamp_s);
    for (int axis = 0; axis < 3; ++axis) {
      position.push_back(static_cast<float>(answer.position[axis]));
      truth.push_back(static_cast<float>(answer.truth[axis]));
    }
    sigma.push_back(static_cast<float>(answer.sigma_m));
    p.push_back(static_cast<float>(answer.p_correct));
    error_m.push_back(static_cast<float>(answer.error_m));
    error_deg.push_back(static_cast<float>(answer.error_deg));
    kind.push_back(static_cast<std::uint8_t>(answer.kind));
    placed.push_back(answer.placed ? 1 : 0);
    wrong.push_back(answer.wrong ? 1 : 0);
  }
  using web_page::block;
  return web_page::block("answer.stamp", stamp) + web_page::block("answer.position", position) +
         web_page::block("answer.truth", truth) + web_page::block("answer.sigma", sigma) +
         web_page::block("answer.p", p) + web_page::block("answer.error", error_m) +
         web_page::block("answer.turn", error_deg) + web_page::block("answer.kind", kind) +
         web_page::block("answer.placed", placed) + web_page::block("answer.wrong", wrong);
}

}  // namespace loopmark::map_page::internal
