// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "loopmark/feature_registration/options.hpp"

namespace loopmark::feature_registration {

/// A variant of the paper's pipeline that has a name, as the tables of the paper compare them.
struct NamedAlgorithm {
  std::string name;
  std::string summary;
  std::string ablation;  ///< the part of the RANSAC and GPF ablation to which it belongs; empty: none
  FeatureRegistrationOptions options;
};

/// Every named variant: the paper's own, its ablation, and the competing estimators.
const std::vector<NamedAlgorithm>& named_algorithms();

/// The options of one. Throws InputError listing the names when there is none of this name.
const FeatureRegistrationOptions& named_algorithm(const std::string& name);

}  // namespace loopmark::feature_registration
