// SPDX-License-Identifier: BSD-3-Clause
/// The rupture of one vessel's wall in time: a body, what loads it, and what has happened to it so far.
///
///     VesselSimulation simulation(*make_wall(parameters), comm);  // resolved parameters
///     LoadSource load;                                            // or one that answers to the wall
///     load.start(simulation);
///     TimeLoop(simulation, load, {.steps = 1000}).run();          // time_loop.hpp, with observers
#pragma once

#include <cstdint>
#include <memory>
#include <optional>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/monitors/particle_source.hpp"
#include "peridynamics/monitors/wall_gauge.hpp"
#include "peridynamics/simulation/load_source.hpp"
#include "peridynamics/wall_model.hpp"

namespace rhexis::peridynamics {

/// When the wall broke, and under what; nothing where it has not.
struct RuptureEvents {
  std::optional<double> first_break = {};  ///< s, of a bond
  std::optional<double> onset = {};        ///< s, of a damage of `rupture_damage` somewhere
  /// At the onset: the largest pressure in the vessel as the input means it, the blood pressure that pushes
  /// the stretched lumen as hard (Pa; the same, unless the load is dead), and the largest displacement (m).
  std::optional<double> pressure = {}, blood_pressure = {}, max_displacement = {};
};

/// How the load answers to the wall.
struct LoadState {
  double share = 1, next_share = 1;  ///< fraction of the scheduled pressure that acts, at t_n and t_{n+1}
  double least_share = 1;            ///< so far, by venting
  double open_area = 0;              ///< m2, as last measured
  double resistance_factor =
      1;  ///< flow resistance of the deformed lumen over that of the undeformed one, as last measured
};

class VesselSimulation {
 public:
  /// At rest at time 0. Collective.
  VesselSimulation(const WallModel& wall, parallel::Communicator comm);

  const Parameters& parameters() const { return p_; }
  std::int64_t particles() const { return particles_; }
  Body& body() { return *body_; }
  const Body& body() const { return *body_; }
  const WallGauge& gauge() const { return *gauge_; }

  const TimeSteps& time_steps() const { return time_; }
  long step_number() const { return step_; }
  double time_at(long step) const { return static_cast<double>(step) * time_.step; }
  double time() const { return time_at(step_); }
  /// By the schedule alone, Pa.
  double scheduled_pressure_at(long step) const;
  /// That acts now, Pa.
  double pressure() const { return scheduled_pressure_at(step_) * load_.share; }
  const RuptureEvents& rupture() const { return rupture_; }
  LoadState& load() { return load_; }
  const LoadState& load() const { return load_; }

  /// Evaluates the fields of the present moment, which `particle_source`, `totals` and `open_area` tell of
  /// until the next step. Collective.
  void observe();
  /// The particles and their fields as last observed.
  ParticleSource& particle_source() { return particle_source_; }
  /// Sums over the body as last observed. Collective.
  const Totals& totals();
  /// Area of the opening as last observed, m2; becomes that of `load()`. Collective.
  double open_area();

  /// What a step, or the end, has shown; the same on all ranks.
  struct Report {
    bool unstable = false, ruptures = false;  ///< at the moment before the step; rupture for the first time
    std::uint64_t flags = 0;                  ///< the union of all ranks'
  };
  /// Takes one step. `flags`: what this rank has to tell the others, below 2^60. Nothing is recorded of a
  /// step that has become unstable. Collective.
  Report step(LoadSource& load, std::uint64_t flags = 0);
  /// Records what the present moment shows, of which no further step will tell; observes it where nobody has.
  /// Collective.
  Report conclude();

  /// Goes on at a step with what a checkpoint has of it; the body is restored apart.
  void resume(long step, const RuptureEvents& rupture, const LoadState& load);

 private:
  Report record(bool broken, bool damaged);

  Parameters p_;
  TimeSteps time_;
  parallel::Communicator comm_;
  std::int64_t particles_ = 0;
  std::unique_ptr<Body> body_;
  ParticleSource particle_source_;
  std::unique_ptr<WallGauge> gauge_;
  long step_ = 0;
  RuptureEvents rupture_;
  LoadState load_;

  // What was observed at the present moment, where it was.
  bool observed_ = false;
  std::optional<Totals> totals_;
  bool opening_measured_ = false;
};

}  // namespace rhexis::peridynamics
