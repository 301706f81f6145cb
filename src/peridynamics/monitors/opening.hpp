// SPDX-License-Identifier: BSD-3-Clause
/// How far a tube's wall has opened and how wide its lumen is, measured on its columns of particles.
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

/// Area of the holes through a wall, from the gaps that its particles leave around the axis.
///
/// Each axial row looks at the angles of its particles, all through the wall: a run of angles without any
/// particle is a gap. Uniform widening keeps angles, so an intact wall has exactly the gaps of its reference
/// state; a gap counts once it is half as wide again as the widest of those in its row, and its excess over
/// that width times the row's mean radius times the row spacing is its area. Exact to about one spacing of
/// width per row. A tear across the axis leaves no such gap, but rows that lie apart: in each sector of the
/// wall, the distance between one row's farthest particle and the next row's nearest counts in the same way,
/// once it is half as wide again as the row spacing.
///
/// Angles are sorted into bins that ranks merge by a bitwise or, and rows have a least and a greatest height,
/// so the result does not depend on ranks.
class OpeningGauge {
 public:
  /// Measures a body of columns; it and `lattice` must live on.
  OpeningGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm, EndCondition ends,
               const ThinSpots& thin_spots = {});

  /// Memory that this takes on all ranks: what it knows of rows. `across`: spacings across the wall.
  static double bytes(double particles, double across, int threads) {
    return 10 * particles / across * threads;
  }

  /// m2. Collective.
  double area() const;

 private:
  struct Rows;
  /// Adds the particles of one of this rank's columns.
  void look_at(std::size_t column, Rows& rows) const;

  const Lattice* lattice_;
  const Body* body_;
  parallel::Communicator comm_;
  bool periodic_;
  ThinSpots thin_spots_;
  double row_spacing_, radius_quantum_;
  std::vector<double> intact_gap_;      ///< rad, widest in each row of the reference state
  std::size_t bins_;                    ///< bins of angle in a row
  std::size_t sectors_;                 ///< sectors of the cross-section, each with columns in it
  std::vector<std::size_t> sector_of_;  ///< [columns]
};

/// How wide the lumen is, measured on the innermost particles of each axial row.
class LumenGauge {
 public:
  /// Measures a body of columns; it and `lattice` must live on.
  LumenGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm);

  /// Resistance to flow by Eq. (9) of the deformed vessel over that of the undeformed: the mean over rows of
  /// (r0 / r)^4, where r / r0 is the mean stretch of the distance from the axis of the row's innermost
  /// particles. The same for any ranks. Collective.
  double resistance_factor() const;

  /// Largest over the rows of r / r0 as above. Where ends are held, the area of the lumen's surface there has
  /// grown by the same factor. The same for any ranks. Collective.
  double largest_stretch() const;

 private:
  /// r / r0 of every axial row of the whole vessel, [rows]. Collective.
  std::vector<double> stretch_of_rows() const;

  const Lattice* lattice_;
  const Body* body_;
  parallel::Communicator comm_;
  std::vector<std::int64_t> innermost_;  ///< columns, ascending
};

}  // namespace rhexis::peridynamics
