# SPDX-License-Identifier: BSD-3-Clause
"""Pictures, movies and curves of saved files."""

import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import h5py
import numpy

sys.path.insert(0, str(Path(__file__).resolve().parent))
import synthetic_run
from insitu_case import BUILT, DRIVER, ENVIRONMENT, NETWORK, SOURCE, DriverTest, complaints, main, read


@unittest.skipUnless(BUILT, "built without ParaView")
class Afterwards(DriverTest):
    def test_a_saved_network_gives_the_picture_of_the_run(self):
        scripts = SOURCE / "postprocessing"
        subprocess.run([Path(DRIVER).with_name("write_network"), self.folder, "network:spatial"], check=True)
        self.run_driver(NETWORK, channels="network:spatial")
        during = read(self.images / "network_000050.png")
        result = subprocess.run(
            [scripts / "pvpython_headless", scripts / "render_network.py", self.folder / "network.xdmf", "-o",
             self.folder / "after"], env=ENVIRONMENT, capture_output=True, text=True, timeout=50)
        self.assertEqual((result.returncode, complaints(result.stderr)), (0, ""), result.stdout)
        after = read(self.folder / "after" / "network_000050.png")
        self.assertLess((numpy.abs(after - during).max(axis=-1) > 8).mean(), 1e-3)

    def test_the_colour_bar_of_a_long_vessel_says_more(self):
        synthetic_run.write(self.folder, frames=1, length_m=30e-3)
        with h5py.File(self.folder / "particles.h5", "a") as file:
            file["damage/000000"][0] = 1  # beyond the bar
        scripts = SOURCE / "postprocessing"
        subprocess.run([scripts / "pvpython_headless", scripts / "render_particles.py", self.folder / "particles.xdmf"],
                       env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL, timeout=50)
        picture = read(self.folder / "images" / "vessel_000000.png")
        ink = (picture[704:720, 762:818] < 100).all(axis=-1)  # below the right end of the lower bar
        self.assertGreater(ink.sum(), 40)
        self.assertLess(ink.mean(), 0.5)

    def test_saved_particles_give_pictures_a_movie_and_curves(self):
        scripts = SOURCE / "postprocessing"
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            synthetic_run.write(folder, frames=2)
            for command in (
                [scripts / "pvpython_headless", scripts / "render_particles.py", folder / "particles.xdmf"],
                [scripts / "make_movie.sh", folder / "images"],
                [sys.executable, scripts / "plot_history.py", folder / "history.csv"],
            ):
                result = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=50)
                self.assertEqual((result.returncode, complaints(result.stderr)), (0, ""), result.stdout)
            self.assertEqual(read(folder / "images" / "vessel_000050.png").shape, (720, 1280, 3))
            self.assertEqual(read(folder / "history.png").shape[1], 1080)
            self.assertGreater((folder / "movie.mp4").stat().st_size, 10_000)
            # In the order of steps, which from the millionth on is not that of names.
            intact, torn = (folder / "images" / f"vessel_{step}.png" for step in ("000000", "000050"))
            intact.rename(folder / "images/vessel_999999.png")
            torn.rename(folder / "images/vessel_1000000.png")
            for tool in ([scripts / "make_movie.sh", folder / "images"],
                         ["ffmpeg", "-loglevel", "error", "-i", folder / "movie.mp4", "-frames:v", "1", folder / "first.png"]):
                subprocess.run(tool, env=ENVIRONMENT, check=True, stdout=subprocess.DEVNULL, stdin=subprocess.DEVNULL)
            first, intact, torn = (read(folder / name) for name in ("first.png", "images/vessel_999999.png", "images/vessel_1000000.png"))
            self.assertLess(numpy.abs(first - intact).mean(), 0.3 * numpy.abs(first - torn).mean())
            render = [scripts / "pvpython_headless", scripts / "render_network.py"]
            for file, message in (("particles.xdmf", "holds no flow and no kind and no pressure and no radius"),
                                  ("history.csv", "is not the network.xdmf of a run")):
                result = subprocess.run([*render, folder / file], env=ENVIRONMENT, capture_output=True, text=True, timeout=50)
                self.assertEqual(result.returncode, 1, result.stderr)
                self.assertIn(message, result.stderr)
                self.assertNotIn("Traceback", result.stderr)
            # A run that was only begun has nothing to draw.
            (folder / "history.csv").write_text((folder / "history.csv").read_text().splitlines()[0] + "\n")
            result = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=50)
            self.assertEqual(result.returncode, 1)
            self.assertIn("history.csv is not the history.csv of a run (no rows)", result.stderr)


if __name__ == "__main__":
    main()
