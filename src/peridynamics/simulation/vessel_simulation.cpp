// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/vessel_simulation.hpp"

#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/loads/thin_spots.hpp"

namespace rhexis::peridynamics {
namespace {

/// What ranks tell each other after every step, above the caller's own flags.
enum Flag : std::uint64_t { broken = 1ull << 61, ruptured = 1ull << 62, unstable = 1ull << 63 };

}  // namespace

VesselSimulation::VesselSimulation(const WallModel& wall, parallel::Communicator comm)
    : p_(wall.parameters),
      time_(wall.time),
      comm_(comm),
      particles_(wall.particles()),
      body_(make_body(wall, comm)),
      particle_source_(*body_),
      gauge_(make_gauge(wall, *body_, comm)) {}

double VesselSimulation::scheduled_pressure_at(long step) const {
  return scheduled_pressure(p_, time_at(step));
}

VesselSimulation::Report VesselSimulation::step(LoadSource& load, std::uint64_t flags) {
  load.before_step(*this);
  observed_ = false;
  const StepEvents events = body_->advance(pressure(), scheduled_pressure_at(step_ + 1) * load_.next_share);
  if (events.broken > 0) flags |= Flag::broken;
  if (events.damaged) flags |= Flag::ruptured;
  if (events.unstable) flags |= Flag::unstable;
  comm_.all_reduce({&flags, 1}, parallel::Reduce::bit_or);
  Report report;
  report.unstable = (flags & Flag::unstable) != 0;
  if (!report.unstable) report = record((flags & Flag::broken) != 0, (flags & Flag::ruptured) != 0);
  report.flags = flags & ~(Flag::broken | Flag::ruptured | Flag::unstable);
  if (report.unstable) return report;
  load_.share = load_.next_share;
  ++step_;
  return report;
}

VesselSimulation::Report VesselSimulation::conclude() {
  if (!observed_) observe();
  return record(totals().broken_bonds > 0, totals().max_damage >= rupture_damage);
}

void VesselSimulation::observe() {
  particle_source_.moment(step_, time(), body_->observe(pressure()), {{"pressure", "Pa", pressure()}});
  observed_ = true;
  totals_.reset();
  opening_measured_ = false;
}

const Totals& VesselSimulation::totals() {
  if (!totals_) totals_ = body_->totals();
  return *totals_;
}

double VesselSimulation::open_area() {
  // Beside a hole particles have lost about half of their bonds.
  if (!opening_measured_) load_.open_area = totals().max_damage >= rupture_damage ? gauge_->open_area() : 0;
  opening_measured_ = true;
  return load_.open_area;
}

/// Notes what the forces' evaluation at the present moment brought about, on any rank.
VesselSimulation::Report VesselSimulation::record(bool broken, bool damaged) {
  Report report;
  if (broken && !rupture_.first_break) rupture_.first_break = time();
  if (!damaged || rupture_.onset) return report;
  rupture_.onset = time();
  rupture_.pressure = pressure();
  rupture_.blood_pressure =
      *rupture_.pressure / (p_.direction == LoadDirection::dead ? gauge_->largest_lumen_stretch() : 1);
  rupture_.max_displacement = body_->max_displacement();
  report.ruptures = true;
  return report;
}

void VesselSimulation::resume(long step, const RuptureEvents& rupture, const LoadState& load) {
  step_ = step;
  rupture_ = rupture;
  load_ = load;
  observed_ = false;
}

}  // namespace rhexis::peridynamics
