// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
/// One HTML file that works offline: data, the script that shows them, and the words that stand for themselves.
#pragma once

#include <ostream>
#include <string>
#include <vector>

namespace loopmark::web_page {

/// What a page says without its script: shown until the script runs, and all there is where none was built in.
struct Words {
  std::string heading;
  std::vector<std::string> lines;  ///< a paragraph each
};

class Document {
 public:
  /// `json`: what the script reads first. Whatever stands in it, names of files included, cannot leave its element.
  Document(std::string title, std::string json, std::vector<Words> words);

  void add(std::string block);  ///< of web_page::block

  /// Lets the page's script talk to the server that it comes from, and to no other.
  void allow_own_server() { served_ = true; }

  /// The page refers to nothing outside itself and forbids scripts but its own (Content-Security-Policy).
  void write(std::ostream& out) const;

  /// The data alone, for a page that is open already.
  std::string data() const;

 private:
  std::string json_element() const;

  std::string title_;
  std::string json_;
  std::vector<Words> words_;
  std::vector<std::string> blocks_;
  bool served_ = false;
};

}  // namespace loopmark::web_page
