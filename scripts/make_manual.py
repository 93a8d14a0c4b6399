#!/usr/bin/env python3
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""make_manual.py LOOPMARK OUT: manual pages and bash completion from what the program itself says of its commands.

Writes OUT/man1/loopmark.1.gz, OUT/man1/loopmark-<command>.1.gz for each command, OUT/completions/loopmark, and the
changelog packed as packages have it, OUT/changelog.gz. The same program gives the same bytes.
"""
import gzip
import re
import subprocess
import sys
from pathlib import Path

ENTRY = re.compile(r"^  (\S.*?)(?:  +(\S.*))?$")
HEADING = re.compile(r"^(Positionals|Options|Subcommands):$")


def help_of(program, words):
    done = subprocess.run([program, *words, "--help"], capture_output=True, text=True, check=True)
    return done.stdout


class Help:
    """The parts of one --help: what it is, how it is used, entries by heading, and the text behind."""

    def __init__(self, text):
        lines = text.splitlines()
        self.summary = lines[0].split(": ", 1)[-1]
        self.usage = ""
        self.entries = {"Positionals": [], "Options": [], "Subcommands": []}
        self.footer = []
        heading = None
        for line in lines[1:]:
            match = HEADING.match(line)
            if line.startswith("Usage: "):
                self.usage = line[len("Usage: "):]
            elif match:
                heading = match.group(1)
            elif heading and line.startswith("    "):
                self.add_meaning(heading, line.strip())
            elif heading and ENTRY.match(line):
                self.entries[heading].append(list(ENTRY.match(line).groups(default="")))
            elif not line and not self.footer:
                heading = None
            else:
                self.footer.append(line)
                heading = None

    def add_meaning(self, heading, text):
        last = self.entries[heading][-1]
        last[1] = (last[1] + " " + text).strip()

    def commands(self):
        return [name.split()[0] for name, _ in self.entries["Subcommands"]]

    def options(self):
        """(name, takes a value) of each spelling of each option."""
        found = []
        for name, _ in self.entries["Options"]:
            spellings = re.match(r"\S+", name).group(0).split(",")
            has_value = len(name.split()) > 1
            found += [(spelling, has_value) for spelling in spellings]
        return found


def roff(text):
    text = text.replace("\\", "\\e").replace("-", "\\-")
    return "\\&" + text if text.startswith((".", "'")) else text


def manual_page(name, one, version, see_also):
    lines = [f'.TH {name.upper().replace("-", chr(92) + "-")} 1 "" "loopmark {version}" "User Commands"',
             ".SH NAME", f"{roff(name)} \\- {roff(one.summary)}", ".SH SYNOPSIS", roff(one.usage)]
    titles = {"Positionals": "ARGUMENTS", "Options": "OPTIONS", "Subcommands": "COMMANDS"}
    for heading, title in titles.items():
        if one.entries[heading]:
            lines.append(".SH " + title)
        for entry, meaning in one.entries[heading]:
            lines += [".TP", ".B " + roff(entry), roff(meaning)]
    if any(line.strip() for line in one.footer):
        lines += [".SH EXAMPLES AND NOTES", ".nf"] + [roff(line) for line in one.footer if line != "Examples:"] + [".fi"]
    lines += [".SH SEE ALSO", ",\n".join(f".BR {roff(other)} (1)" for other in see_also).replace(",\n", "\n")]
    return "\n".join(lines) + "\n"


COMPLETION = """# bash completion for loopmark; generated from its own help
_loopmark() {
  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]} command="" word
  for word in "${COMP_WORDS[@]:1:COMP_CWORD-1}"; do
    case "$word" in
      %(commands_pattern)s) command=$word; break ;;
    esac
  done
  case "$previous" in
    %(valued_pattern)s) COMPREPLY=($(compgen -f -- "$current")); return ;;
  esac
  local words
  case "$command" in
%(cases)s
    *) words="%(top)s" ;;
  esac
  if [[ "$current" == -* || -z "$command" ]]; then
    COMPREPLY=($(compgen -W "$words" -- "$current"))
  else
    COMPREPLY=($(compgen -W "$words" -- "$current") $(compgen -f -- "$current"))
  fi
}
complete -o filenames -F _loopmark loopmark
"""


def completion(top, helps):
    everywhere = [name for name, _ in top.options()]
    valued = sorted({name for one in [top, *helps.values()] for name, has_value in one.options() if has_value})
    cases = []
    for command, one in helps.items():
        words = one.commands() + [name for name, _ in one.options()] + everywhere
        cases.append(f'    {command}) words="{" ".join(dict.fromkeys(words))}" ;;')
    return COMPLETION % {"commands_pattern": " | ".join(helps), "valued_pattern": " | ".join(valued),
                         "cases": "\n".join(cases), "top": " ".join([*helps, *everywhere])}


def write_gz(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(gzip.compress(text.encode(), compresslevel=9, mtime=0))


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    program, out = sys.argv[1], Path(sys.argv[2])
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.split()[1]
    top = Help(help_of(program, []))
    helps = {command: Help(help_of(program, [command])) for command in top.commands()}
    pages = ["loopmark-" + command for command in helps]
    write_gz(out / "man1" / "loopmark.1.gz", manual_page("loopmark", top, version, pages))
    for command, one in helps.items():
        write_gz(out / "man1" / f"loopmark-{command}.1.gz",
                 manual_page("loopmark-" + command, one, version, ["loopmark"]))
    write_gz(out / "changelog.gz", (Path(__file__).resolve().parent.parent / "CHANGELOG.md").read_text())
    (out / "completions").mkdir(parents=True, exist_ok=True)
    (out / "completions" / "loopmark").write_text(completion(top, helps))


if __name__ == "__main__":
    main()
