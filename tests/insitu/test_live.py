# SPDX-License-Identifier: BSD-3-Clause
"""A run that is watched through Catalyst Live, and one that nobody watches."""

import socket
import subprocess
import sys
import unittest
import unittest.mock
from pathlib import Path

import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
from insitu_case import BUILT, ENVIRONMENT, SOURCE, VESSEL, DriverTest, main, read


def free_port():
    with socket.socket() as listener:
        listener.bind(("localhost", 0))
        return listener.getsockname()[1]


@unittest.skipUnless(BUILT, "built without ParaView")
class Live(DriverTest):
    def setUp(self):
        super().setUp()
        self.address = f"localhost:{free_port()}"
        live = unittest.mock.patch.dict(ENVIRONMENT, DRIVER_LIVE=self.address)
        live.start()
        self.addCleanup(live.stop)

    def test_a_client_receives_the_particles_and_may_leave(self):
        tools = SOURCE / "postprocessing"
        client = subprocess.Popen(
            [tools / "pvpython_headless", tools / "live_client.py", self.address, "--steps", "2", "--wait", "40"],
            env=ENVIRONMENT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)  # fmt: skip
        self.addCleanup(client.stdout.close)
        self.addCleanup(client.kill)
        listening = ""
        while "Accepting connection" not in listening:
            line = client.stdout.readline()
            self.assertTrue(line, listening)
            listening += line
        self.run_driver(VESSEL, ranks=2, frames=12)  # the client ends before the run does
        output = client.stdout.read()
        self.assertEqual(client.wait(timeout=50), 0, output)
        steps = [line for line in output.splitlines() if line.startswith("step")]
        self.assertEqual(len(steps), 2, output)
        self.assertRegex(steps[0], r"step \d+: 54800 points with damage, displacement")
        self.assertEqual(len(list(self.images.iterdir())), 12)

    def test_without_a_listener_nothing_is_different(self):
        self.run_driver(VESSEL)  # stderr is empty
        watched = read(self.images / "vessel_000050.png")
        with unittest.mock.patch.dict(ENVIRONMENT, DRIVER_LIVE=""):
            self.run_driver(VESSEL)
        self.assertTrue(numpy.array_equal(watched, read(self.images / "vessel_000050.png")))


if __name__ == "__main__":
    main()
