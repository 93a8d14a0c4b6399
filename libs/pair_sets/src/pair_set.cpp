// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/pair_sets/pair_set.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "loopmark/core/error.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/text/number_rows.hpp"

namespace loopmark::pair_sets {
namespace {

using text::NumberRow;

constexpr std::array<std::size_t, 2> kPairColumns = {27, 28};
constexpr const char* kPairHeader =
    "session_ind i j mot0 mot1 mot2 mot3 mot4 mot5 mot6 mot7 mot8 mot9 mot10 mot11 mot12 mot13 mot14 mot15 "
    "trans_x trans_y trans_z roll pitch yaw overlap overlap_symmetric";

/// Refuses keys that were seen before.
class KeysSeen {
 public:
  void add(const PairKey& key, const text::NumberRow& row) {
    const auto [place, added] = lines_.emplace(key, row.line);
    if (!added) {
      row.fail("the pair of line " + std::to_string(place->second) + " again (" + to_string(key) + ")",
               "every pair may stand in the file once");
    }
  }

 private:
  std::map<PairKey, std::size_t> lines_;
};

double angle_difference(double a, double b) { return std::abs(std::remainder(a - b, 360.0)); }

/// The columns x y z roll pitch yaw repeat the matrix; a file where they differ was edited or shifted.
void check_motion_columns(const text::NumberRow& row, const RegistrationPair& pair) {
  const Vector6d again = make_pair(pair.key, pair.T_target_source, 0.0, 0.0).motion;
  for (int i = 0; i < 6; ++i) {
    const double off = i < 3 ? std::abs(again[i] - pair.motion[i]) : angle_difference(again[i], pair.motion[i]);
    if (off > 1e-3) {
      row.fail("column " + std::to_string(20 + i) + " contradicts the matrix in columns 4 to 19",
               "x y z in metres, roll pitch yaw in degrees with R = Rz(yaw) Ry(pitch) Rx(roll)");
    }
  }
}

RegistrationPair parse_pair(const text::NumberRow& row) {
  RegistrationPair pair;
  pair.key = {row.integer(0), row.integer(1), row.integer(2), row.integer(0)};
  if (row.values.size() == 28) {
    pair.key.target_session = row.integer(27);
  }
  pair.T_target_source = row.motion(3);
  for (std::size_t i = 0; i < 6; ++i) {
    pair.motion[static_cast<Eigen::Index>(i)] = row.values[19 + i];
  }
  check_motion_columns(row, pair);
  pair.overlap = row.values[25];
  pair.overlap_symmetric = row.values[26];
  for (const double overlap : {pair.overlap, pair.overlap_symmetric}) {
    if (overlap < 0.0 || overlap > 1.0) {
      row.fail("an overlap outside 0 to 1");
    }
  }
  return pair;
}

std::string key_text(const PairKey& key) {
  return std::to_string(key.session) + ' ' + std::to_string(key.source) + ' ' + std::to_string(key.target);
}

}  // namespace

std::string to_string(const PairKey& key) {
  if (key.session == key.target_session) {
    return "session " + std::to_string(key.session) + ": " + std::to_string(key.source) + " -> " +
           std::to_string(key.target);
  }
  return "session " + std::to_string(key.session) + " frame " + std::to_string(key.source) + " -> session " +
         std::to_string(key.target_session) + " frame " + std::to_string(key.target);
}

RegistrationPair make_pair(const PairKey& key, const Pose& T_target_source, double overlap, double overlap_symmetric) {
  RegistrationPair pair{key, T_target_source, {}, overlap, overlap_symmetric};
  pair.motion.head<3>() = T_target_source.translation();
  pair.motion.tail<3>() = euler_degrees(T_target_source.linear());
  return pair;
}

std::vector<RegistrationPair> read_pair_set(const std::filesystem::path& path) {
  std::vector<RegistrationPair> pairs;
  KeysSeen seen;
  text::for_each_row(path, kPairColumns, [&](const text::NumberRow& row) {
    pairs.push_back(parse_pair(row));
    seen.add(pairs.back().key, row);
  });
  if (pairs.empty()) {
    throw InputError(path.string(), "", "no pairs in this file", "a header line and rows of 27 columns are expected");
  }
  return pairs;
}

void write_pair_set(const std::filesystem::path& path, const std::vector<RegistrationPair>& pairs) {
  const bool two_drives = std::any_of(pairs.begin(), pairs.end(), [](const RegistrationPair& pair) {
    return pair.key.session != pair.key.target_session;
  });
  std::string content = kPairHeader;
  content += two_drives ? " target_session_ind\n" : "\n";
  for (const RegistrationPair& pair : pairs) {
    content += key_text(pair.key);
    text::append_motion(content, pair.T_target_source);
    for (const double value : pair.motion) {
      content += ' ';
      text::append_number(content, value);
    }
    for (const double value : {pair.overlap, pair.overlap_symmetric}) {
      content += ' ';
      text::append_number(content, value);
    }
    content += two_drives ? ' ' + std::to_string(pair.key.target_session) + '\n' : "\n";
  }
  storage::write_file_atomically(path, content);
}

std::vector<PairMotion> read_motions(const std::filesystem::path& path) {
  constexpr std::array<std::size_t, 2> kColumns = {19, 20};
  std::vector<PairMotion> motions;
  KeysSeen seen;
  text::for_each_row(path, kColumns, [&](const text::NumberRow& row) {
    const int target_session = row.integer(row.values.size() == 20 ? 19 : 0);
    motions.push_back({{row.integer(0), row.integer(1), row.integer(2), target_session}, row.motion(3)});
    seen.add(motions.back().key, row);
  });
  return motions;
}

void write_motions(const std::filesystem::path& path, const std::vector<PairMotion>& motions) {
  const bool two_drives = std::any_of(motions.begin(), motions.end(), [](const PairMotion& motion) {
    return motion.key.session != motion.key.target_session;
  });
  std::string content =
      "session_ind i j mot0 mot1 mot2 mot3 mot4 mot5 mot6 mot7 mot8 mot9 mot10 mot11 mot12 mot13 mot14 mot15";
  content += two_drives ? " target_session_ind\n" : "\n";
  for (const PairMotion& motion : motions) {
    content += key_text(motion.key);
    text::append_motion(content, motion.T_target_source);
    content += two_drives ? ' ' + std::to_string(motion.key.target_session) + '\n' : "\n";
  }
  storage::write_file_atomically(path, content);
}

std::vector<Pose> motions_of_pairs(const std::vector<RegistrationPair>& pairs, const std::vector<PairMotion>& motions,
                                   const std::filesystem::path& path) {
  std::map<PairKey, const PairMotion*> by_key;
  for (const PairMotion& motion : motions) {
    by_key.emplace(motion.key, &motion);
  }
  std::vector<Pose> ordered;
  for (const RegistrationPair& pair : pairs) {
    const auto found = by_key.find(pair.key);
    if (found == by_key.end()) {
      throw InputError(path.string(), "", "no motion for " + to_string(pair.key),
                       "the motions must be of the same set: " + std::to_string(pairs.size()) + " pairs, " +
                           std::to_string(motions.size()) + " motions");
    }
    ordered.push_back(found->second->T_target_source);
    by_key.erase(found);
  }
  if (!by_key.empty()) {
    throw InputError(path.string(), "",
                     "a motion for " + to_string(by_key.begin()->first) + ", which is not in the set",
                     "the motions must be of the same set");
  }
  return ordered;
}

std::vector<PairKey> read_negatives(const std::filesystem::path& path) {
  constexpr std::array<std::size_t, 1> kColumns = {4};
  std::vector<PairKey> negatives;
  KeysSeen seen;
  text::for_each_row(path, kColumns, [&](const text::NumberRow& row) {
    negatives.push_back({row.integer(0), row.integer(1), row.integer(3), row.integer(2)});
    seen.add(negatives.back(), row);
  });
  return negatives;
}

void write_negatives(const std::filesystem::path& path, const std::vector<PairKey>& negatives) {
  std::string content = "session_i i session_j j\n";
  for (const PairKey& key : negatives) {
    content += std::to_string(key.session) + ' ' + std::to_string(key.source) + ' ' +
               std::to_string(key.target_session) + ' ' + std::to_string(key.target) + '\n';
  }
  storage::write_file_atomically(path, content);
}

std::vector<Pose> read_perturbations(const std::filesystem::path& path, const std::vector<RegistrationPair>& pairs) {
  return motions_of_pairs(pairs, read_motions(path), path);
}

}  // namespace loopmark::pair_sets
