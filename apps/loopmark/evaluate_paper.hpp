// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace loopmark::app {

struct PaperArguments {
  std::string table;                ///< which table or figure
  std::vector<std::string> inputs;  ///< result folders, [TEST:TRAIN=]RESULT, or set files [NAME=]FILE
  std::string algorithm;            ///< for the failure analysis
  std::filesystem::path output;     ///< folder for .md, .tex and .html
};

/// Names of the tables and figures that print_paper_table knows.
std::vector<std::string> paper_table_names();

/// Makes one table or figure of the paper from results, prints it, and writes it as Markdown, LaTeX and a page.
int print_paper_table(const PaperArguments& arguments);

struct CompareArguments {
  std::filesystem::path first, second;
  std::filesystem::path output;  ///< folder for compare.csv and compare.html; empty: only print
};

/// Puts two results of the same set side by side, pair by pair.
int compare_results(const CompareArguments& arguments);

}  // namespace loopmark::app
