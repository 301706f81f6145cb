// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the sections coupling, body and cascade.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "core/parameter.hpp"
#include "coupling/net_pressure.hpp"
#include "hemodynamics/steady/flow_problem.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::coupling {

/// Whether the wall changes the network that loads it.
enum class Mode { one_way, two_way };

constexpr auto name_table(Mode) {
  using enum Mode;
  return std::to_array<Named<Mode>>({{one_way, "one_way"}, {two_way, "two_way"}});
}

/// How the spacing of a handed-over vessel is found.
enum class Resolution { automatic, paper };

constexpr auto name_table(Resolution) {
  using enum Resolution;
  return std::to_array<Named<Resolution>>({{automatic, "auto"}, {paper, "paper"}});
}

/// The radius of a straight wall, of a vessel whose radius varies along it.
enum class RadiusOf { mean, narrowest, widest };

constexpr auto name_table(RadiusOf) {
  using enum RadiusOf;
  return std::to_array<Named<RadiusOf>>({{mean, "mean"}, {narrowest, "narrowest"}, {widest, "widest"}});
}

enum class Axis { x, y, z };

constexpr auto name_table(Axis) {
  using enum Axis;
  return std::to_array<Named<Axis>>({{x, "x"}, {y, "y"}, {z, "z"}});
}

/// What a ruptured vessel does from then on.
enum class Outcome { bleeding, occlusion };

constexpr auto name_table(Outcome) {
  using enum Outcome;
  return std::to_array<Named<Outcome>>({{bleeding, "bleeding"}, {occlusion, "occlusion"}});
}

struct Parameters {
  std::string vessel;  ///< "screening": the one at highest risk
  Mode mode = Mode::one_way;
  std::optional<double> window;  ///< s
  Resolution resolution = Resolution::automatic;
  RadiusOf radius_of = RadiusOf::mean;

  double tension = 0, atmosphere = 0, compression = 0;  ///< Pa
  Axis compression_axis = Axis::x;
  std::optional<double> compression_from, compression_to;  ///< m

  std::int64_t events = 0;  ///< most vessels of a cascade; 0: one vessel, no cascade
  Outcome outcome = Outcome::bleeding;
  double risk_limit = 1;

  bool two_way() const { return mode == Mode::two_way; }
  bool screens() const { return vessel == "screening"; }
};

ParameterList declare(Parameters& p);

/// Checks what one key alone cannot tell, before the network is solved, and gives network and vessel what the
/// other one's input says for both: the density of blood, the walls' moduli and the critical stretch. Throws
/// InputError with the key at fault.
void resolve(const Parameters& p, hemodynamics::FlowProblem& network, peridynamics::Parameters& vessel);

/// The compression that section [body] describes.
Compression compression(const Parameters& p);
/// What acts on every vessel from outside (Pa): without a compression that has a range.
double outside_everywhere(const Parameters& p);

}  // namespace rhexis::coupling
