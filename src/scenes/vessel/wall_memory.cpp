// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/vessel/wall_memory.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "core/format.hpp"
#include "core/memory.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"
#include "peridynamics/engine/memory.hpp"
#include "runtime/version.hpp"

namespace rhexis::scenes {
namespace {

using peridynamics::WallMemory;
using peridynamics::WallUse;

WallUse use_of(const Configuration& c, int ranks) {
  return {.ranks = c.is_ensemble() ? 1 : ranks,
          .threads = parallel::thread_count(),
          .outputs = !c.is_ensemble() && (!c.output.fields.empty() || c.insitu.enabled),
          .doubles = c.output.precision == Precision::double_precision,
          .checkpoints = c.output.checkpoint_every > 0};
}

/// The memory of one wall: the ensemble's thickest, or the scene's.
WallMemory memory_of(const Configuration& c, const peridynamics::Parameters& p, int ranks) {
  WallMemory memory = peridynamics::wall_memory(p, peridynamics::wall_size(p), use_of(c, ranks));
  if (c.is_ensemble()) {
    constexpr double thickest = 3;  // standard deviations
    memory.run *= 1 + thickest * c.ensemble.thickness_spread;
  }
  return memory;
}

/// What ParaView takes to read scripts, bytes; measured with 5.11 and 5.13.
constexpr double paraview_bytes = 300e6;

double needed(const Configuration& c, const WallMemory& memory) {
  return c.checks ? std::max(memory.run, memory.check) : memory.run;
}

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
std::string key_at_fault(const Configuration& c, const peridynamics::Parameters& p) {
  if (!c.is_coupled()) {
    if (p.outer_radius > 5 * p.inner_radius) return "vessel.outer_radius";
    if (p.length > 1000 * p.outer_radius) return "vessel.length";
  }
  return p.particles ? "discretisation.particles" : "discretisation.spacing";
}

/// `; discretisation.spacing = "30 um" would fit, ...`: what to change, each alone.
std::string advice(const Configuration& c, const peridynamics::Parameters& resolved,
                   const std::function<bool(const peridynamics::Parameters&)>& fits) {
  const auto with = [&](const auto& change) {
    return largest_that_fits([&](double factor) {
      peridynamics::Parameters p = resolved;
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
  if (const auto coarser = with([](peridynamics::Parameters& p, double factor) {
        *p.spacing /= factor;
        *p.horizon /= factor;
      }))
    add("discretisation.spacing", *resolved.spacing / *coarser);
  if (c.is_coupled()) return text;
  if (const auto shorter = with([](peridynamics::Parameters& p, double factor) { p.length *= factor; }))
    add("vessel.length", resolved.length * *shorter);
  if (const auto thinner = with([](peridynamics::Parameters& p, double factor) {
        p.outer_radius = p.inner_radius + factor * (p.outer_radius - p.inner_radius);
      }))
    add("vessel.outer_radius",
        resolved.inner_radius + *thinner * (resolved.outer_radius - resolved.inner_radius));
  return text;
}

std::string megabytes(double bytes) {
  return bytes < 1e10 ? fmt::format("{} MB", grouped(std::llround(bytes / 1e6)))
                      : fmt::format("{} GB", grouped(std::llround(bytes / 1e9)));
}

}  // namespace

void check_memory(const Configuration& c, const peridynamics::Parameters& resolved,
                  parallel::Communicator comm) {
  const int ranks = comm.size(), here = parallel::ranks_of_node(comm);
  const peridynamics::WallSize size = peridynamics::wall_size(resolved);
  const WallMemory memory = memory_of(c, resolved, ranks);
  if (c.say && c.checks) {
    const bool reads_scripts =
        c.insitu.enabled && !c.insitu.scripts.empty() && !runtime::paraview_version().empty();
    c.say("memory",
          fmt::format("about {} for the wall, {}; this check takes up to {}{}", megabytes(memory.run),
                      c.is_ensemble() ? "on each rank" : "all ranks together",
                      megabytes(std::max(memory.check, c.input_bytes)),
                      reads_scripts ? fmt::format(", and {} for ParaView to read the scripts",
                                                  megabytes(paraview_bytes))
                                    : ""));
  }
  const MemoryLimit limit = available_memory();
  // The part of the wall's memory that the processes which share the limit take together.
  const double share = c.is_ensemble() ? (limit.of_machine ? here : 1)
                                       : static_cast<double>(limit.of_machine ? here : 1) / ranks;
  parallel::together<InputError>(comm, [&] {
    const double bytes = share * needed(c, memory);
    if (bytes <= limit.bytes) return;
    throw InputError(
        fmt::format(
            "the wall would hold {:.3g} particles ({:.3g} columns x {:.3g} rows) and take {}{}, and {} is "
            "left by {}{}",
            size.particles(), size.columns, size.rows, megabytes(bytes),
            ranks == 1         ? ""
            : limit.of_machine ? fmt::format(" for the {} ranks of a machine", here)
                               : " on a rank",
            megabytes(limit.bytes), limit.source,
            advice(c, resolved,
                   [&](const peridynamics::Parameters& p) {
                     return share * needed(c, memory_of(c, p, ranks)) <= limit.bytes;
                   })),
        key_at_fault(c, resolved));
  });
  constexpr double bonds_a_second = 1e6;  // or more: of making families and their weights
  if (c.say && size.bonds > 5 * bonds_a_second)
    c.say("", fmt::format("Making {:.3g} bonds of {:.3g} columns, which may take up to {}:", size.bonds,
                          size.columns, duration(size.bonds / bonds_a_second)));
}

}  // namespace rhexis::scenes
