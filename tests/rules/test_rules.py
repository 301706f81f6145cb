# SPDX-License-Identifier: BSD-3-Clause
"""Rules that machines keep: who may include whom, where MPI and OpenMP live, no dead links in the docs, a time limit for every test.

Run by ctest as: test_rules.py SOURCE_DIR BUILD_DIR CTEST
"""

import json
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(sys.argv[1])
BUILD = pathlib.Path(sys.argv[2])
CTEST = sys.argv[3]
SRC = ROOT / "src"

# Folder -> folders that it may include, besides itself and core.
MAY_INCLUDE = {
    "core": set(),
    "parallel": set(),
    "input": set(),
    "peridynamics": {"parallel"},
    "network": {"parallel"},
    "hemodynamics": {"network", "parallel"},
    "coupling": {"parallel", "network", "hemodynamics", "peridynamics", "output"},
    "studies": {"parallel", "network", "hemodynamics", "peridynamics", "output"},
    "output": {"parallel"},
    "insitu": {"parallel"},
    "runtime": {"parallel", "input", "output", "insitu"},
    "scenes": {"parallel", "input", "peridynamics", "network", "hemodynamics", "coupling", "studies", "output", "insitu", "runtime"},
    "app": {"parallel", "input", "peridynamics", "network", "hemodynamics", "coupling", "studies", "output", "insitu", "runtime", "scenes"},
}

# Folder -> its rooms -> rooms of the same folder that they may include, besides themselves and the files outside any room,
# which all may include and which may include all.
ROOMS = {
    "peridynamics": {
        "geometry": set(),
        "bonds": {"geometry"},
        "laws": {"geometry"},
        "loads": {"geometry"},
        "engine": {"bonds", "geometry", "laws", "loads"},
        "stability": {"bonds", "engine", "geometry", "laws"},
        "monitors": {"bonds", "engine", "geometry", "laws", "loads"},
        "statics": {"bonds", "engine", "geometry", "laws", "stability"},
        "simulation": {"engine", "loads", "monitors", "statics"},
    },
    "network": {
        "tree": set(),
        "files": {"lines", "repair", "survey"},
        "lines": {"files"},
        "repair": set(),
        "survey": set(),
    },
    "scenes": {
        "vessel": set(),
        "network": set(),
        "coupled": {"network", "vessel"},
        "ensemble": {"vessel"},
    },
}


def sources():
    return [p for p in SRC.rglob("*") if p.suffix in (".hpp", ".cpp", ".in")]


class Rules(unittest.TestCase):
    def test_includes_go_downwards(self):
        for path in sources():
            folder = path.relative_to(SRC).parts[0]
            if folder == "main.cpp":
                continue
            for included in re.findall(r'#include "([^"/]+)/[^"]*"', path.read_text()):
                allowed = MAY_INCLUDE[folder] | {folder, "core"}
                self.assertIn(included, allowed, f"{path} includes {included}/")

    def test_includes_between_rooms_go_downwards(self):
        for folder, rooms in ROOMS.items():
            self.assertEqual(set(rooms), {p.relative_to(SRC / folder).parts[0] for p in sources() if p.parent.parent == SRC / folder}, folder)
            for room, allowed in rooms.items():
                for path in (SRC / folder / room).rglob("*.[hc]pp"):
                    for included in re.findall(rf'#include "{folder}/([^"/]+)/[^"]*"', path.read_text()):
                        self.assertIn(included, allowed | {room}, f"{path} includes {folder}/{included}/")

    def test_include_table_is_documented(self):
        text = (SRC / "README.md").read_text()
        tables = [MAY_INCLUDE, *({f"{folder}/{room}": allowed for room, allowed in rooms.items()} for folder, rooms in ROOMS.items())]
        for table in tables:
            for folder, allowed in table.items():
                listed = ", ".join(f"`{name}`" for name in sorted(allowed)) or "-"
                self.assertIn(f"| `{folder}` | {listed} |", text)

    def test_mpi_is_called_in_parallel_only(self):
        """By the symbols that compiled files ask for, so that no include and no template hides a call."""
        commands = json.loads((BUILD / "compile_commands.json").read_text())
        compiled = [BUILD / re.search(r" -o (\S+)", command["command"]).group(1)
                    for command in commands if pathlib.Path(command["file"]).is_relative_to(SRC)]
        objects = [path for path in compiled if "rhexis_parallel" not in str(path)]
        self.assertGreater(len(objects), 100)
        symbols = subprocess.run(["nm", "--undefined-only", "--print-file-name", *objects], capture_output=True, text=True, check=True).stdout
        self.assertNotRegex(symbols, r"\.o:.* P?MPI_\w+\n")

    def test_openmp_stays_in_parallel(self):
        for path in sources():
            if path.relative_to(SRC).parts[0] != "parallel":
                self.assertNotRegex(path.read_text(), r"#include <omp\.h>|#pragma omp|\bomp_\w+\(", str(path))

    def test_every_paper_equation_has_its_functions(self):
        """The index of src/README.md names a function for every equation, and that is in the code of the file it names."""
        index = (SRC / "README.md").read_text()
        rows = [row for row in index.splitlines() if row.startswith("| Eq")]
        for number in range(1, 10):
            functions = [(name, SRC / link) for row in rows if f"({number})" in row.split("|")[1]
                         for names, link in re.findall(r"((?:`\w+`(?:, )?)+) in \[[^]]+\]\(([^)]+)\)", row) for name in re.findall(r"\w+", names)]
            self.assertTrue(functions, f"Eq. ({number}) has no function in the index of src/README.md")
            for name, home in functions:
                code = re.sub(r"//.*", "", home.read_text())
                self.assertRegex(code, rf"\b{name}\(", f"Eq. ({number})")

    def test_files_named_in_the_docs_exist(self):
        for doc in (ROOT / "README.md", ROOT / "CONTRIBUTING.md", SRC / "README.md", *(ROOT / "docs").glob("*.md")):
            for link in re.findall(r"\]\(([^)#:]+)\)", doc.read_text()):
                self.assertTrue((doc.parent / link).exists(), f"{doc}: {link}")

    def test_every_source_file_names_the_licence(self):
        files = [path for folder in ("src", "python", "tests", "cmake", "examples", "postprocessing", "catalyst_scripts", ".ci") for path in (ROOT / folder).rglob("*")]
        files += [ROOT / name for name in ("CMakeLists.txt", "quickstart", "Dockerfile", "Doxyfile")]
        for path in files:
            source = path.suffix in (".hpp", ".cpp", ".in", ".py", ".cmake", ".sh") or path.name in ("CMakeLists.txt", "quickstart", "Dockerfile", "Doxyfile")
            if path.is_file() and source and "__pycache__" not in path.parts:
                first = path.read_text().split("\n", 2)[:2]  # the second, where the first says what runs it
                self.assertTrue(any(line.endswith("SPDX-License-Identifier: BSD-3-Clause") for line in first), str(path))

    def test_the_citation_names_the_version(self):
        version = re.search(r"project\(rhexis VERSION (\S+)", (ROOT / "CMakeLists.txt").read_text()).group(1)
        self.assertIn(f"\nversion: {version}\n", (ROOT / "CITATION.cff").read_text())

    @unittest.skipUnless(shutil.which("doxygen"), "doxygen is not installed")
    def test_doxygen_understands_every_header(self):
        with tempfile.TemporaryDirectory() as folder:
            settings = (ROOT / "Doxyfile").read_text() + f"OUTPUT_DIRECTORY = {folder}\n"
            result = subprocess.run(["doxygen", "-"], input=settings, cwd=ROOT, capture_output=True, text=True, check=True)
        self.assertEqual(result.stderr, "")

    def test_every_test_has_a_time_limit(self):
        listed = subprocess.run([CTEST, "--show-only=json-v1"], cwd=BUILD, capture_output=True, check=True).stdout
        tests = json.loads(listed)["tests"]
        self.assertGreater(len(tests), 90)
        for test in tests:
            limits = [p["value"] for p in test["properties"] if p["name"] == "TIMEOUT"]
            self.assertTrue(limits and 0 < limits[0] <= 900, f"{test['name']}: add it by rhexis_add_test")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
