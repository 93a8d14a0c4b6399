// SPDX-FileCopyrightText: loopmark contributors
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace loopmark::report::internal {

inline constexpr char kPageStyle[] = R"css(
body { margin: 0 auto; max-width: 1320px; padding: 0 24px 48px; color: #222; background: #fff;
  font: 15px/1.5 system-ui, 'DejaVu Sans', sans-serif; }
header { border-bottom: 1px solid #ddd; margin-bottom: 12px; }
h1 { font-size: 24px; margin: 24px 0 0; }
header p { color: #555; margin: 2px 0 12px; overflow-wrap: anywhere; }
h2 { font-size: 18px; margin: 32px 0 8px; }
nav { display: flex; flex-wrap: wrap; gap: 4px 18px; }
nav a { color: #0072b2; text-decoration: none; }
figure { margin: 8px 0; }
figure svg, figure img { max-width: 100%; height: auto; }
figcaption, caption { color: #555; font-size: 13px; text-align: left; padding: 2px 0; }
.row { display: flex; flex-wrap: wrap; gap: 8px; }
.facts { display: flex; flex-wrap: wrap; gap: 8px; margin: 8px 0; }
.facts div { border: 1px solid #ddd; border-radius: 6px; padding: 6px 14px; min-width: 96px; }
.facts dt { color: #555; font-size: 12px; }
.facts dd { margin: 0; font-size: 19px; font-weight: 600; }
.wide { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; margin: 8px 0; }
th, td { border-bottom: 1px solid #e4e4e4; padding: 3px 10px; text-align: left; vertical-align: top; }
th { border-bottom: 2px solid #bbb; cursor: pointer; white-space: nowrap; }
th[aria-sort=ascending]::after { content: ' \2191'; }
th[aria-sort=descending]::after { content: ' \2193'; }
.number { text-align: right; font-variant-numeric: tabular-nums; }
pre { background: #f6f6f6; padding: 10px 14px; overflow-x: auto; font-size: 13px; }
summary { cursor: pointer; color: #0072b2; margin: 8px 0; }
@media print { nav { display: none; } }
)css";

/// Sorts a table by the column whose name is clicked: numbers by value, others as text; a second click turns it round.
inline constexpr char kPageScript[] = R"js(
document.querySelectorAll('table.sortable').forEach(function (table) {
  var heads = Array.from(table.tHead.rows[0].cells);
  heads.forEach(function (head, column) {
    head.addEventListener('click', function () {
      var down = head.getAttribute('aria-sort') === 'ascending';
      heads.forEach(function (other) { other.removeAttribute('aria-sort'); });
      head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
      var key = function (row) { return row.cells[column].dataset.sort; };
      var rows = Array.from(table.tBodies[0].rows);
      rows.sort(function (a, b) {
        var x = key(a), y = key(b);
        var order = x !== undefined && y !== undefined ? x - y
          : x !== undefined ? 1 : y !== undefined ? -1
          : a.cells[column].textContent.localeCompare(b.cells[column].textContent);
        return down ? -order : order;
      });
      rows.forEach(function (row) { table.tBodies[0].appendChild(row); });
    });
  });
});
)js";

}  // namespace loopmark::report::internal
