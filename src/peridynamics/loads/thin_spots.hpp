// SPDX-License-Identifier: BSD-3-Clause
/// Spots where the wall is thinner ([[spot]], thickness): its outer part is missing there. Particles farther
/// out than r0 + f (r1 - r0) are absent, where f is the share of the thinnest spot at the place; they have no
/// bonds, no load, no damage, and stay where they are.
///
/// Where the wall is thinner than the loaded layer, what is left of it takes over the load of what is missing
/// (`load.layer` other than "paper"), so that the resultant over the spots is that of the whole wall.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "peridynamics/loads/pressure_layer.hpp"

namespace rhexis::peridynamics {

class ThinSpots {
 public:
  ThinSpots() = default;  ///< nowhere
  /// The spots of resolved parameters; `layer` is that of the whole wall. Throws InputError where no particle
  /// is left to bear the load.
  ThinSpots(const Parameters& p, const Lattice& lattice, const PressureLayer& layer);

  bool none() const { return absent_ == 0; }
  std::int64_t absent() const { return absent_; }  ///< particles

  /// Whether there is a particle at (x, y, z), m.
  bool present(double x, double y, double z) const;

  /// Load of the particle at (x, y, z) over what it would be in the whole wall.
  double load_share(double x, double y, double z) const;

 private:
  double outer_radius_at(double x, double y, double z) const;
  /// Share of the load that columns bear which reach no farther out than the wall at (x, y, z).
  double share_left(double x, double y, double z) const;

  double inner_radius_ = 0, outer_radius_ = 0;  ///< m
  Spots spots_;
  std::int64_t absent_ = 0;
  bool keeps_resultant_ = false;
  std::vector<std::pair<double, double>>
      borne_within_;    ///< radius (m), share of the load up to it; ascending
  double balance_ = 1;  ///< makes the resultant exact where columns of one radius are not spread evenly
};

}  // namespace rhexis::peridynamics
