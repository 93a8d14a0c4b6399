# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Manual pages and completion from help text, by a program that stands in for loopmark."""
import gzip
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SCRIPT = Path(__file__).resolve().parents[2] / "scripts" / "make_manual.py"

PROGRAM = r"""#!/bin/sh
case "$*" in
  --version) echo "loopmark 1.2.3 (commit abc)" ;;
  --help) printf '%s\n' 'loopmark: maps' 'Usage: loopmark [OPTIONS] SUBCOMMAND' '' 'Options:' \
    '  -h,--help                   Print this help' '  --threads UINT              how many' '' 'Subcommands:' \
    '  map                         make a map' '  config                      options' ;;
  'map --help') printf '%s\n' 'make a map' 'Usage: loopmark map [OPTIONS] [LOG]' '' 'Positionals:' \
    '  LOG TEXT                    the log' '' 'Options:' '  -o,--output TEXT Excludes: --resume' \
    '                              folder of the run' '  --resume TEXT               go on' '' 'Examples:' \
    '  loopmark map drive -o run   so' ;;
  'config --help') printf '%s\n' 'options' 'Usage: loopmark config SUBCOMMAND' '' 'Subcommands:' \
    '  dump                        print them' ;;
esac
"""

COMPLETE = """source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _loopmark; echo "${COMPREPLY[@]}" """


class MakeManual(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)
        program = self.folder / "loopmark"
        program.write_text(PROGRAM)
        os.chmod(program, 0o755)
        subprocess.run([sys.executable, SCRIPT, program, self.folder / "out"], check=True)

    def page(self, name):
        return gzip.decompress((self.folder / "out/man1" / name).read_bytes()).decode().replace("\\-", "-")

    def complete(self, *words):
        script = self.folder / "out/completions/loopmark"
        done = subprocess.run(["bash", "-c", COMPLETE, "bash", script, *words], capture_output=True, text=True,
                              check=True, cwd=self.folder / "out/man1")
        return done.stdout.split()

    def test_a_page_has_name_options_and_examples(self):
        page = self.page("loopmark-map.1.gz")
        self.assertIn("loopmark-map - make a map", page)
        self.assertIn(".B -o,--output TEXT Excludes: --resume\nfolder of the run\n", page)
        self.assertIn("  loopmark map drive -o run   so", page)
        self.assertIn('"loopmark 1.2.3"', page)
        self.assertIn(".BR loopmark-config (1)", self.page("loopmark.1.gz"))

    def test_completion_knows_commands_and_their_options(self):
        self.assertEqual(self.complete("loopmark", "m"), ["map"])
        self.assertEqual(self.complete("loopmark", "map", "--re"), ["--resume"])
        self.assertEqual(self.complete("loopmark", "map", "--th"), ["--threads"])
        self.assertEqual(self.complete("loopmark", "config", "du"), ["dump"])
        self.assertEqual(self.complete("loopmark", "map", "-o", "loopmark.1"), ["loopmark.1.gz"])


if __name__ == "__main__":
    unittest.main()
