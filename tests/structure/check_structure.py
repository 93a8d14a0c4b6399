#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the source tree against the layer table (cmake/layers.txt) and the rules beside it.

usage: check_structure.py SOURCE_DIR

- A room includes only itself and rooms of lower floors; its CMake DEPS likewise.
- Public headers include no foreign library but Eigen; mrpt_bridge may include MRPT in its own.
- Private headers are included from their own room only.
- Libraries do not print: no std::cout, std::cerr or printf to them.
- The table in docs/architecture.md is that of cmake/layers.txt.
- Links between the Markdown files lead to files that are there.
- Every C++ file starts with the two SPDX lines; every header with #pragma once.
Prints one line "FILE:LINE: PROBLEM" for each finding; exit code 1 when there is any.
"""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]')
FOREIGN = re.compile(r"^(pcl|mrpt|ceres|embree3|octomap|yaml-cpp|tbb|oneapi|open3d|nlohmann|hwy|CLI)/"
                     r"|^(nanoflann\.hpp|png\.h|zlib\.h|zstd\.h|kiss_fft\w*\.h|rtcore\w*\.h)$")
ALLOWED_IN_PUBLIC = {"mrpt_bridge": re.compile(r"^mrpt/")}
PRINTS = re.compile(r"std::(cout|cerr)\b|\bstd::puts\(|\bstd::printf\(|fprintf\(stdout")
SPDX = ["// SPDX-FileCopyrightText: loopmark contributors", "// SPDX-License-Identifier: BSD-3-Clause"]


def read_layers(path):
    """The floor of each room."""
    floors = {}
    for line in path.read_text().splitlines():
        words = line.split("#")[0].split()
        if words:
            floors[words[1]] = int(words[0])
    return floors


def sources(folder):
    return sorted(path for path in folder.rglob("*") if path.suffix in (".hpp", ".cpp", ".h", ".inl"))


def may_use(room, other, floors):
    return room == other or (other in floors and floors[other] < floors[room])


def check_include(room, public, header, floors):
    """The problem of one include, or None."""
    match = re.match(r"loopmark/(\w+)/", header)
    if match and not may_use(room, match.group(1), floors):
        other = match.group(1)
        where = f"floor {floors[other]}" if other in floors else "not in cmake/layers.txt"
        return f"{room} (floor {floors[room]}) includes {header} ({where})"
    if "../" in header:
        return f"includes {header}: private headers stay in their room"
    allowed = ALLOWED_IN_PUBLIC.get(room)
    if public and FOREIGN.match(header) and not (allowed and allowed.match(header)):
        return f"public header includes {header} of another library"
    if header.startswith("CLI/"):
        return f"a library includes {header}: the command line belongs to apps/"
    return None


def check_file_form(path, lines):
    if lines[:2] != SPDX:
        yield 1, "does not start with the two SPDX lines"
    if path.suffix == ".hpp" and "#pragma once" not in lines:
        yield 1, "has no #pragma once"


def check_room(room, folder, floors):
    if room not in floors:
        yield folder, 1, f"room {room} is not in cmake/layers.txt"
        return
    text = (folder / "CMakeLists.txt").read_text()
    deps = re.search(r"loopmark_room\(\s*\w+[^)]*?\bDEPS\s+([a-z_\s]+)", text)
    for other in deps.group(1).split() if deps else []:
        if not may_use(room, other, floors):
            yield folder / "CMakeLists.txt", 1, f"{room} depends on {other}, which is not on a lower floor"
    for path in sources(folder):
        public = "include" in path.relative_to(folder).parts
        for number, line in enumerate(path.read_text().splitlines(), 1):
            match = INCLUDE.match(line)
            problem = check_include(room, public, match.group(2), floors) if match else None
            if problem:
                yield path, number, problem
            if PRINTS.search(line.split("//")[0]):
                yield path, number, "a library prints; report through core/progress.hpp"


def check_guide(path, floors):
    """The guide's table names every room with its floor."""
    told = {}
    for number, line in enumerate(path.read_text().splitlines(), 1):
        match = re.match(r"\| (\d+) \| (\w+) \|", line)
        if match:
            told[match.group(2)] = int(match.group(1))
            if floors.get(match.group(2)) != int(match.group(1)):
                yield path, number, f"room {match.group(2)} stands otherwise in cmake/layers.txt"
    for room in floors:
        if room not in told:
            yield path, 1, f"room {room} is missing in the table"


def check_links(path):
    """Relative links lead to what is there."""
    for number, line in enumerate(path.read_text().splitlines(), 1):
        for target in re.findall(r"\]\(([^)\s#]+)", line):
            if not re.match(r"[a-z]+:", target) and not (path.parent / target).exists():
                yield path, number, f"links to {target}, which is not there"


def check_tree(root):
    """Yields (path, line number, problem)."""
    floors = read_layers(root / "cmake" / "layers.txt")
    if (root / "docs" / "architecture.md").exists():
        yield from check_guide(root / "docs" / "architecture.md", floors)
    for path in sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md")]):
        yield from check_links(path)
    for folder in sorted(p.parent for p in (root / "libs").glob("*/CMakeLists.txt")):
        yield from check_room(folder.name, folder, floors)
    for wing in ("apps", "libs", "tests", "benchmarks", "examples"):
        for path in sources(root / wing):
            for number, problem in check_file_form(path, path.read_text().splitlines()):
                yield path, number, problem


def main():
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    root = Path(sys.argv[1])
    findings = list(check_tree(root))
    for path, number, problem in findings:
        print(f"{path.relative_to(root)}:{number}: {problem}")
    print(f"structure: {len(findings)} problems")
    sys.exit(1 if findings else 0)


if __name__ == "__main__":
    main()
