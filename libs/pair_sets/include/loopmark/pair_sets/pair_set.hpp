// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Balanced frame-pair sets in the published text format, and the files that lie beside them.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::pair_sets {

/// Which two scans: the numbers that the data set gives to sessions and frames.
struct PairKey {
  int session = 0;         ///< drive of the source
  int source = 0;          ///< frame of the source
  int target = 0;          ///< frame of the target
  int target_session = 0;  ///< drive of the target; the same as `session` in the published sets

  auto operator<=>(const PairKey&) const = default;
};

/// "session 3: 17 -> 42", for messages.
std::string to_string(const PairKey& key);

/// One row of a set: the motion, and how hard it is.
struct RegistrationPair {
  PairKey key;
  Pose T_target_source = Pose::Identity();  ///< exactly the numbers of the file
  Vector6d motion = Vector6d::Zero();       ///< x y z (m), roll pitch yaw (deg) of T_target_source
  double overlap = 0.0;                     ///< share of the source's voxels that the target sees
  double overlap_symmetric = 0.0;           ///< share of the larger cloud's voxels (paper, Sec. 3)
};

/// Fills `motion` from the matrix.
RegistrationPair make_pair(const PairKey& key, const Pose& T_target_source, double overlap, double overlap_symmetric);

/// Reads a set: one header line (its names are not looked at), then rows of 27 columns: session, source frame,
/// target frame, the 4x4 motion row by row, x y z roll pitch yaw, overlap, overlap_symmetric. Rows of a set with
/// pairs of two drives have a 28th column, the drive of the target. Throws InputError naming file and line for
/// rows of another length, text that is no number, motions that are not rigid, columns that contradict each
/// other, and pairs that stand there twice.
std::vector<RegistrationPair> read_pair_set(const std::filesystem::path& path);

/// Writes the published format (16 decimals; rows in the given order), atomically. The 28th column is written
/// only when some pair joins two drives.
void write_pair_set(const std::filesystem::path& path, const std::vector<RegistrationPair>& pairs);

/// A motion somebody found for a pair.
struct PairMotion {
  PairKey key;
  Pose T_target_source = Pose::Identity();
};

/// Reads the 19-column format of the published coarse motions: session, source, target, 4x4 row by row.
std::vector<PairMotion> read_motions(const std::filesystem::path& path);
void write_motions(const std::filesystem::path& path, const std::vector<PairMotion>& motions);

/// Motions in the order of `pairs`. Throws InputError when a pair has no motion in the file, or a motion no pair.
std::vector<Pose> motions_of_pairs(const std::vector<RegistrationPair>& pairs, const std::vector<PairMotion>& motions,
                                   const std::filesystem::path& path);

/// Pairs of different places: "session_i i session_j j", one header line.
std::vector<PairKey> read_negatives(const std::filesystem::path& path);
void write_negatives(const std::filesystem::path& path, const std::vector<PairKey>& negatives);

/// Motions P that every source point is to be multiplied by first, in the order of `pairs` (19 columns).
std::vector<Pose> read_perturbations(const std::filesystem::path& path, const std::vector<RegistrationPair>& pairs);

}  // namespace loopmark::pair_sets
