# SPDX-License-Identifier: BSD-3-Clause
"""What is left out of a picture cannot be seen, and not much else is drawn. Usage: test_visible_spheres.py SCRIPTS"""

import sys
import unittest

import numpy

sys.path.insert(0, sys.argv.pop(1))
from visible_spheres import visible

HEIGHT, WIDTH = 40, 60


def seen(up, across, depth, radius):
    """Numbers of the spheres that some pixel shows, pixel by pixel."""
    numbers = set()
    for row in range(HEIGHT):
        for column in range(WIDTH):
            squared = radius**2 - (row + 0.5 - up) ** 2 - (column + 0.5 - across) ** 2
            front = numpy.where(squared > 0, depth + numpy.sqrt(numpy.maximum(squared, 0)), -numpy.inf)
            if front.max() > -numpy.inf:
                numbers.add(int(front.argmax()))
    return numbers


class VisibleSpheres(unittest.TestCase):
    def test_every_sphere_that_a_pixel_shows_is_found(self):
        random = numpy.random.default_rng(1)
        for radius in (0.6, 1.25, 2.4, 3.1, 5, 7, 13, 30):
            count = int(3000 / max(1, radius))
            up, across, depth = random.uniform((-5, -5, 0), (HEIGHT + 5, WIDTH + 5, 20), (count, 3)).T
            with self.subTest(radius=radius):
                found = set(visible(up, across, depth, radius, HEIGHT, WIDTH))
                self.assertEqual(seen(up, across, depth, radius) - found, set())
                self.assertLess(len(found), count)

    def test_a_wall_hides_what_is_behind_it(self):
        for radius in (1.25, 3.1, 13):
            grid = numpy.arange(-radius, WIDTH + radius, 0.5 * radius)  # over each other: no gaps
            wall = numpy.array([part.ravel() for part in numpy.meshgrid(grid, grid)])
            behind = numpy.random.default_rng(2).uniform((10, 10), (HEIGHT - 10, WIDTH - 10), (100, 2)).T
            up, across = numpy.concatenate([wall, behind], axis=1)
            depth = numpy.where(numpy.arange(len(up)) < len(wall[0]), 3 * radius, 0)
            with self.subTest(radius=radius):
                self.assertLess(visible(up, across, depth, radius, HEIGHT, WIDTH).max(), len(wall[0]))

    def test_nothing_outside_the_picture_is_found(self):
        up, across, depth = numpy.array([[20, 20, 20, -9, 49], [30, -9, 69, 30, 30], [0, 1, 2, 3, 4.0]])
        self.assertEqual(list(visible(up, across, depth, 3.0, HEIGHT, WIDTH)), [0])
        self.assertEqual(len(visible(up[1:], across[1:], depth[1:], 3.0, HEIGHT, WIDTH)), 0)


if __name__ == "__main__":
    unittest.main()
