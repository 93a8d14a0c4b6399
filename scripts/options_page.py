#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes docs/reference/options.md from config/default.yaml, which `loopmark config dump` makes from the options' own
descriptions.

  scripts/options_page.py            writes the page
  scripts/options_page.py --check    exit code 1 when the page is not what would be written
"""
import re
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
HEAD = """# Options

Generated from `config/default.yaml` by `scripts/options_page.py`; a test holds both against the program. Any option may stand
in a file (`--config FILE.yaml`) or behind `--set SECTION.NAME=VALUE`. `loopmark config dump` prints all of them as YAML,
`loopmark config check FILE` finds wrong ones.
"""
OPTION = re.compile(r"^( *)(\w+): *(.*?)(?: +# (.*))?$")


def cell(text):
    return text.replace("|", "\\|")


def page(yaml):
    """A heading a section, a row an option."""
    lines = [HEAD.rstrip()]
    comment, path, table = "", [], None
    for line in yaml.splitlines():
        if line.strip().startswith("#"):
            comment = line.strip()[2:]
            continue
        match = OPTION.match(line)
        if not match:
            continue
        indent, name, value, meaning = len(match.group(1)) // 2, match.group(2), match.group(3), match.group(4)
        path = path[:indent] + [name]
        section = ".".join(path[:-1])
        if not value:
            lines += ["", "## " + ".".join(path)] + (["", comment[0].upper() + comment[1:] + "."] if comment else [])
            table, comment = None, ""
            continue
        if table != section:
            if table is not None:
                lines += ["", "## " + section + ", further"]
            lines += ["", "| option | default | meaning |", "|---|---|---|"]
            table = section
        lines.append(f"| `{name}` | `{cell(value)}` | {cell(meaning or '')} |")
    return "\n".join(lines) + "\n"


def main():
    target = ROOT / "docs" / "reference" / "options.md"
    text = page((ROOT / "config" / "default.yaml").read_text())
    if "--check" not in sys.argv:
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_text(text)
    elif not target.exists() or target.read_text() != text:
        sys.exit("docs/reference/options.md is not what config/default.yaml says: run scripts/options_page.py")


if __name__ == "__main__":
    main()
