# SPDX-License-Identifier: BSD-3-Clause
"""Mutated files of networks in every format: whatever is in them, they are read and solved, or refused with one message."""

import dataclasses
import os
import pathlib
import random
import re
import shutil
import subprocess
import tempfile

from study import mutations, scenes
from study.inputs import LONGEST_MESSAGE
from study.program import ALONE, is_text

BATCH = 200  # files for each start of the driver
SECONDS_OF_BATCH = 120  # of a processor

SWC = """\
# a fork with a soma
1 1 0 0 0 20 -1
2 3 100 0 0 15 1
3 3 200 20 0 10.5 2
4 3 300 60 0 8 3
5 3 180 -40 0 9 2
"""
VTK = """\
# vtk DataFile Version 3.0
a fork
ASCII
DATASET POLYDATA
POINTS 4 float
0 0 0 1 0 0 2 0.5 0 2 -0.5 0
LINES 2 7
3 0 1 2
2 1 3
POINT_DATA 4
SCALARS radius double 1
LOOKUP_TABLE default
0.3 0.28 0.2 0.22
FIELD FieldData 1
pressure_condition 1 4 double
8000 5000 2000 2500
"""
SECOMB = """\
a fork
100 100 50  box
10 10 5
30.
25.
10
3  total number of segments
name type from to diam flow Hd
1 5 1 2 8.0 0.0 0.4
2 5 2 3 7.0 0.0 0.4 *
3 4 2 4 6.5 0.0 0.4
4  total number of nodes
name x y z
1 0. 0. 0.
2 50. 0. 0.
3 90. 20. 0.
4 90. -20. 0.
3  total number of boundary nodes
node bctyp press/flow Hd PO2
1 0 40. 0.45 90.
3 0 20. 0.45 40.
4 2 -0.5 0.45 40.
"""
GRAPHML = """\
<?xml version="1.0" encoding="UTF-8"?>
<graphml xmlns="http://graphml.graphdrawing.org/xmlns">
<key id="x" for="node" attr.name="x" attr.type="double"/>
<key id="y" for="node" attr.name="y" attr.type="double"/>
<key id="z" for="node" attr.name="z" attr.type="double"/>
<key id="p" for="node" attr.name="pressure [mmHg]" attr.type="double"/>
<key id="r" for="edge" attr.name="radius" attr.type="double"/>
<graph edgedefault="undirected">
<node id="a"><data key="x">0</data><data key="y">0</data><data key="z">0</data><data key="p">60</data></node>
<node id="b"><data key="x">1</data><data key="y">0</data><data key="z">0</data></node>
<node id="c"><data key="x">2</data><data key="y">1</data><data key="z">0</data><data key="p">20</data></node>
<edge source="a" target="b"><data key="r">0.1</data></edge>
<edge source="b" target="c"><data key="r">0.08</data></edge>
</graph></graphml>
"""


def formats():
    """By format: the files of a valid network, as texts."""
    return {
        "csv": {"j.csv": scenes.CSV_JUNCTIONS, "v.csv": scenes.CSV_VESSELS},
        "json": {"n.json": scenes.JSON_NETWORK},
        "vtp": {"n.vtp": scenes.vtp_network()},
        "vtk": {"n.vtk": VTK},
        "swc": {"n.swc": SWC},
        "dat": {"n.dat": SECOMB},
        "graphml": {"n.graphml": GRAPHML},
    }


def make_case(seed, number, format_name, files, folder):
    """Writes the files of a case below `folder`; their paths, with tabs between them, and which mutations made them."""
    source = random.Random(f"{seed}:{format_name}:{number}")
    mutated = source.choice(sorted(files))
    paths, told = [], []
    for name, text in files.items():
        data = text.encode()
        if name == mutated and number > 0:  # the first case is the valid network
            data, told = mutations.mutate_file(source, name, text, {})
        paths.append(folder / f"{number:06d}.{name}")
        paths[-1].write_bytes(data)
    return "\t".join(map(str, paths)), told


def run_driver(driver, lines):
    """What the driver tells of each line, up to that which ended it, and how it ended."""
    with tempfile.TemporaryDirectory(prefix="rhexis_study_") as sessions:
        environment = {**os.environ, **ALONE, "OMP_NUM_THREADS": "1", "OMPI_MCA_orte_tmpdir_base": sessions}
        done = subprocess.run([*driver.limits(), driver.path], input="".join(f"{line}\n" for line in lines).encode(),
                              capture_output=True, check=False, env=environment)
    return done.stdout.split(b"\n")[:-1], done


def judge(line, number):
    """How a network ended, and what is wrong with that."""
    word, _, told = line.decode("utf-8", "replace").partition("\t")
    problems = [] if is_text(line) else ["wrote bytes that are no text"]
    if len(line) > LONGEST_MESSAGE:
        problems.append(f"wrote {len(line)} characters")
    if word == "refused" and not re.search(r"\d{6}\.[jvn]\.\w+", told):
        problems.append(f"names no file: {told}")
    if word == "not finite":
        problems.append(f"solved with a flow that is no number: {told}")
    if number == 0 and word != "read":
        problems.append(f"the valid network is {word}: {told}")
    return word, problems


def study(program, findings, seed, first, count, pool):
    driver = dataclasses.replace(program, path=program.path.parent / "read_networks", processor_s=SECONDS_OF_BATCH)

    def batch(task):
        format_name, files, begin, end = task
        folder = pathlib.Path(tempfile.mkdtemp(prefix="rhexis_study_"))
        try:
            cases = [(number, *make_case(seed, number, format_name, files, folder)) for number in range(begin, end)]
            while cases:
                told, done = run_driver(driver, [line for _, line, _ in cases])
                for (number, line, mutated), answer in zip(cases, told):
                    report(format_name, number, line, mutated, *judge(answer, number))
                if len(told) < len(cases):
                    report(format_name, *cases[len(told)], "ended", [f"ended the reader with {done.returncode}: "
                                                                      f"{done.stderr.decode('utf-8', 'replace')[-2000:]}"])
                cases = cases[len(told) + 1:]
        finally:
            shutil.rmtree(folder, ignore_errors=True)

    def report(format_name, number, line, mutated, word, problems):
        files = None
        if problems:
            files = pathlib.Path(tempfile.mkdtemp(prefix="rhexis_study_"))
            for path in line.split("\t"):
                shutil.copy(path, files)
        findings.add(f"case_{format_name}_{number:06d}", (format_name, word), problems, {"mutations": mutated}, files)
        if files:
            shutil.rmtree(files)

    tasks = [(name, files, begin, min(begin + BATCH, first + count))
             for name, files in formats().items() for begin in range(first, first + count, BATCH)]
    findings.of_each(pool, batch, tasks)
    return findings.report("Mutated networks")
