// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/wall_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/monitors/opening.hpp"
#include "peridynamics/monitors/particle_source.hpp"
#include "peridynamics/stability/linear_limit.hpp"
#include "peridynamics/statics/elastic_error.hpp"
#include "peridynamics/statics/equilibrium.hpp"

namespace rhexis::peridynamics {
namespace {

/// The largest factor below 1 for which `fits`, to 3 %; none above a thousandth.
std::optional<double> largest_that_fits(const std::function<bool(double factor)>& fits) {
  constexpr double coarse = 0.7, fine = 0.97;
  for (double factor = coarse; factor > 1e-3; factor *= coarse) {
    if (!fits(factor)) continue;
    for (double larger = fine * factor / coarse; larger > factor; larger *= fine)
      if (fits(larger)) return larger;
    return factor;
  }
  return {};
}

/// The key whose value makes the wall so large, by the look of the vessel; walls are some tenths of a lumen
/// thick, and vessels up to some hundred times as long as wide.
std::string key_at_fault(const Parameters& p, bool geometry_is_given) {
  if (!geometry_is_given) {
    if (p.outer_radius > 5 * p.inner_radius) return "vessel.outer_radius";
    if (p.length > 1000 * p.outer_radius) return "vessel.length";
  }
  return p.particles ? "discretisation.particles" : "discretisation.spacing";
}

/// `; discretisation.spacing = "30 um" would fit, ...`: what to change, each alone.
std::string advice(const Parameters& resolved, bool geometry_is_given,
                   const std::function<bool(const Parameters&)>& fits) {
  const auto with = [&](const auto& change) {
    return largest_that_fits([&](double factor) {
      Parameters p = resolved;
      change(p, factor);
      const double across = (p.outer_radius - p.inner_radius) / *p.spacing;
      return across >= 1 && p.length > 2 * *p.horizon && fits(p);
    });
  };
  std::string text;
  const auto add = [&](const std::string& key, double value) {
    text +=
        fmt::format("{}{} = \"{}\"", text.empty() ? "; would fit: " : ", or ", key, quantity(value, "m", 2));
  };
  if (const auto coarser = with([](Parameters& p, double factor) {
        *p.spacing /= factor;
        *p.horizon /= factor;
      }))
    add("discretisation.spacing", *resolved.spacing / *coarser);
  if (geometry_is_given) return text;
  if (const auto shorter = with([](Parameters& p, double factor) { p.length *= factor; }))
    add("vessel.length", resolved.length * *shorter);
  if (const auto thinner = with([](Parameters& p, double factor) {
        p.outer_radius = p.inner_radius + factor * (p.outer_radius - p.inner_radius);
      }))
    add("vessel.outer_radius",
        resolved.inner_radius + *thinner * (resolved.outer_radius - resolved.inner_radius));
  return text;
}

/// Bonds of a particle inside a wall of a law by gradient, an upper bound of the mean.
double neighbours_inside(const Parameters& p) {
  return 4.0 / 3 * std::numbers::pi * std::pow(*p.horizon / *p.spacing, 3);
}

/// Of a law by gradient.
WallMemory general_memory(const Parameters& p, const WallSize& wall, const WallUse& use) {
  const double particles = wall.particles(), neighbours = neighbours_inside(p);
  const double geometry = use.ranks * geometry_bytes(particles, neighbours);
  const double body =
      general_body_bytes(particles, neighbours, p.bond_precision == Precision::double_precision);
  double run = body + Observation::bytes(particles);
  if (use.outputs)
    run += ParticleSource::bytes(particles, true) +
           3 * particles * (use.doubles ? sizeof(double) : sizeof(float));
  if (use.checkpoints) run += particles * (6 * sizeof(double) + neighbours / 8);
  if (p.equilibrium_pressure > 0)
    run = std::max(run, body + Observation::bytes(particles) + equilibrium_bytes(body, particles));
  const double pieces = wall.columns * std::min(wall.rows, static_cast<double>(timed_rows * use.ranks));
  return {geometry + run,
          geometry + geometry_bytes(pieces, neighbours) + general_body_bytes(pieces, neighbours, true)};
}

double run_bytes(const Parameters& p, const WallSize& wall, const WallUse& use) {
  const bool doubles = p.bond_precision == Precision::double_precision;
  const BodySize size = body_size(p, wall, wall.rows, use.ranks);
  const double particles = size.particles(), body = body_bytes(p.law, doubles, size);
  double bytes = body + Observation::bytes(particles);
  if (use.outputs) {
    const double across = std::max(1.0, (p.outer_radius - p.inner_radius) / *p.spacing);
    const double written = 3 * particles * (use.doubles ? sizeof(double) : sizeof(float));
    bytes += ParticleSource::bytes(particles, false) + written +
             OpeningGauge::bytes(particles, across, use.threads);
  }
  if (use.checkpoints) bytes += Body::Saved::bytes(size);
  if (p.equilibrium_pressure > 0)
    bytes = std::max(bytes, body + Observation::bytes(particles) + equilibrium_bytes(body, particles));
  return bytes;
}

double check_bytes(const Parameters& p, const WallSize& wall, const WallUse& use) {
  const bool doubles = p.bond_precision == Precision::double_precision;
  const double rows = std::min(wall.rows, static_cast<double>(timed_rows * use.ranks));
  const double timed = body_bytes(p.law, doubles, body_size(p, wall, rows, use.ranks));
  return std::max({timed, linear_limit_bytes(p, wall), elastic_error_bytes(p, wall)});
}

}  // namespace

WallMemory wall_memory(const Parameters& p, const WallSize& size, const WallUse& use) {
  if (p.law.by_gradient()) return general_memory(p, size, use);
  const double families = use.ranks * BondFamilies::bytes(size);  // every rank has them all
  const double weighting = use.ranks * weighting_bytes(p, size);
  return {families + std::max(weighting, run_bytes(p, size, use)),
          families + std::max(weighting, check_bytes(p, size, use))};
}

std::string megabytes(double bytes) {
  return bytes < 1e10 ? fmt::format("{} MB", grouped(std::llround(bytes / 1e6)))
                      : fmt::format("{} GB", grouped(std::llround(bytes / 1e9)));
}

WallMemory memory_of(const Parameters& resolved, const WallDemand& demand) {
  WallMemory memory = wall_memory(resolved, wall_size(resolved), demand.use);
  memory.run *= demand.variation;
  return memory;
}

void require_memory(const Parameters& resolved, const WallDemand& demand, parallel::Communicator comm) {
  const int ranks = comm.size(), here = parallel::ranks_of_node(comm);
  const MemoryLimit limit = available_memory();
  // The part of a wall's memory that the processes which share the limit take together.
  const double walls = limit.of_machine ? here : 1, share = demand.one_each ? walls : walls / ranks;
  const auto needed = [&](const Parameters& p) {
    const WallMemory memory = memory_of(p, demand);
    return share * (demand.only_checks ? std::max(memory.run, memory.check) : memory.run);
  };
  parallel::together<InputError>(comm, [&] {
    const double bytes = needed(resolved);
    if (bytes <= limit.bytes) return;
    const WallSize size = wall_size(resolved);
    throw InputError(
        fmt::format("the wall would hold {:.3g} particles ({:.3g} columns x {:.3g} rows) and take {}{}, and "
                    "{} is left by {}{}",
                    size.particles(), size.columns, size.rows, megabytes(bytes),
                    ranks == 1         ? ""
                    : limit.of_machine ? fmt::format(" for the {} ranks of a machine", here)
                                       : " on a rank",
                    megabytes(limit.bytes), limit.source,
                    advice(resolved, demand.geometry_is_given,
                           [&](const Parameters& p) { return needed(p) <= limit.bytes; })),
        key_at_fault(resolved, demand.geometry_is_given));
  });
}

}  // namespace rhexis::peridynamics
