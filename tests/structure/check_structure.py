#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Holds the source tree against the layer table (cmake/layers.txt) and the rules beside it.

usage: check_structure.py SOURCE_DIR

- A room includes only itself and rooms of lower floors; its CMake DEPS likewise.
- Public headers include no foreign library but Eigen; mrpt_bridge may include MRPT in its own.
- Private headers are included from their own room only.
- A room's namespace is loopmark::<room> (core, the house's vocabulary: loopmark); private headers are in its ::internal.
- No type and no function is defined twice in one namespace.
- A room has at most 15 public headers.
- Libraries do not print: no std::cout, std::cerr or printf to them.
- The table in docs/architecture.md is that of cmake/layers.txt.
- Links between the Markdown files lead to files that are there.
- No paragraph of README.md or docs/ has over 120 words, README.md not over 700.
- Every C++ file starts with the two SPDX lines; every header with #pragma once.
Prints one line "FILE:LINE: PROBLEM" for each finding; exit code 1 when there is any.
"""

import re
import sys
from pathlib import Path

INCLUDE = re.compile(r'^\s*#\s*include\s+([<"])([^>"]+)[>"]')
FOREIGN = re.compile(r"^(pcl|mrpt|ceres|embree3|octomap|yaml-cpp|tbb|oneapi|open3d|nlohmann|hwy|CLI)/"
                     r"|^(nanoflann\.hpp|png\.h|zlib\.h|zstd\.h|httplib\.h|kiss_fft\w*\.h|rtcore\w*\.h)$")
ALLOWED_IN_PUBLIC = {"mrpt_bridge": re.compile(r"^mrpt/")}
PRINTS = re.compile(r"std::(cout|cerr)\b|\bstd::puts\(|\bstd::printf\(|fprintf\(stdout")
SPDX = ["// SPDX-FileCopyrightText: loopmark contributors", "// SPDX-License-Identifier: BSD-3-Clause"]


MOST_PUBLIC_HEADERS = 15
MOST_WORDS_OF_A_PARAGRAPH = 120
MOST_WORDS_OF_THE_README = 700
NAMESPACE = re.compile(r"^namespace (loopmark(?:::\w+)*) \{", re.M)
CODE = re.compile(r'//[^\n]*|/\*.*?\*/|R"\((?:.|\n)*?\)"|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)
TYPE = re.compile(r"\b(?:class|struct|union|enum class|enum struct|enum)\s+(\w+)(?:\s+final)?(?:\s*:[^;{}()]*)?\s*$")
FUNCTION = re.compile(r"(?:^|[\s&*>])([\w:~]+)\s*\((.*)\)\s*(?:const)?\s*(?:noexcept)?\s*$", re.S)


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
        text = path.read_text()
        for number, problem in check_namespaces(room, path, public, text):
            yield path, number, problem
        for number, line in enumerate(text.splitlines(), 1):
            match = INCLUDE.match(line)
            problem = check_include(room, public, match.group(2), floors) if match else None
            if problem:
                yield path, number, problem
            if PRINTS.search(line.split("//")[0]):
                yield path, number, "a library prints; report through core/progress.hpp"


def check_namespaces(room, path, public, text):
    """The namespaces that a file opens are those of its room."""
    own = "loopmark" if room == "core" else f"loopmark::{room}"
    opened = NAMESPACE.findall(text)
    for name in opened:
        if name != own and not name.startswith(own + "::"):
            yield 1, f"opens namespace {name}; the room's is {own}"
    members = re.search(r"^(?:struct|class) \w+::\w+ ", text, re.M)
    if path.suffix == ".hpp" and not public and not members:
        for name in opened:
            if "internal" not in name.split("::"):
                yield 1, f"a private header opens namespace {name}; private things are in {own}::internal"


def definitions(text):
    """(qualified name, line) of the types and functions that are defined in named namespaces below loopmark."""
    text = CODE.sub(lambda m: "\n" * m.group(0).count("\n") + '""', text)
    text = re.sub(r"^\s*#.*$", "", text, flags=re.M)
    scopes, head_start, line = [], 0, 1
    for at, char in enumerate(text):
        line += char == "\n"
        if char == "{":
            head = text[head_start:at].strip()
            spaces = [s for s in scopes if s is not None]
            found = None
            if all(s is not None for s in scopes) and "" not in spaces and spaces and spaces[0].startswith("loopmark"):
                found = defined(head)
            opened = re.match(r"(?:inline )?namespace\s*([\w:]*)$", head)
            scopes.append(opened.group(1) if opened else None)
            if found:
                yield "::".join(spaces) + "::" + found, line
            head_start = at + 1
        elif char == "}":
            if scopes:
                scopes.pop()
            head_start = at + 1
        elif char == ";":
            head_start = at + 1


def defined(head):
    """What a head before "{" defines at the level of a namespace: a type's name, a function's name with its parameters."""
    if head.startswith(("template", "namespace")) or "=" in head.split("(")[0]:
        return None
    match = TYPE.search(head)
    if match:
        return match.group(1)
    match = FUNCTION.search(head.split(") :")[0] + (")" if ") :" in head else ""))
    if match and not head.startswith(("if", "for", "while", "switch")):
        return match.group(1) + "(" + re.sub(r"\s+", " ", match.group(2)) + ")"
    return None


def check_defined_once(root):
    """No name is defined in two files of one namespace."""
    first = {}
    for wing in ("libs", "apps"):
        for path in sources(root / wing):
            for name, line in definitions(path.read_text()):
                if first.setdefault(name, path) != path:
                    yield path, line, f"defines {name}, which {first[name].relative_to(root)} defines too"


def check_sources(folder):
    """A source has a header of its name."""
    headers = {path.stem for path in folder.rglob("*.hpp")}
    for path in sorted(folder.rglob("*.cpp")):
        if path.stem not in headers:
            yield path, 1, "has no header of its name"


def check_public_headers(room, folder):
    """Public headers are few."""
    public = sorted((folder / "include").rglob("*.hpp")) if (folder / "include").exists() else []
    if len(public) > MOST_PUBLIC_HEADERS:
        yield folder / "CMakeLists.txt", 1, f"room {room} has {len(public)} public headers, more than {MOST_PUBLIC_HEADERS}"


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


def paragraphs(text):
    """(line, words) of each paragraph and list item; tables, headings and code are none."""
    number, words, code = 0, 0, False
    for i, line in enumerate(text.splitlines() + [""], 1):
        code = code != line.startswith("```")
        plain = line.strip() and not code and not line.startswith(("|", "#", "```"))
        if words and (not plain or re.match(r"\s*([-*]|\d+\.) ", line)):
            yield number, words
            words = 0
        if plain and not (words == 0 and line.startswith("    ") and not re.match(r"\s*([-*]|\d+\.) ", line)):
            number = number if words else i
            words += len(line.split())


def check_prose(root):
    """Pages for people are short, and so are their paragraphs."""
    for path in sorted([root / "README.md", *(root / "docs").rglob("*.md")]):
        if path.exists():
            for number, words in paragraphs(path.read_text()):
                if words > MOST_WORDS_OF_A_PARAGRAPH:
                    yield path, number, f"a paragraph of {words} words, more than {MOST_WORDS_OF_A_PARAGRAPH}"
    if (root / "README.md").exists():
        words = len((root / "README.md").read_text().split())
        if words > MOST_WORDS_OF_THE_README:
            yield root / "README.md", 1, f"has {words} words, more than {MOST_WORDS_OF_THE_README}"


def check_tree(root):
    """Yields (path, line number, problem)."""
    floors = read_layers(root / "cmake" / "layers.txt")
    if (root / "docs" / "architecture.md").exists():
        yield from check_guide(root / "docs" / "architecture.md", floors)
    for path in sorted([*root.glob("*.md"), *(root / "docs").rglob("*.md"), *(root / "maps").glob("*.md")]):
        yield from check_links(path)
    yield from check_prose(root)
    for folder in sorted(p.parent for p in (root / "libs").glob("*/CMakeLists.txt")):
        yield from check_room(folder.name, folder, floors)
        yield from check_public_headers(folder.name, folder)
    yield from check_defined_once(root)
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
