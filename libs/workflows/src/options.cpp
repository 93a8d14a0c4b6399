// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/workflows/options.hpp"

#include "loopmark/config/options_io.hpp"

namespace loopmark::workflows {

std::string options_as_yaml(const ProgramOptions& options) {
  return "# Options of loopmark. Any of them may stand in a file given as --config FILE; the others keep their "
         "defaults.\n\n" +
         config::dump(options);
}

}  // namespace loopmark::workflows
