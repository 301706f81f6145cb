# SPDX-License-Identifier: BSD-3-Clause
"""Resources against size, Eq. (10) of the paper, and how long a run takes on other cores: formulas, no runs, no files."""

import dataclasses
import math

import numpy

BLOCK_ROWS = 16  # rows are dealt out in whole blocks, src/parallel/partition.hpp
# What a cut costs, src/parallel/partition.cpp: packing and unpacking, and bonds that are evaluated for either end. Of the
# bonds of the columns within a horizon of a cut, n pi delta^4/4 of n 4 pi delta^4/3 cross it.
BONDS_PER_HALO_PARTICLE, SHARE_ACROSS, BLOCKS_BEYOND_END = 10, 3 / 16, 0.7
GAMMA_RANGE = (0.05, 4.0)
SAME = 0.02  # resources that differ by less do not grow
LEAST_SIZES = 4  # one more than Eq. (10) has unknowns


@dataclasses.dataclass
class PowerLaw:
    """R(p) = alpha + beta p^gamma, Eq. (10). gamma is None where R does not grow (beta = 0)."""

    alpha: float
    beta: float
    gamma: float | None
    deviation: float  # root mean square of the relative residuals
    at_bound: bool = False  # gamma is the end of GAMMA_RANGE: the points do not determine it

    def __call__(self, p):
        p = numpy.asarray(p, dtype=float)
        return numpy.full_like(p, self.alpha) if self.gamma is None else self.alpha + self.beta * p**self.gamma


def fit_power_law(p, resource):
    """The PowerLaw with the least relative residuals and alpha, beta >= 0; None for fewer than LEAST_SIZES sizes."""
    p, resource = numpy.asarray(p, dtype=float), numpy.asarray(resource, dtype=float)
    if len(numpy.unique(p)) < LEAST_SIZES or resource.min() <= 0:
        return None
    constant = 1 / resource
    scale = p.max()  # powers of p / scale are at most 1

    def with_gamma(gamma):
        """(residual, alpha, beta of p / scale): linear least squares, on the edge where a coefficient would be negative."""
        power = (p / scale) ** gamma / resource
        both = numpy.linalg.lstsq(numpy.stack([constant, power], axis=1), numpy.ones_like(p), rcond=None)[0]
        choices = [both]
        if both.min() < 0:
            choices = [(constant.sum() / (constant @ constant), 0.0), (0.0, power.sum() / (power @ power))]
        return min((float(numpy.linalg.norm(a * constant + b * power - 1)), float(a), float(b)) for a, b in choices)

    low, high = GAMMA_RANGE
    for _ in range(6):  # each time to the neighbours of the best of a grid
        grid = numpy.linspace(low, high, 41)
        best = min(range(len(grid)), key=lambda i: with_gamma(grid[i])[0])
        gamma, low, high = grid[best], grid[max(best - 1, 0)], grid[min(best + 1, len(grid) - 1)]
    residual, alpha, beta = with_gamma(gamma)
    deviation = residual / math.sqrt(len(p))
    if beta == 0 or resource.max() / resource.min() < 1 + SAME:
        return PowerLaw(float(resource.mean()), 0.0, None, float(resource.std() / resource.mean()))
    return PowerLaw(alpha, beta / scale**gamma, float(gamma), deviation, bool(gamma in GAMMA_RANGE))


@dataclasses.dataclass
class Network:
    """An ideal tree: every core gets its share of the vessels, and ranks exchange one number a branch."""

    vessels: int

    def grown(self, factor):
        return Network(self.vessels * factor)

    def busiest(self, ranks):
        return Share(self.vessels / ranks, 0, 0, 0)


@dataclasses.dataclass
class Wall:
    """A wall of columns x rows particles, and what its halo follows from."""

    columns: int
    rows: int
    family: float  # bonds of a particle
    reach: int  # rows within a horizon
    cut_columns: float  # columns within a horizon of one side of a radial cut
    bytes: int  # of one displacement

    def grown(self, factor):
        """The same wall, so many times as long."""
        return dataclasses.replace(self, rows=round(self.rows * factor))

    def busiest(self, ranks):
        """The share of the busiest rank, where columns x blocks are dealt out as src/parallel/partition.cpp does: the
        split with the least work. None where there are more ranks than pieces."""
        blocks = -(-self.rows // BLOCK_ROWS)
        shares = [self._share(parts, ranks // parts, blocks) for parts in range(1, min(ranks, self.columns) + 1)
                  if ranks % parts == 0 and ranks // parts <= blocks]
        return min(shares, key=lambda share: share.particles + share.cuts, default=None)

    def _share(self, column_parts, block_parts, blocks):
        columns, rows = -(-self.columns // column_parts), -(-blocks // block_parts) * BLOCK_ROWS
        beside, above = min(2, column_parts - 1), min(2, block_parts - 1)  # neighbours of a rank in the middle
        halo_columns = min(2 * self.cut_columns, self.columns - columns) if beside else 0
        halo = (columns + halo_columns) * (rows + above * self.reach) - columns * rows
        twice = SHARE_ACROSS * halo_columns * rows + BLOCKS_BEYOND_END * above * BLOCK_ROWS * columns
        return Share(columns * rows, twice + halo * BONDS_PER_HALO_PARTICLE / self.family, halo * self.bytes,
                     (1 + beside) * (1 + above) - 1)


@dataclasses.dataclass
class Share:
    """What a rank has to do in a step: particles (of whole blocks) or vessels, what cuts cost it in units of particles,
    and what it receives."""

    particles: float
    cuts: float
    bytes: float
    messages: int


@dataclasses.dataclass
class Machine:
    latency_s: float
    bandwidth_B_s: float  # of a node, shared by its ranks
    cores_per_node: int
    source: str = "as stated"  # of latency and bandwidth


def nodes_of(ranks, threads, cores_per_node):
    return math.ceil(ranks / max(1, cores_per_node // threads))


def core_rate(problem, row):
    """Particles (or vessels) that a core does in a second, from a measured run."""
    share = problem.busiest(row["ranks"])
    return (share.particles + share.cuts) * row["steps"] / (row["solve_s"] * row["threads"])


def solve_seconds(problem, ranks, threads, steps, rate, machine):
    """Time of solving: compute at `rate` per core, then the exchange of the halo, then the reduction that ends a step.

        step     = (n + cuts) / (threads rate) + exchange + 2 log2(ranks) latency
        exchange = messages latency + bytes (ranks of a node) / bandwidth

    as if every message left its node. None where the problem has fewer pieces than ranks."""
    share = problem.busiest(ranks)
    if share is None:
        return None
    exchange = 0
    if share.messages:
        ranks_of_node = min(ranks, max(1, machine.cores_per_node // threads))
        exchange = share.messages * machine.latency_s + share.bytes * ranks_of_node / machine.bandwidth_B_s
    reduction = 2 * math.ceil(math.log2(ranks)) * machine.latency_s
    return steps * ((share.particles + share.cuts) / (threads * rate) + exchange + reduction)


def problem_of(record):
    """The Wall or Network of a run.json, None where the formulas do not hold (coupled, graphs, ensembles)."""
    value = lambda section, key: record["input"][section][key]["value"]
    results = record["results"]
    if value("scene", "model") == "network" and results["network"]["solver"] == "recursion":
        return Network(results["network"]["vessels"])
    if value("scene", "model") != "vessel":
        return None
    inner, outer, length = (value("vessel", key) for key in ("inner_radius", "outer_radius", "length"))
    spacing = value("discretisation", "spacing") or (
        math.pi * (outer**2 - inner**2) * length / value("discretisation", "particles")) ** (1 / 3)
    usual_ratio = 3.5  # what "auto" is for the laws of bonds, which this model is one of
    horizon = value("discretisation", "horizon") or spacing * (value("discretisation", "horizon_ratio") or usual_ratio)
    rows = max(1, round(length / spacing))
    columns = round(results["particles"] / rows)
    return Wall(columns, rows, 2 * results["bonds"] / results["particles"], math.floor(horizon / spacing + 1e-9),
                columns * horizon / (math.pi * (inner + outer)),
                3 * (8 if value("discretisation", "bond_precision") == "double" else 4))
