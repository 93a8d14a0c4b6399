// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/registration/pair_registration.hpp"

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"

namespace loopmark::registration {

PreparedCloudPtr PairRegistration::prepare_submap(const std::vector<PointCloud>& clouds,
                                                  const std::vector<Pose>& T_submap_scan) const {
  PointCloud joined;
  for (std::size_t i = 0; i < clouds.size(); ++i) {
    const PointCloud placed = transformed(clouds[i], T_submap_scan[i]);
    joined.points.insert(joined.points.end(), placed.points.begin(), placed.points.end());
  }
  return prepare(joined);
}

PreparedCloudPtr restore_file(const PairRegistration& registration, const std::filesystem::path& file) {
  const std::string bytes = storage::read_file(file);
  try {
    return registration.restore(bytes);
  } catch (const InputError& error) {
    throw InputError(file.string(), "", error.what(), "the keyframe has to be prepared again: map the log anew");
  }
}

}  // namespace loopmark::registration
