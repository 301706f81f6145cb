// Vessels and bodies for tests.
#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/body.hpp"
#include "peridynamics/materials/pmb.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::test {

inline parallel::Communicator self() {
  return parallel::Communicator(MPI_COMM_SELF);
}

/// The paper's wall (Table 2), `length` m long, resolved.
inline peridynamics::Parameters paper_vessel(double length = 2e-3) {
  peridynamics::Parameters p;
  p.inner_radius = 1.5e-3;
  p.outer_radius = 2e-3;
  p.length = length;
  p.density = 1300;
  p.young_modulus = 3.5e6;
  p.critical_stretch = 0.25;
  p.cross_section = "lattice";
  p.spacing = 1e-4;
  p.horizon = 3.5e-4;
  p.lattice_shift = {0.5, 0.5};
  p.bond_precision = "single";
  p.ends = "clamped";
  p.pressure = 238e3;
  p.schedule = "ramp";
  p.layer = "paper";
  p.venting = "none";
  p.end_time = 2.25e-3;
  return p;
}

inline peridynamics::BodySetup setup_of(peridynamics::Parameters p, double time_step) {
  peridynamics::resolve(p);
  peridynamics::Lattice lattice = peridynamics::make_lattice(p);
  peridynamics::BondFamilies families = peridynamics::make_families(lattice);
  return peridynamics::make_setup(p, std::move(lattice), std::move(families), time_step);
}

inline double stable_step_of(const peridynamics::BodySetup& s) {
  return peridynamics::stable_time_step(s.lattice, s.families, s.bond_constant, s.density);
}

/// A state given by functions of the reference position.
template <class Function>
std::array<std::vector<double>, 3> sample(const peridynamics::Body& body, const Function& function) {
  std::array<std::vector<double>, 3> values;
  const PointLayout& l = body.layout();
  for (std::int64_t c = 0; c < l.column_count; ++c) {
    for (std::int64_t r = 0; r < l.row_count; ++r) {
      const std::array<double, 3> v = function(body.reference_position(c, r));
      for (std::size_t k = 0; k < 3; ++k) values[k].push_back(v[k]);
    }
  }
  return values;
}

inline std::array<double, 3> nothing(const std::array<double, 3>&) {
  return {0, 0, 0};
}

}  // namespace rhexis::test
