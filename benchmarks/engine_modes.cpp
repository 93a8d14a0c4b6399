// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// engine_modes SET ROOT OUT.txt [NEGATIVES [PERTURB [EVERY]]]: runs the engine on the pairs of a set and writes one
/// row a mode for scripts/fit_confidence.py: pair, right (RE < 5 deg, TE < 0.6 m), negative, then the evidence by name,
/// then how far off the mode is.
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>

#include "loopmark/cloud/voxel.hpp"
#include "loopmark/core/progress.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/pair_sets/pair_set.hpp"
#include "loopmark/registration/engine.hpp"

namespace {

using namespace loopmark;

void write_modes(std::ofstream& out, std::size_t pair, const registration::RegistrationResult& result,
                 const loopmark::Pose& truth, bool negative) {
  for (const registration::RegistrationMode& mode : result.modes) {
    const loopmark::PoseError error = loopmark::pose_error(mode.T_target_source, truth);
    const bool right = !negative && error.rotation_deg < 5.0 && error.translation_m < 0.6;
    out << pair << ' ' << right << ' ' << negative;
    for (const auto& [name, value] : mode.evidence) {
      out << ' ' << name << '=' << value;
    }
    out << " off_m=" << error.translation_m << " off_deg=" << error.rotation_deg << '\n';
  }
}

int run(int argc, char** argv) {
  const std::filesystem::path set = argv[1];
  auto pairs = pair_sets::read_pair_set(set);
  const std::vector<loopmark::Pose> moved =
      argc > 5 && argv[5][0] != '-' ? pair_sets::read_perturbations(argv[5], pairs) : std::vector<loopmark::Pose>();
  const std::size_t positives = pairs.size();
  if (argc > 4 && argv[4][0] != '-') {
    for (const pair_sets::PairKey& key : pair_sets::read_negatives(argv[4])) {
      pairs.push_back(pair_sets::make_pair(key, loopmark::Pose::Identity(), 0.0, 0.0));
    }
  }
  const std::size_t every = argc > 6 ? static_cast<std::size_t>(std::atoi(argv[6])) : 1;
  const auto data = io::open_dataset(argv[2], set.parent_path() / "sessions.txt");
  const registration::EngineOptions options;
  std::ofstream out(argv[3]);
  loopmark::Progress progress("pairs", pairs.size() / every);
  for (std::size_t i = 0; i < pairs.size(); i += every, progress.add()) {
    const pair_sets::PairKey& key = pairs[i].key;
    loopmark::PointCloud source = data->load(key.session, key.source);
    if (i < moved.size()) {
      source = loopmark::transformed(source, moved[i]);
    }
    const loopmark::PointCloud target = data->load(key.target_session, key.target);
    const auto result = registration::register_scans(registration::prepare_scan(source, options),
                                                     registration::prepare_scan(target, options), options);
    write_modes(out, i, result, pairs[i].T_target_source, i >= positives);
  }
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: engine_modes SET ROOT OUT.txt [NEGATIVES|- [PERTURB|- [EVERY]]]\n");
    return 2;
  }
  return run(argc, argv);
}
