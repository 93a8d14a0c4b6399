// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Finds the loops among the keyframes of a run folder: places that look alike, with no gate on their poses, registered
/// by the engine; then submaps, for parts of the map that nothing joins yet.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "loopmark/map_store/run_folder.hpp"
#include "loopmark/mapping/solved_map.hpp"
#include "loopmark/registration/pair_registration.hpp"

namespace loopmark::mapping {

/// Registers two keyframes of a run: scan to scan, or with the keyframes around each joined into a submap.
/// Throws InputError when a file of a keyframe is missing or damaged.
class KeyframeRegistrar {
 public:
  KeyframeRegistrar(const map_store::RunFolder& folder, const std::vector<Keyframe>& keyframes,
                    const registration::PairRegistration& registrar)
      : folder_(folder), keyframes_(keyframes), registrar_(registrar) {}

  registration::RegistrationResult scans(std::size_t source, std::size_t target) const;
  registration::RegistrationResult verify(std::size_t source, std::size_t target, const Pose& T_target_source) const;

  /// `count`: keyframes in each submap, taken from the segment of its middle one, in whose frame it stands.
  registration::RegistrationResult submaps(std::size_t source, std::size_t target, std::size_t count) const;

 private:
  registration::PreparedCloudPtr prepared(std::size_t keyframe) const;
  registration::PreparedCloudPtr submap(std::size_t middle, std::size_t count) const;

  const map_store::RunFolder& folder_;
  const std::vector<Keyframe>& keyframes_;
  const registration::PairRegistration& registrar_;
};

/// What the registration of a candidate came to, written into its record.
void store_result(const registration::RegistrationResult& result, map_store::LoopRecord& candidate);

/// LoopRecord::origin of a pair that was registered as submaps.
inline constexpr const char* kSubmapOrigin = "submap";

/// Which keyframes a closer may try with each other.
struct LoopScope {
  bool neighbours = true;  ///< the first keyframes of a segment with the last of the segment before
  /// Whether two keyframes of different segments may be tried; empty: any.
  std::function<bool(std::size_t source, std::size_t target)> may_join = {};
};

class LoopCloser {
 public:
  LoopCloser(const map_store::RunFolder& folder, const SlamOptions& options,
             const pose_graph::PoseGraphOptions& graph_options, const registration::PairRegistration& registrar,
             LoopScope scope = {});

  using Keep = std::function<void(const map_store::LoopRecord& loop)>;
  using Report = std::function<void(std::size_t done, std::size_t total)>;

  /// Tries every candidate and appends it with its evidence to `loops`; `keep` is called with each, in order. The first
  /// `given` loops come from elsewhere; those behind them are candidates that an interrupted run has tried already, and
  /// are not tried again. Throws Interrupted when the user asks to stop.
  void close(const std::vector<map_store::ScanRecord>& scans, std::vector<map_store::LoopRecord>& loops,
             std::size_t given, const Keep& keep, const Report& report) const;

 private:
  struct Work;
  std::vector<map_store::LoopRecord> places(const std::vector<Keyframe>& keyframes) const;
  std::vector<map_store::LoopRecord> between_components(const SolvedMap& map,
                                                        const std::vector<map_store::LoopRecord>& tried) const;
  void attempt(Work& work, std::vector<map_store::LoopRecord> todo) const;
  bool may_join(const Keyframe& source, const Keyframe& target) const;

  const map_store::RunFolder& folder_;
  SlamOptions options_;
  pose_graph::PoseGraphOptions graph_options_;
  const registration::PairRegistration& registrar_;
  LoopScope scope_;
};

}  // namespace loopmark::mapping
