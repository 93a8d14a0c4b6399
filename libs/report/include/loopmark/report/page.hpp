// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// A self-contained HTML page: works offline, refers to nothing outside itself.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "loopmark/report/picture.hpp"
#include "loopmark/report/plot.hpp"
#include "loopmark/report/table.hpp"

namespace loopmark::report {

class Page {
 public:
  explicit Page(std::string title, std::string subtitle = "");

  Page& heading(const std::string& text);    ///< stands in the list of contents
  Page& paragraph(const std::string& text);  ///< plain text
  Page& code(const std::string& text);       ///< as it is, in a fixed-width font
  /// Key figures as tiles: name and value.
  Page& facts(const std::vector<std::pair<std::string, std::string>>& name_value);
  Page& plot(const Plot& plot, const std::string& caption = "");
  Page& plots(const std::vector<Plot>& row);  ///< side by side where the window is wide enough
  Page& table(const Table& table);
  Page& picture(const Image& image, const std::string& caption = "");
  /// The parts of `body` behind a line that opens with a click.
  Page& details(const std::string& summary, const Page& body);

  std::string html() const;

 private:
  std::string title_;
  std::string subtitle_;
  std::vector<std::string> headings_;
  std::string body_;
};

}  // namespace loopmark::report
