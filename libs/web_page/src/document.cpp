// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/web_page/document.hpp"

#include <utility>

#include "loopmark/storage/sha256.hpp"
#include "loopmark/web_page/base64.hpp"
#include "loopmark/web_page/bundle.hpp"

namespace loopmark::web_page {
namespace {

std::string escaped(const std::string& text) {
  std::string result;
  for (const char c : text) {
    switch (c) {
      case '&':
        result += "&amp;";
        break;
      case '<':
        result += "&lt;";
        break;
      case '>':
        result += "&gt;";
        break;
      case '"':
        result += "&quot;";
        break;
      default:
        result += c;
    }
  }
  return result;
}

/// JSON in which no '<' is left: "</script>" inside a string must not end the element. It stands in strings only.
std::string inside_script(const std::string& json) {
  std::string result;
  result.reserve(json.size());
  for (const char c : json) {
    if (c == '<') {
      result += "\\u003c";
    } else {
      result += c;
    }
  }
  return result;
}

/// The digest as Content-Security-Policy wants it.
std::string sha256_base64(std::string_view text) {
  storage::Sha256 sum;
  sum.add(text);
  const std::string digits = sum.hex();
  std::string bytes;
  for (std::size_t i = 0; i < digits.size(); i += 2) {
    bytes += static_cast<char>(std::stoi(digits.substr(i, 2), nullptr, 16));
  }
  return base64(bytes);
}

}  // namespace

Document::Document(std::string title, std::string json, std::vector<Words> words)
    : title_(std::move(title)), json_(std::move(json)), words_(std::move(words)) {}

void Document::add(std::string block) { blocks_.push_back(std::move(block)); }

std::string Document::json_element() const {
  return "<script type=\"application/json\" id=\"page-data\">" + inside_script(json_) + "</script>\n";
}

std::string Document::data() const {
  std::string text = json_element();
  for (const std::string& block : blocks_) {
    text += block;
  }
  return text;
}

void Document::write(std::ostream& out) const {
  const Bundle& made = bundle();
  out << "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<link rel=\"icon\" href=\"data:,\">\n"  // else browsers ask a server for one
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'sha256-"
      << sha256_base64(made.script)
      << "'; style-src 'unsafe-inline'; img-src data: blob:" << (served_ ? "; connect-src 'self'" : "")
      << "\">\n<title>" << escaped(title_) << "</title>\n<style>" << made.style
      << "</style>\n</head>\n<body>\n<div id=\"app\">\n";
  if (!made.problem.empty()) {
    out << "<p role=\"alert\"><b>This page has no map, plots or tables: " << escaped(std::string(made.problem))
        << ". Install nodejs, npm and esbuild, build loopmark again with a network, and make the page anew.</b></p>\n";
  }
  for (const Words& part : words_) {
    out << "<h2>" << escaped(part.heading) << "</h2>\n";
    for (const std::string& line : part.lines) {
      out << "<p>" << escaped(line) << "</p>\n";
    }
  }
  out << "</div>\n";
  if (made.problem.empty()) {
    out << data() << "<script>" << made.script << "</script>\n";
  } else {
    out << json_element();
  }
  out << "</body>\n</html>\n";
}

}  // namespace loopmark::web_page
