// SPDX-License-Identifier: BSD-3-Clause
/// How far a tube's wall has opened and how wide its lumen is, measured on its columns of particles.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"
#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

/// Where the owned particles of a tube stand in its lattice.
class TubePlaces {
 public:
  /// `lattice_number`: column * rows + row of each particle of the body; empty: its id.
  TubePlaces(const Body& body, const Lattice& lattice, std::span<const std::int64_t> lattice_number)
      : rows_(lattice.rows), lattice_number_(lattice_number) {
    if (const ColumnLayout* const columns = body.columns(); columns != nullptr) {
      first_ = columns->first_column * rows_ + columns->first_row;
      row_count_ = columns->row_count;
    } else {
      first_ = body.ids().ranges.front().first;
    }
  }

  struct Place {
    std::size_t column, row;
  };
  Place of(std::size_t particle) const {
    const auto i = static_cast<std::int64_t>(particle);
    const std::int64_t number = lattice_number_.empty()
                                    ? first_ + i / row_count_ * rows_ + i % row_count_
                                    : lattice_number_[static_cast<std::size_t>(first_ + i)];
    return {static_cast<std::size_t>(number / rows_), static_cast<std::size_t>(number % rows_)};
  }

 private:
  std::int64_t rows_, first_ = 0, row_count_ = 0;
  std::span<const std::int64_t> lattice_number_;
};

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
  /// Measures a tube; references and `lattice_number` (see TubePlaces) must live on.
  OpeningGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm, EndCondition ends,
               const ThinSpots& thin_spots = {}, std::span<const std::int64_t> lattice_number = {});

  /// Memory that this takes on all ranks: what it knows of rows. `across`: spacings across the wall.
  static double bytes(double particles, double across, int threads) {
    return 10 * particles / across * threads;
  }

  /// m2. Collective.
  double area() const;

 private:
  struct Rows;
  /// Adds the particles [begin, end) of this rank.
  void look_at(std::size_t begin, std::size_t end, Rows& rows) const;

  const Lattice* lattice_;
  const Body* body_;
  TubePlaces places_;
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
  /// Measures a tube; references and `lattice_number` (see TubePlaces) must live on.
  LumenGauge(const Lattice& lattice, const Body& body, parallel::Communicator comm,
             std::span<const std::int64_t> lattice_number = {});

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
  TubePlaces places_;
  parallel::Communicator comm_;
  std::vector<bool> innermost_;   ///< [columns]
  std::int64_t innermost_count_;  ///< how many columns are
};

}  // namespace rhexis::peridynamics
