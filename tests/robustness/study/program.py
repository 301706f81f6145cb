# SPDX-License-Identifier: BSD-3-Clause
"""The program under study, run with limits and without waiting for what it does not need."""

import dataclasses
import os
import pathlib
import re
import signal
import subprocess
import tempfile
import time

# A rank that is alone needs neither Open MPI's daemon nor its transports: a start takes 0.05 s of a processor.
ALONE = {"OMPI_MCA_ess_singleton_isolated": "1", "OMPI_MCA_btl": "self", "OMPI_MCA_pml": "ob1"}
RANKS_SHARE_CORES = {"OMPI_MCA_mpi_yield_when_idle": "1", "OMP_WAIT_POLICY": "passive"}


@dataclasses.dataclass
class Outcome:
    """How a run ended: the exit status, minus the signal's number after one; None where it had to be ended."""

    status: int | None
    output: str
    errors: str
    seconds: float
    output_is_text: bool = True

    def ended_well(self):
        return self.status in (0, 2, 3)


@dataclasses.dataclass
class Program:
    path: pathlib.Path
    mpirun: tuple
    memory_kib: int = 3 << 20  # of address space, for each rank
    processor_s: int = 60
    seconds: float = 900  # of waiting, on however busy a machine

    def limits(self):
        """A command that runs the one after it within the limits; beyond that of processor time it gets SIGXCPU, then SIGKILL."""
        script = f'ulimit -v {self.memory_kib}; ulimit -c 0; ulimit -S -t {self.processor_s}; ulimit -H -t {self.processor_s + 2}; exec "$@"'
        return ["sh", "-c", script, "limits"]

    def start(self, arguments, cwd, sessions, ranks=None, threads=1):
        """The process, its output in pipes, the leader of a process group. Open MPI keeps its files in `sessions`: ranks and
        launchers that start and end at once make and remove each other's folder elsewhere."""
        launcher = [*self.mpirun, "-n", str(ranks)] if ranks else self.limits()
        environment = {**os.environ, "OMP_NUM_THREADS": str(threads), "OMPI_MCA_orte_tmpdir_base": str(sessions),
                       **(RANKS_SHARE_CORES if ranks else ALONE)}
        return subprocess.Popen([*launcher, self.path, *arguments], cwd=cwd, env=environment, stdin=subprocess.DEVNULL,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE, process_group=0)

    def run(self, arguments, cwd, ranks=None, threads=1):
        begin = time.monotonic()
        with tempfile.TemporaryDirectory(prefix="rhexis_study_") as sessions:
            process = self.start(arguments, cwd, sessions, ranks, threads)
            status = None
            try:
                output, errors = process.communicate(timeout=self.seconds)
                status = process.returncode
            except subprocess.TimeoutExpired:
                kill_all(process)
                output, errors = process.communicate()
        return Outcome(status, output.decode("utf-8", "replace"), errors.decode("utf-8", "replace"), time.monotonic() - begin, is_text(output + errors))

    def keys(self):
        """Every key of the input with the words in quotes that its explanation holds, as TOML has them."""
        keys, section, name = {}, "", ""
        for line in self.run(["keys"], "/").output.splitlines():
            if match := re.match(r"\[+(\w+)\]+", line):
                section = match.group(1)
            elif match := re.match(r"  (\w+) +\S", line):
                name = f"{section}.{match.group(1)}"
                keys[name] = []
            if name and section:
                keys[name] += re.findall(r'"[\w ]+"', line)
        return keys


def is_text(data):
    """Whether `data` is UTF-8 without control characters, which would play with a terminal."""
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError:
        return False
    return not re.search(r"[\x00-\x08\x0b-\x1f\x7f]", text)


def descendants(pid):
    """Processes below `pid`, which launchers put into groups of their own."""
    found = []
    for task in pathlib.Path(f"/proc/{pid}/task").glob("*/children"):
        try:
            children = [int(child) for child in task.read_text().split()]
        except OSError:
            continue
        for child in children:
            found += [child, *descendants(child)]
    return found


def kill_all(process, number=signal.SIGKILL):
    """Sends the signal to the process and all below it."""
    for pid in (process.pid, *descendants(process.pid)):
        try:
            os.kill(pid, number)
        except ProcessLookupError:
            pass


def is_temporary(name):
    """Whether a file of this name should have gone, or got its own, by the end of a run."""
    return re.search(r"\.(part|spare|tmp)\b|\.[0-9a-f]{16}-\d+$", name) is not None


def snapshot(folder):
    """Every file below `folder` with its bytes, every link with its target, every folder."""
    found = {}
    for path in sorted(pathlib.Path(folder).rglob("*")):
        name = str(path.relative_to(folder))
        found[name] = os.readlink(path) if path.is_symlink() else path.read_bytes() if path.is_file() else None
    return found


def changes(before, after):
    """Names that came, went or changed, in words."""
    words = []
    for name in sorted(before.keys() | after.keys()):
        if name not in before:
            words.append(f"{name} was made")
        elif name not in after:
            words.append(f"{name} was removed")
        elif before[name] != after[name]:
            words.append(f"{name} was changed")
    return words
