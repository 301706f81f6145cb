// SPDX-License-Identifier: BSD-3-Clause
#include "studies/rupture/wall_checkpoint.hpp"

#include <fmt/format.h>

#include <cmath>

namespace rhexis::studies {
namespace {

using peridynamics::Body;

constexpr const char* axes[] = {"x", "y", "z"};
constexpr double largest = output::CheckpointReader::largest;

/// The distributed arrays, by name and layout, once for writing and for reading.
template <class Saved, class Visit>
void for_each_array(const Body& body, Saved& saved, const Visit& visit) {
  for (std::size_t k = 0; k < 3; ++k) {
    visit(fmt::format("displacement_{}", axes[k]), body.ids(), saved.displacement[k]);
    visit(fmt::format("leapfrog_velocity_{}", axes[k]), body.ids(), saved.leapfrog_velocity[k]);
  }
  visit("intact_bonds", body.word_table(), saved.words);
  for (std::size_t k = 0; k < 3 && !saved.surface[k].empty(); ++k) {
    visit(fmt::format("surface_force_{}", axes[k]), body.ids(), saved.surface[k]);
    visit(fmt::format("surface_displacement_{}", axes[k]), body.ids(), saved.surface[3 + k]);
  }
}

/// What a wall's state is besides its arrays.
struct State {
  Body::Saved body;
  peridynamics::RuptureEvents rupture;
  peridynamics::LoadState load;
  GivenWarnings given;
};

/// Names, members and the range that makes sense of all numbers, once for writing and for reading. SI units.
template <class Visit>
void for_each_number(State& s, double largest_share, const Visit& visit) {
  visit("frame_phase", s.body.frame_phase, 0, largest);
  visit("wrapped", s.body.wrapped);
  visit("first_kick_pending", s.body.first_kick_pending);
  for (std::size_t i = 0; i < 2; ++i) {
    visit(fmt::format("external_work_{}", i), s.body.external_work[i]);
    visit(fmt::format("released_energy_{}", i), s.body.released_energy[i]);
  }
  visit("load_speed", s.body.load_speed, 0, largest);
  for (std::size_t k = 0; k < 3; ++k) visit(fmt::format("frame_{}", axes[k]), s.body.frame[k]);
  visit("pressure_share", s.load.share, 0, largest_share);
  visit("least_pressure_share", s.load.least_share, 0, 1);
  visit("opening_area", s.load.open_area, 0, largest);
  visit("resistance_factor", s.load.resistance_factor, 0, largest);
  visit("told_of_crushed_bonds", s.given.crushed_bonds);
  visit("told_of_turbulence", s.given.turbulence);
  visit("first_bond_break_time", s.rupture.first_break, 0, largest);
  visit("rupture_onset_time", s.rupture.onset, 0, largest);
  visit("pressure_at_onset", s.rupture.pressure, 0, largest);
  visit("blood_pressure_at_onset", s.rupture.blood_pressure, 0, largest);
  visit("max_displacement_at_onset", s.rupture.max_displacement, 0, largest);
}

}  // namespace

void save_wall(const peridynamics::VesselSimulation& simulation, const GivenWarnings& given,
               output::CheckpointWriter& file) {
  const Body& body = simulation.body();
  State state{body.save(), simulation.rupture(), simulation.load(), given};
  for_each_number(state, largest,
                  [&](const std::string& name, const auto& value, auto...) { file.write(name, value); });
  for_each_array(body, state.body, [&](const std::string& name, const auto& layout, const auto& values) {
    file.write(name, layout, values);
  });
}

void restore_wall(peridynamics::VesselSimulation& simulation, const peridynamics::LoadSource& load,
                  GivenWarnings& given, long step, output::CheckpointReader& file) {
  Body& body = simulation.body();
  State state{body.save(), {}, {}, {}};
  for_each_number(state, load.largest_share(), [&](const std::string& name, auto& value, auto... range) {
    file.read(name, value, range...);
  });
  for_each_array(body, state.body, [&](const std::string& name, const auto& layout, auto& values) {
    file.read(name, layout, values);
  });
  body.restore(state.body);
  if (!std::isfinite(body.save().external_work[0]))
    file.refuse("'external_work_0' makes no sense: it is beyond all energies of this body");
  state.load.next_share = state.load.share;
  simulation.resume(step, state.rupture, state.load);
  given = state.given;
}

}  // namespace rhexis::studies
