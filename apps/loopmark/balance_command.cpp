// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// loopmark balance: chooses balanced sets of frame pairs from drives with poses.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>

#include "commands.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/pair_sets/balanced_selection.hpp"
#include "loopmark/pair_sets/hard_negatives.hpp"
#include "loopmark/pair_sets/reference_refinement.hpp"
#include "loopmark/pair_sets/set_statistics.hpp"
#include "loopmark/storage/files.hpp"
#include "loopmark/workflows/balance_drives.hpp"

namespace loopmark::app {
namespace {

namespace fs = std::filesystem;

constexpr const char* kExamples = R"(
Examples:
  loopmark balance drives/day1 drives/day2 --pairs 500 -o SET
      a balanced set of the paper's kind: SET/pairs.txt and SET/sessions.txt, SET/strata.md says what is in it
  loopmark balance APOLLO --subset test:7008:20-26 --subset validation:288:15-19 -o SET
      subsets from drives of their own: SET/test.txt and SET/validation.txt
  loopmark balance drives/day1 drives/day2 --same-world --revisits 200 --negatives 100 -o SET
      with true revisits (other times, other drives) and pairs of different places that look alike
  loopmark evaluate SET/pairs.txt --data drives -o RESULT
Options of the generator: --set balance.radius=0.1 and so on (loopmark config dump shows them).)";

struct BalanceArguments {
  std::vector<fs::path> logs;
  fs::path output;
  fs::path poses;
  std::size_t pairs = 500;
  std::vector<std::string> subsets;
  std::size_t revisits = 0;
  std::size_t negatives = 0;
  bool same_world = false;
  std::string refine = "none";
  long long seed = -1;
};

/// A named part of the set, with drives of its own.
struct Subset {
  std::string name;
  std::size_t pairs = 0;
  std::vector<int> sessions;  ///< none: all
};

Subset parse_subset(const std::string& text) {
  std::istringstream parts(text);
  Subset subset;
  std::string count, sessions;
  std::getline(parts, subset.name, ':');
  std::getline(parts, count, ':');
  std::getline(parts, sessions);
  if (subset.name.empty() || count.empty() || count.find_first_not_of("0123456789") != std::string::npos) {
    throw InputError("--subset " + text + ": not NAME:PAIRS:SESSIONS, such as test:555:8-10");
  }
  subset.pairs = std::stoul(count);
  subset.sessions = workflows::parse_sessions(sessions);
  return subset;
}

pair_sets::ReferenceRefinement refinement_from(const std::string& name) {
  if (name == "icp") {
    return pair_sets::ReferenceRefinement::kIcp;
  }
  return name == "z" ? pair_sets::ReferenceRefinement::kHeight : pair_sets::ReferenceRefinement::kNone;
}

/// One run of the command.
class Balancer {
 public:
  Balancer(const BalanceArguments& arguments, const pair_sets::BalanceOptions& options)
      : a_(arguments), options_(options), list_(workflows::open_drives(arguments.logs, arguments.poses)) {
    const bool one_file = a_.output.extension() == ".txt";
    folder_ = one_file ? a_.output.parent_path() : a_.output;
    subsets_ = {{one_file ? a_.output.stem().string() : "pairs", a_.pairs, {}}};
    if (!a_.subsets.empty()) {
      subsets_.clear();
      std::transform(a_.subsets.begin(), a_.subsets.end(), std::back_inserter(subsets_), parse_subset);
    }
    for (const Subset& subset : subsets_) {
      wanted_ += subset.pairs;
    }
  }

  int run() {
    if (!folder_.empty()) {
      fs::create_directories(folder_);
    }
    write_sessions();
    const std::vector<pair_sets::RegistrationPair> pool =
        pair_sets::make_candidate_pool(list_.drives, wanted_, options_, folder_ / "candidates.records", &cost_);
    print_cost(pool.size());
    for (const Subset& subset : subsets_) {
      write_subset(subset, pool);
    }
    if (a_.revisits > 0) {
      write_subset({"revisits", a_.revisits, {}},
                   pair_sets::make_revisit_pool(list_.drives, a_.revisits, a_.same_world, options_));
    }
    if (a_.negatives > 0) {
      const auto negatives = pair_sets::find_hard_negatives(list_.drives, a_.negatives, a_.same_world, options_);
      pair_sets::write_negatives(folder_ / "negatives.txt", negatives);
      std::printf("negatives.txt: %zu pairs of different places that look alike (%zu asked for)\n", negatives.size(),
                  a_.negatives);
    }
    storage::write_file_atomically(folder_ / "strata.md", strata_);
    std::printf("written to %s; next: loopmark evaluate %s --data %s -o RESULT\n", folder_.c_str(),
                (folder_ / (subsets_.front().name + ".txt")).c_str(), list_.root.c_str());
    return 0;
  }

 private:
  void write_sessions() const {
    if (!list_.needs_sessions) {
      return;
    }
    std::string text = "index name\n";
    for (const pair_sets::Drive& drive : list_.drives) {
      text += std::to_string(drive.session) + ' ' + drive.name + '\n';
    }
    storage::write_file_atomically(folder_ / "sessions.txt", text);
  }

  void print_cost(std::size_t candidates) const {
    const double each = cost_.overlaps == 0 ? 0.0 : 1000.0 * cost_.seconds / static_cast<double>(cost_.overlaps);
    std::printf("%zu candidates; %zu overlaps of %zu scans in %.1f s (%.1f ms each)\n", candidates, cost_.overlaps,
                cost_.scans, cost_.seconds, each);
  }

  void write_subset(const Subset& subset, std::vector<pair_sets::RegistrationPair> pool) {
    std::erase_if(pool, [&](const pair_sets::RegistrationPair& pair) {
      const auto& wanted = subset.sessions;
      return !wanted.empty() && std::find(wanted.begin(), wanted.end(), pair.key.session) == wanted.end();
    });
    pair_sets::SelectionReport report;
    std::vector<pair_sets::RegistrationPair> pairs = pair_sets::select_balanced(pool, subset.pairs, options_, &report);
    const pair_sets::RefinementReport refined =
        pair_sets::refine_references(pairs, list_.drives, refinement_from(a_.refine));
    if (refined.refined + refined.kept > 0) {
      std::printf("%s: %zu reference motions refined (median %.3f m), %zu kept as they were\n", subset.name.c_str(),
                  refined.refined, refined.median_shift_m, refined.kept);
    }
    if (pairs.empty()) {
      std::printf("%s: no pair has enough overlap\n", subset.name.c_str());
      return;
    }
    pair_sets::write_pair_set(folder_ / (subset.name + ".txt"), pairs);
    std::printf("%s.txt: %zu pairs (%zu asked for)\n", subset.name.c_str(), pairs.size(), subset.pairs);
    const text::TextTable evenness = pair_sets::evenness_table(pairs, pool, options_.seed);
    std::printf("\n%s\n", text::to_markdown(evenness).c_str());
    strata_ += "# " + subset.name + "\n\n";
    for (const text::TextTable& table : {pair_sets::set_overview({{subset.name, pairs}}), evenness,
                                         pair_sets::fairness_table(report), pair_sets::strata_table(pairs)}) {
      strata_ += text::to_markdown(table) + '\n';
    }
  }

  const BalanceArguments& a_;
  const pair_sets::BalanceOptions& options_;
  workflows::DriveList list_;
  fs::path folder_;
  std::vector<Subset> subsets_;
  std::size_t wanted_ = 0;
  pair_sets::PoolCost cost_;
  std::string strata_;
};

}  // namespace

Action set_up_balance(CLI::App& command, const Globals& globals) {
  const auto a = std::make_shared<BalanceArguments>();
  command.footer(kExamples);
  command.add_option("logs", a->logs, "drive logs with poses, or the root folder of a data set")->required();
  command.add_option("-o,--output", a->output, "folder for the set, or its file NAME.txt")->required();
  command.add_option("--pairs", a->pairs, "pairs to choose (500)");
  command.add_option("--subset", a->subsets,
                     "NAME:PAIRS:SESSIONS, such as test:555:8-10; may be repeated; replaces --pairs");
  command.add_option("--poses", a->poses, "reference poses of a log that has none, one a scan (TUM or KITTI)");
  command.add_option("--revisits", a->revisits, "pairs more than balance.max_gap_s apart, any direction");
  command.add_flag("--same-world", a->same_world, "the poses of all drives are of one world: revisits between drives");
  command.add_option("--negatives", a->negatives, "pairs of different places that look alike");
  command.add_option("--refine", a->refine, "reference motions: none, icp, or z (height only, for nuScenes)")
      ->check(CLI::IsMember({"none", "icp", "z"}));
  command.add_option("--seed", a->seed, "seed of everything random; default: balance.seed");
  return interruptible(
      [a, &globals] {
        pair_sets::BalanceOptions options = globals.options().balance;
        options.seed = a->seed >= 0 ? static_cast<std::uint64_t>(a->seed) : options.seed;
        return Balancer(*a, options).run();
      },
      [] { return "the candidates found so far are kept; the same command goes on with them"; });
}

}  // namespace loopmark::app
