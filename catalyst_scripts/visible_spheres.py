# SPDX-License-Identifier: BSD-3-Clause
"""Which spheres of one size can be seen in a picture, found before anything is drawn (for drawing is what costs)."""

import math

import numpy

FINEST = 6  # cells to a radius that are worth their time
SMALL = 2.5  # pixels: the radius of spheres that are worth knowing to half a pixel


def visible(up, across, depth, radius, height, width):
    """Numbers of the spheres that no others hide, and perhaps of a few more.

    up, across, depth [n]: their centres, from the bottom left corner of the picture and towards its viewer; these,
    the radius, and the picture's height and width are in pixels. The projection is parallel, and a pixel shows what
    is at its middle.

    A depth buffer of cells, which are pixels where spheres are not large. A sphere's centre is known to a cell, or
    to a quarter of one (a bin). So it is sure to cover what is `unsure` less than its radius away from
    the bin's middle, and sure not to reach what is `unsure` more away; how high it is there is bounded likewise.
    """
    inside = numpy.flatnonzero(
        (up > -radius) & (up < height + radius) & (across > -radius) & (across < width + radius)
    )
    if len(inside) == 0:
        return inside
    cell = max(1.0, radius / FINEST)
    bins = 2 if radius < SMALL else 1  # of a cell, along either side
    up, across, depth = (numpy.asarray(values, numpy.float32)[inside] / cell for values in (up, across, depth))
    radius /= cell
    unsure = math.sqrt(0.5) / bins + (0 if cell == 1 else math.sqrt(0.5))  # all of a large cell must be covered
    reach = math.ceil(radius + unsure)

    up -= math.floor(up.min()) - 2 * reach
    across -= math.floor(across.min()) - 2 * reach
    row, column = up.astype(numpy.int32), across.astype(numpy.int32)
    shape = (int(row.max()) + 2 * reach + 1, int(column.max()) + 2 * reach + 1)
    own_bin = (bins * (up - row)).astype(numpy.int32) * bins + (bins * (across - column)).astype(numpy.int32)
    place = (own_bin * shape[0] + row) * shape[1] + column

    middles = [((number + 0.5) / bins) - 0.5 for number in range(bins)]  # of bins, from their cell's
    offsets = [
        (which, rows, columns, math.hypot(rows - middles[which // bins], columns - middles[which % bins]))
        for which in range(bins**2)
        for rows in range(-reach, reach + 1)
        for columns in range(-reach, reach + 1)
    ]  # from a bin to cells around it, with the distance of their middles

    nearest = nearest_of_each(place, depth, bins**2 * math.prod(shape)).reshape(-1, *shape)
    covered = numpy.full(shape, -math.inf, numpy.float32)  # hides what is behind this depth
    inner = (slice(reach, shape[0] - reach), slice(reach, shape[1] - reach))
    for which, rows, columns, distance in offsets:
        if distance + unsure < radius:
            front = moved(nearest[which], -rows, -columns, reach) + height_of_sphere(radius, distance + unsure)
            numpy.maximum(covered[inner], front, out=covered[inner])
    hidden = numpy.full(nearest.shape, math.inf, numpy.float32)  # spheres of a bin with centres behind this depth
    for which, rows, columns, distance in offsets:
        if distance - unsure < radius:
            behind = moved(covered, rows, columns, reach) - height_of_sphere(radius, max(0.0, distance - unsure))
            numpy.minimum(hidden[which][inner], behind, out=hidden[which][inner])
    return inside[depth > hidden.ravel()[place]]


def nearest_of_each(place, depth, places):
    """The largest depth at each place, minus infinity where there is none."""
    nearest = numpy.full(places, -math.inf, numpy.float32)
    while len(place):  # of several spheres at one place any one is written, so that fewer remain
        nearest[place] = depth
        left = numpy.flatnonzero(depth > nearest[place])
        place, depth = place[left], depth[left]
    return nearest


def moved(grid, rows, columns, border):
    """The grid without its border, as seen from so many rows and columns further on."""
    return grid[border + rows : len(grid) - border + rows, border + columns : grid.shape[1] - border + columns]


def height_of_sphere(radius, distance):
    return numpy.float32(math.sqrt(radius**2 - distance**2))
