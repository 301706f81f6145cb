// SPDX-License-Identifier: BSD-3-Clause
/// What loads a wall besides its schedule: how the pressure answers to what becomes of the wall.
#pragma once

namespace rhexis::peridynamics {

class VesselSimulation;

/// By itself: the schedule's pressure, whatever happens to the wall.
class LoadSource {
 public:
  virtual ~LoadSource() = default;
  /// At the start of a simulation, and when it goes on from a saved state.
  virtual void start(VesselSimulation&) {}
  /// Before the present moment is observed. Collective.
  virtual void at_moment(VesselSimulation&) {}
  /// Before the step that follows the present moment. Collective.
  virtual void before_step(VesselSimulation&) {}
  /// What leaves the vessel through its opening as last measured, m3/s: by itself, by the orifice law.
  virtual double leak(const VesselSimulation& simulation) const;
  /// The largest share of the scheduled pressure that this source ever lets act.
  virtual double largest_share() const { return 1; }
};

/// The pressure falls once the wall has ruptured, because blood leaves through the opening (load.venting).
class VentedLoad final : public LoadSource {
 public:
  /// `supply_area`: through which blood enters, m2.
  explicit VentedLoad(double supply_area) : supply_area_(supply_area) {}
  void before_step(VesselSimulation& simulation) override;

 private:
  double supply_area_;
};

}  // namespace rhexis::peridynamics
