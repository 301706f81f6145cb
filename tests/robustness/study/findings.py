# SPDX-License-Identifier: BSD-3-Clause
"""What a study found, and the table that it ends with."""

import collections
import json
import pathlib
import re
import shutil
import threading


class Findings:
    """Counts outcomes and keeps what must not have happened: a folder for each finding below `folder`."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.outcomes = collections.Counter()
        self.found = []
        self.notes = collections.Counter()
        self.lock = threading.Lock()

    def add(self, case, outcome, problems, details, files=None):
        """Counts `outcome`, a tuple of words. With `problems`, copies the folder `files` and writes what there is to tell."""
        with self.lock:
            self.outcomes[outcome] += 1
            if (total := sum(self.outcomes.values())) % 100 == 0:
                print(f"{total} cases, {len(self.found)} findings", flush=True)
            if not problems:
                return
            self.found.append((case, problems))
            print(f"{case}: {'; '.join(problems)}"[:300], flush=True)
        place = self.folder / case
        if files:
            shutil.copytree(files, place, dirs_exist_ok=True, symlinks=True)
        place.mkdir(parents=True, exist_ok=True)
        (place / "finding.json").write_text(json.dumps({"problems": problems, **details}, indent=1, default=str) + "\n", encoding="utf-8")

    def of_each(self, pool, study_one, numbers):
        """Has the cases studied; Ctrl-C ends that early."""
        try:
            list(pool.map(study_one, numbers))
        except KeyboardInterrupt:
            pool.shutdown(cancel_futures=True)

    def note(self, message):
        """Counts what a run that failed said, whatever its numbers."""
        with self.lock:
            self.notes[re.sub(r"[-+]?\d[\d.e+-]*", "N", message.strip().split("\n")[-1])] += 1

    def report(self, heading):
        """Prints the table of outcomes and the findings; the exit status, 1 where there are any."""
        total = sum(self.outcomes.values())
        print(f"\n{heading}: {total} cases")
        for outcome, count in sorted(self.outcomes.items(), key=lambda item: (-item[1], item[0])):
            print(f"  {count:>7}  {', '.join(outcome)}")
        for message, count in self.notes.most_common():
            print(f"  {count:>7}  failed: {message}")
        kinds = collections.Counter(problem.split(":")[0] for _, problems in self.found for problem in problems)
        for kind, count in kinds.most_common():
            print(f"  {count:>7}  FOUND {kind}")
        print(f"{len(self.found)} findings" + (f" in {self.folder}" if self.found else ""))
        return 1 if self.found else 0
