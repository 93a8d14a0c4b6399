// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "outcome_json.hpp"
#include "support.hpp"
#include "targets.hpp"

namespace loopmark::fuzz {

void result_records(std::string_view bytes) {
  const std::string text(bytes);
  reading([&] { evaluation::internal::experiment_from_json(text, "experiment.json"); });
  reading([&] { evaluation::internal::outcome_from_line(text, "outcomes"); });
  reading([&] { evaluation::internal::times_from_line(text, "times"); });
}

}  // namespace loopmark::fuzz
