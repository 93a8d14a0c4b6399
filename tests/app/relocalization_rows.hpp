// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// Reads relocalization.csv as a program of a user would: by the names of its columns.
#pragma once

#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "loopmark/core/pose.hpp"

namespace loopmark::testing_support {

struct RelocalizationRow {
  std::size_t scan = 0;
  double stamp_s = 0.0;
  std::string state;
  bool given_up = false;
  bool answered = false;
  double p_correct = 0.0;
  Pose T_map_lidar = Pose::Identity();
  std::optional<Matrix6d> covariance;
  std::string reason;
};

using NamedCells = std::map<std::string, std::string>;

inline std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');) {
    cells.push_back(cell);
  }
  return cells;
}

/// The pose and its covariance, where the row has them.
inline void read_pose(const NamedCells& cells, RelocalizationRow& row) {
  const auto number = [&](const std::string& name) { return std::stod(cells.at(name)); };
  const Eigen::Quaterniond q(number("qw"), number("qx"), number("qy"), number("qz"));
  row.T_map_lidar.linear() = q.normalized().toRotationMatrix();
  row.T_map_lidar.translation() << number("x"), number("y"), number("z");
  Matrix6d covariance;
  for (int r = 0; r < 6; ++r) {
    for (int c = r; c < 6; ++c) {
      covariance(r, c) = covariance(c, r) = number("cov_" + std::to_string(r) + std::to_string(c));
    }
  }
  row.covariance = covariance;
}

/// Throws std::out_of_range where a column is missing, std::invalid_argument where a number is none.
inline std::vector<RelocalizationRow> relocalization_rows(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::string line;
  std::getline(stream, line);
  const std::vector<std::string> names = cells_of(line);
  std::vector<RelocalizationRow> rows;
  while (std::getline(stream, line)) {
    const std::vector<std::string> values = cells_of(line);
    NamedCells cells;
    for (std::size_t i = 0; i < names.size(); ++i) {
      cells[names[i]] = values.at(i);
    }
    RelocalizationRow row;
    row.scan = std::stoul(cells.at("scan"));
    row.stamp_s = std::stod(cells.at("stamp_s"));
    row.state = cells.at("state");
    row.given_up = cells.at("given_up") == "1";
    row.answered = cells.at("answered") == "1";
    row.p_correct = std::stod(cells.at("p_correct"));
    row.reason = cells.at("reason");
    if (!cells.at("x").empty()) {
      read_pose(cells, row);
    }
    rows.push_back(std::move(row));
  }
  return rows;
}

}  // namespace loopmark::testing_support
