# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The structure check finds what it is there to find."""

import tempfile
import unittest
from pathlib import Path

import check_structure

HEAD = "\n".join(check_structure.SPDX) + "\n"


class CheckStructureTest(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.root = Path(self.folder.name)
        self.write("cmake/layers.txt", "# table\n1 core\n2 cloud\n2 search\n3 mrpt_bridge\n")
        for room in ("core", "cloud", "search", "mrpt_bridge"):
            self.write(f"libs/{room}/CMakeLists.txt", f"loopmark_room({room} DEPS core PRIVATE TBB::tbb)\n"
                       if room != "core" else "loopmark_room(core)\n")

    def write(self, path, text):
        file = self.root / path
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(text)

    def source(self, path, text):
        self.write(path, HEAD + ("#pragma once\n" if path.endswith(".hpp") else "") + text)

    def problems(self):
        return [f"{p.relative_to(self.root)}:{n}: {what}" for p, n, what in check_structure.check_tree(self.root)]

    def test_a_sound_tree_has_no_problem(self):
        self.source("libs/cloud/include/loopmark/cloud/a.hpp", '#include <vector>\n#include "loopmark/core/b.hpp"\n')
        self.source("libs/cloud/src/a.cpp", '#include <tbb/parallel_for.h>\n#include "loopmark/cloud/a.hpp"\n')
        self.source("libs/mrpt_bridge/include/loopmark/mrpt_bridge/a.hpp", "#include <mrpt/poses/CPose3D.h>\n")
        self.assertEqual(self.problems(), [])

    def test_includes_go_down_only(self):
        self.source("libs/core/src/a.cpp", '#include "loopmark/cloud/a.hpp"\n')
        self.source("libs/cloud/src/a.cpp", '#include "loopmark/search/a.hpp"\n')
        self.source("libs/search/src/a.cpp", '#include "loopmark/attic/a.hpp"\n')
        self.assertEqual(len(self.problems()), 3)
        self.assertIn("libs/core/src/a.cpp:3: core (floor 1) includes loopmark/cloud/a.hpp (floor 2)", self.problems())

    def test_foreign_headers_stay_private(self):
        self.source("libs/cloud/include/loopmark/cloud/a.hpp", "#include <pcl/point_types.h>\n")
        self.source("libs/search/include/loopmark/search/a.hpp", "#include <nanoflann.hpp>\n")
        self.source("libs/search/include/loopmark/search/b.hpp", "#include <mrpt/poses/CPose3D.h>\n")
        self.source("libs/search/src/b.cpp", '#include "../../cloud/src/private.hpp"\n')
        self.assertEqual(len(self.problems()), 4)

    def test_dependencies_go_down_only(self):
        self.write("libs/core/CMakeLists.txt", "loopmark_room(core\n  DEPS cloud\n  PRIVATE x)\n")
        self.write("libs/attic/CMakeLists.txt", "loopmark_room(attic)\n")
        self.assertEqual(len(self.problems()), 2)

    def test_libraries_do_not_print(self):
        self.source("libs/core/src/a.cpp", 'std::cout << "hello";\n')
        self.source("apps/loopmark/a.cpp", 'std::printf("hello");\n')
        self.assertEqual(len(self.problems()), 1)

    def test_the_guide_tells_the_same_table(self):
        self.write("docs/architecture.md", "| 1 | core | poses |\n| 3 | cloud | points |\n| 2 | search | trees |\n")
        self.assertEqual(self.problems(), [
            "docs/architecture.md:2: room cloud stands otherwise in cmake/layers.txt",
            "docs/architecture.md:1: room mrpt_bridge is missing in the table"])

    def test_links_lead_somewhere(self):
        self.write("README.md", "[a](docs/a.md) [b](docs/b.md#part)\n[c](https://example.org/x) [d](#here)\n")
        self.write("docs/a.md", "[up](../README.md)\n")
        self.assertEqual(self.problems(), ["README.md:1: links to docs/b.md, which is not there"])

    def test_pages_are_short(self):
        self.write("README.md", "word " * 701 + "\n")
        self.write("docs/a.md", "word\n" * 121 + "\n- " + "word " * 119 + "\n- " + "word " * 119 + "\n\n| " + "word " * 200
                   + "|\n\n```\n" + "word " * 200 + "\n```\n")
        self.assertEqual(self.problems(), [
            "README.md:1: a paragraph of 701 words, more than 120",
            "docs/a.md:1: a paragraph of 121 words, more than 120",
            "README.md:1: has 701 words, more than 700"])

    def test_form_of_files(self):
        self.write("tests/core/a_test.cpp", "int main() {}\n")
        self.write("apps/loopmark/a.hpp", HEAD)
        self.assertEqual(len(self.problems()), 2)


if __name__ == "__main__":
    unittest.main()
