// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>

#include "loopmark/evaluation/balance_options.hpp"
#include "loopmark/io/dataset.hpp"
#include "loopmark/occupancy/occupancy_options.hpp"
#include "loopmark/odometry/options.hpp"
#include "loopmark/pose_graph/pose_graph_options.hpp"
#include "loopmark/registration/engine_options.hpp"
#include "loopmark/registration/paper_options.hpp"
#include "loopmark/simulation/options.hpp"
#include "loopmark/slam/drill_options.hpp"
#include "loopmark/slam/options.hpp"
#include "loopmark/slam/relocalization_options.hpp"

namespace loopmark::app {

/// Every option of every room; the sections of the YAML file.
struct AppOptions {
  LogOptions log;
  DatasetOptions dataset;
  OdometryOptions odometry;
  EngineOptions registration;
  PaperOptions paper;
  SlamOptions slam;
  PoseGraphOptions pose_graph;
  OccupancyOptions occupancy;
  RelocalizationOptions relocalization;
  DrillOptions drill;
  BalanceOptions balance;
  simulation::SimulationOptions simulation;
};

template <class Visitor>
void describe(Visitor& v, AppOptions& o) {
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
std::string options_as_yaml(const AppOptions& options);

}  // namespace loopmark::app
