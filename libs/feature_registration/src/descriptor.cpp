// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/feature_registration/descriptor.hpp"

#include <algorithm>

#include "fpfh_descriptor.hpp"
#include "loopmark/core/error.hpp"
#include "shape_context_descriptor.hpp"

namespace loopmark::feature_registration {

const std::vector<NamedDescriptor>& descriptors() {
  static const std::vector<NamedDescriptor> table = {
      {"fsc", "Fourier shape context: what stands within 12 m, seen from above; 992 numbers",
       internal::make_shape_context_descriptor},
      {"fpfh", "Fast Point Feature Histograms: the shape of the surface within 2.4 m; 33 numbers",
       internal::make_fpfh_descriptor},
  };
  return table;
}

std::unique_ptr<Descriptor> make_descriptor(const FeatureRegistrationOptions& options) {
  const auto& table = descriptors();
  const auto found =
      std::find_if(table.begin(), table.end(), [&](const auto& entry) { return entry.name == options.descriptor; });
  if (found != table.end()) {
    return found->make(options);
  }
  std::string names;
  for (const NamedDescriptor& entry : table) {
    names += (names.empty() ? "" : ", ") + entry.name;
  }
  throw InputError("no descriptor is called '" + options.descriptor + "' (there are: " + names + ")");
}

}  // namespace loopmark::feature_registration
