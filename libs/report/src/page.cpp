// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#include "loopmark/report/page.hpp"

#include "page_style.hpp"
#include "text.hpp"

namespace loopmark::report {
namespace {

std::string figure(const std::string& inside, const std::string& caption) {
  return "<figure>" + inside +
         (caption.empty() ? "" : "<figcaption>" + internal::escape_markup(caption) + "</figcaption>") + "</figure>\n";
}

/// A name for links inside the page: letters and digits, the others as '-'.
std::string anchor_of(const std::string& heading) {
  std::string name;
  for (const char c : heading) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
    name += plain ? c : '-';
  }
  return name;
}

}  // namespace

Page::Page(std::string title, std::string subtitle) : title_(std::move(title)), subtitle_(std::move(subtitle)) {}

Page& Page::heading(const std::string& text) {
  headings_.push_back(text);
  body_ += "<h2 id=\"" + anchor_of(text) + "\">" + internal::escape_markup(text) + "</h2>\n";
  return *this;
}

Page& Page::paragraph(const std::string& text) {
  body_ += "<p>" + internal::escape_markup(text) + "</p>\n";
  return *this;
}

Page& Page::code(const std::string& text) {
  body_ += "<pre>" + internal::escape_markup(text) + "</pre>\n";
  return *this;
}

Page& Page::facts(const std::vector<std::pair<std::string, std::string>>& name_value) {
  body_ += "<dl class=\"facts\">\n";
  for (const auto& [name, value] : name_value) {
    body_ +=
        "<div><dt>" + internal::escape_markup(name) + "</dt><dd>" + internal::escape_markup(value) + "</dd></div>\n";
  }
  body_ += "</dl>\n";
  return *this;
}

Page& Page::plot(const Plot& plot, const std::string& caption) {
  body_ += figure(plot.svg(), caption);
  return *this;
}

Page& Page::plots(const std::vector<Plot>& row) {
  body_ += "<div class=\"row\">\n";
  for (const Plot& one : row) {
    plot(one);
  }
  body_ += "</div>\n";
  return *this;
}

Page& Page::table(const Table& table) {
  body_ += "<div class=\"wide\">" + table.html() + "</div>\n";
  return *this;
}

Page& Page::picture(const Image& image, const std::string& caption) {
  body_ += figure(
      "<img alt=\"" + internal::escape_markup(caption) + "\" src=\"" + internal::png_data_uri(png_bytes(image)) + "\">",
      caption);
  return *this;
}

Page& Page::details(const std::string& summary, const Page& body) {
  body_ += "<details><summary>" + internal::escape_markup(summary) + "</summary>\n" + body.body_ + "</details>\n";
  return *this;
}

std::string Page::html() const {
  const std::string title = internal::escape_markup(title_);
  std::string text = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  text += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" + title + "</title>\n";
  text += std::string("<style>") + internal::kPageStyle + "</style>\n</head>\n<body>\n<header><h1>" + title + "</h1>";
  text += subtitle_.empty() ? "" : "<p>" + internal::escape_markup(subtitle_) + "</p>";
  text += "</header>\n";
  if (headings_.size() > 1) {
    text += "<nav>";
    for (const std::string& heading : headings_) {
      text += "<a href=\"#" + anchor_of(heading) + "\">" + internal::escape_markup(heading) + "</a>";
    }
    text += "</nav>\n";
  }
  return text + "<main>\n" + body_ + "</main>\n<script>" + internal::kPageScript + "</script>\n</body>\n</html>\n";
}

}  // namespace loopmark::report
