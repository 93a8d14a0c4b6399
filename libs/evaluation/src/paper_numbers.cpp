// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/evaluation/paper_numbers.hpp"

namespace loopmark::evaluation::paper {

const std::vector<EvaluationRow>& evaluation() {
  static const std::vector<EvaluationRow> rows = {{"DGR", 57.91, 0.453, 61.81, 0.494},
                                                  {"PointDSC", 80.56, 0.236, 82.48, 0.290},
                                                  {"TEASER++", 77.43, 0.331, 86.88, 0.378},
                                                  {"RANSAC (mutual)", 84.14, 0.040, 89.01, 0.099},
                                                  {"RANSAC (GPF)", 86.88, 0.199, 91.90, 0.257}};
  return rows;
}

const std::vector<EvaluationRow>& cross_domain() {
  static const std::vector<EvaluationRow> rows = {{"DGR", 44.95, 0.418, 48.07, 0.462},
                                                  {"PointDSC", 63.97, 0.234, 66.78, 0.293},
                                                  {"TEASER++", 59.88, 0.146, 71.99, 0.213},
                                                  {"RANSAC (mutual)", 66.94, 0.107, 74.31, 0.171},
                                                  {"RANSAC (GPF)", 69.14, 0.113, 77.70, 0.177}};
  return rows;
}

const std::vector<std::string>& domain_algorithms() {
  static const std::vector<std::string> names = {"RANSAC (GPF)", "RANSAC (mutual)", "PointDSC", "TEASER++"};
  return names;
}

const std::vector<DomainRow>& domains() {
  static const std::vector<DomainRow> rows = {
      {"Apollo", "Apollo", {98.97, 96.97, 94.02, 96.65}, {0.326, 0.292, 0.691, 0.781}, 23520, 2123},
      {"Apollo", "Boston", {93.84, 93.25, 88.53, 92.62}, {0.336, 0.330, 0.725, 0.354}, 23520, 1717},
      {"Apollo", "Singapore", {97.52, 94.86, 93.54, 95.16}, {0.346, 0.317, 0.702, 0.449}, 23520, 1830},
      {"Boston", "Apollo", {77.70, 75.31, 66.40, 72.11}, {0.177, 0.171, 0.451, 0.277}, 8091, 766},
      {"Boston", "Boston", {91.13, 89.39, 82.37, 86.88}, {0.157, 0.098, 0.432, 0.486}, 8091, 837},
      {"Boston", "Singapore", {85.61, 80.79, 75.39, 79.63}, {0.177, 0.124, 0.437, 0.477}, 8091, 841},
      {"Singapore", "Apollo", {88.43, 87.92, 79.01, 86.69}, {0.228, 0.202, 0.616, 0.250}, 10335, 1106},
      {"Singapore", "Boston", {91.47, 90.59, 82.02, 89.16}, {0.224, 0.147, 0.608, 0.258}, 10335, 1104},
      {"Singapore", "Singapore", {94.60, 93.75, 90.59, 93.29}, {0.237, 0.119, 0.589, 0.846}, 10335, 1198}};
  return rows;
}

const std::vector<RefinementRow>& refinement() {
  static const std::vector<RefinementRow> rows = {{"ICP", 98.99, {80.65, 11.76, 30.29}, {0.37, 0.13, 0.33}},
                                                  {"BBR-F", 96.33, {86.98, 15.10, 52.84}, {0.47, 0.19, 0.66}},
                                                  {"sym-ICP", 67.74, {548.85, 17.68, 3544.49}, {2.31, 0.22, 10.66}}};
  return rows;
}

const std::vector<SetSizes>& set_sizes() {
  static const std::vector<SetSizes> rows = {{"KITTI-10m", 1338, 200, 555},
                                             {"NuScenes-Boston-Balanced", 4032, 384, 2592},
                                             {"NuScenes-Singapore-Balanced", 4032, 384, 2592},
                                             {"Apollo-Southbay-Balanced", 4032, 288, 7008}};
  return rows;
}

}  // namespace loopmark::evaluation::paper
