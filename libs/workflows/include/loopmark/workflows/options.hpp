// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/feature_registration/options.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/kidnap_benchmark/drill_options.hpp"
#include "loopmark/localization/relocalization_options.hpp"
#include "loopmark/mapping/options.hpp"
#include "loopmark/occupancy/occupancy_options.hpp"
#include "loopmark/odometry/options.hpp"
#include "loopmark/pair_sets/balance_options.hpp"
#include "loopmark/pose_graph/pose_graph_options.hpp"
#include "loopmark/registration/engine_options.hpp"
#include "loopmark/simulation/options.hpp"

namespace loopmark::workflows {

/// Every option of every room; the sections of the YAML file.
struct ProgramOptions {
  io::LogOptions log;
  io::DatasetOptions dataset;
  odometry::OdometryOptions odometry;
  registration::EngineOptions registration;
  feature_registration::FeatureRegistrationOptions paper;
  mapping::SlamOptions slam;
  pose_graph::PoseGraphOptions pose_graph;
  occupancy::OccupancyOptions occupancy;
  localization::RelocalizationOptions relocalization;
  kidnap_benchmark::DrillOptions drill;
  pair_sets::BalanceOptions balance;
  simulation::SimulationOptions simulation;
};

template <class Visitor>
void describe(Visitor& v, ProgramOptions& o) {
  v.section("log", o.log, "reading of drive logs");
  v.section("dataset", o.dataset, "data sets of many drives");
  v.section("odometry", o.odometry, "alignment of each scan to a local map");
  v.section("registration", o.registration, "global registration of two scans");
  v.section("paper", o.paper, "the paper's pipeline, step by step, for the algorithm called custom");
  v.section("slam", o.slam, "keyframes, loops and the map");
  v.section("pose_graph", o.pose_graph, "robust solution of the pose graph");
  v.section("occupancy", o.occupancy, "OctoMap");
  v.section("relocalization", o.relocalization, "finding a place in a map");
  v.section("drill", o.drill, "cuts in tracking and what counts as found again");
  v.section("balance", o.balance, "choice of balanced sets of frame pairs");
  v.section("simulation", o.simulation, "simulated towns, drives and pairs");
}

/// All options as commented YAML, which --config reads back: `loopmark config dump`, a run's config.yaml.
std::string options_as_yaml(const ProgramOptions& options);

}  // namespace loopmark::workflows
