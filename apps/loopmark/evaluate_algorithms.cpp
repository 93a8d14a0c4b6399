// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate_algorithms.hpp"

#include <algorithm>

#include "loopmark/config/options_io.hpp"
#include "loopmark/core/error.hpp"
#include "loopmark/evaluation/external_algorithm.hpp"
#include "loopmark/evaluation/pair_algorithm.hpp"
#include "loopmark/feature_registration/named_algorithms.hpp"

namespace loopmark::app {
namespace {

/// "NAME=VALUE", or VALUE with another name.
std::pair<std::string, std::string> named(const std::string& text, const std::string& otherwise) {
  const std::size_t equals = text.find('=');
  const std::size_t other = text.find_first_of(" /");
  if (equals == std::string::npos || equals == 0 || other < equals) {
    return {otherwise, text};
  }
  return {text.substr(0, equals), text.substr(equals + 1)};
}

/// The algorithms of one experiment while they are collected.
class Collection {
 public:
  Collection(const EvaluateArguments& arguments, const workflows::ProgramOptions& options,
             const evaluation::EvaluatedSet& set)
      : arguments_(arguments), options_(options), set_(set) {}

  evaluation::AlgorithmList all() {
    for (const std::string& text : arguments_.motions) {
      const auto [name, file] = named(text, std::filesystem::path(text).stem().string());
      add(evaluation::make_motions_algorithm(
          name, pair_sets::motions_of_pairs(set_.pairs, pair_sets::read_motions(file), file)));
    }
    for (const std::string& name : all_names()) {
      if (name == "engine" || (arguments_.features.empty() && arguments_.descriptors.empty())) {
        add(by_name(name, {}));
        continue;
      }
      for (const std::string& descriptor : arguments_.descriptors) {
        add(by_name(name, {descriptor, {}}));
      }
      for (const std::string& text : arguments_.features) {
        const auto [domain, folder] = named(text, std::filesystem::path(text).filename().string());
        add(by_name(name, {domain, folder}));
      }
    }
    for (const std::string& text : arguments_.commands) {
      const auto [name, command] = named(text, "command");
      add(evaluation::make_external_algorithm(name, {command, arguments_.time_limit_s, 60.0, {}}));
    }
    return std::move(list_);
  }

 private:
  /// The engine when nothing else is asked for.
  std::vector<std::string> names() const {
    const bool nothing = arguments_.algorithms.empty() && arguments_.motions.empty() && arguments_.commands.empty();
    return nothing ? std::vector<std::string>{"engine"} : arguments_.algorithms;
  }

  std::unique_ptr<evaluation::RegistrationAlgorithm> by_name(const std::string& name,
                                                             const evaluation::DescriptorSource& descriptors) const {
    if (name == "engine") {
      return evaluation::make_pair_algorithm(registration::engine_registration(options_.registration),
                                             config::dump(options_.registration));
    }
    if (name.substr(0, name.find('#')) == "custom") {
      return evaluation::make_configured_algorithm(name, options_.paper, config::dump(options_.paper), descriptors);
    }
    return evaluation::make_named_algorithm(name, descriptors);
  }

  /// The names that one word of --algorithms stands for.
  static std::vector<std::string> expanded(const std::string& word) {
    if (word == "paper") {
      return {"ransac_mutual", "ransac_gpf", "gnc_clique", "sc2"};
    }
    std::vector<std::string> names;
    for (const feature_registration::NamedAlgorithm& algorithm : feature_registration::named_algorithms()) {
      const bool gpf = algorithm.ablation == "phi" || algorithm.ablation == "iterations";
      const bool ransac = algorithm.ablation == "roles" || algorithm.ablation == "local";
      if (word == "all" || (word == "gpf-ablation" && gpf) || (word == "ransac-ablation" && ransac)) {
        names.push_back(algorithm.name);
      }
    }
    return names.empty() ? std::vector<std::string>{word} : names;
  }

  std::vector<std::string> all_names() const {
    std::vector<std::string> all;
    for (const std::string& word : names()) {
      for (const std::string& name : expanded(word)) {
        for (std::size_t k = 1; k <= arguments_.repeats; ++k) {
          all.push_back(arguments_.repeats > 1 && name != "engine" ? name + "#" + std::to_string(k) : name);
        }
      }
    }
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  void add(std::unique_ptr<evaluation::RegistrationAlgorithm> algorithm) {
    const std::string name = algorithm->name();
    list_.push_back(std::move(algorithm));
    for (const std::string& method : arguments_.refine) {
      list_.push_back(evaluation::make_refined_algorithm(name, method));
    }
  }

  const EvaluateArguments& arguments_;
  const workflows::ProgramOptions& options_;
  const evaluation::EvaluatedSet& set_;
  evaluation::AlgorithmList list_;
};

}  // namespace

evaluation::AlgorithmList make_algorithms(const EvaluateArguments& arguments, const workflows::ProgramOptions& options,
                                          const evaluation::EvaluatedSet& set) {
  return Collection(arguments, options, set).all();
}

}  // namespace loopmark::app
