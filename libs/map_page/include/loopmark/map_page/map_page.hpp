// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// The map of a run as one page: to be walked through in 3-D, with its loops, its doubts and its tables.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "loopmark/core/point_cloud.hpp"
#include "loopmark/map_page/answers.hpp"
#include "loopmark/map_page/findings.hpp"
#include "loopmark/web_page/document.hpp"

namespace loopmark::map_page {

/// Some of the scans, which were driven at one time.
struct Session {
  std::string name;
  std::size_t first_scan = 0;
  std::size_t scans = 0;
};

/// A table that is shown as it is.
struct PageTable {
  std::string title;
  std::vector<std::string> columns;
  std::vector<std::vector<std::string>> rows;
};

struct MapPageOptions {
  std::size_t max_points = 5'000'000;  ///< of the cloud; finest levels of detail are left out where there are more
};

/// What a page that comes from a server can have done.
struct Edits {
  bool possible = false;                  ///< the page offers them
  std::vector<std::string> unsaved = {};  ///< as options of `loopmark loops`, in the order in which they were made
};

struct MapPageInput {
  std::string name;                                        ///< of the run, for people
  std::string run;                                         ///< as commands name it
  std::vector<std::pair<std::string, std::string>> facts;  ///< key figures
  std::string note;                                        ///< definitions of what stands in the facts
  std::vector<std::pair<std::string, double>> time_parts;  ///< seconds
  std::vector<Session> sessions;                           ///< none: the run is one
  std::vector<PageTable> tables;                           ///< more of them
  Edits edits;                                             ///< of a served page
  MapRecords records;                                      ///< what is shown
  std::optional<AnswerLayer> answers;                      ///< shown on the map
  /// A page of the same keyframes, whose cloud is shown again; empty, or one that does not fit: made anew.
  std::filesystem::path earlier_page;
  std::function<PointCloud(std::size_t)> keyframe_cloud;  ///< points in the keyframe's frame; called from any thread
};

/// The page. The same input gives the same bytes at any number of threads.
web_page::Document map_page(const MapPageInput& input, const MapPageOptions& options = {});

/// What an open page needs when the map has been solved again: all but the cloud, which stands in the frames of the
/// keyframes. `message`: what the person is told.
std::string map_update(const MapPageInput& input, const std::string& message);

}  // namespace loopmark::map_page
