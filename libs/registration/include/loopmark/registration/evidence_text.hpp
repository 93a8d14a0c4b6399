// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// What the names of the evidence mean, for people.
#pragma once

#include <string>
#include <vector>

#include "loopmark/registration/engine.hpp"

namespace loopmark::registration {

/// One number of the evidence of a motion.
struct EvidenceName {
  const char* name;
  const char* meaning;  ///< in a few words, with the unit; "ln": the logarithm is what is weighed and shown
};

/// Every name that a RegistrationMode of the engine carries, in its order.
const std::vector<EvidenceName>& evidence_names();

/// The evidence of the first `most` modes as a table: a row a name with its meaning, a column a mode. Empty where the
/// modes have none.
std::string evidence_table(const std::vector<RegistrationMode>& modes, std::size_t most);

}  // namespace loopmark::registration
