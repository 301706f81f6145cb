// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/stability/dilatation_bound.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "peridynamics/laws/lps.hpp"

namespace rhexis::peridynamics {
namespace {

/// d and R of one particle.
struct Imbalance {
  std::array<double, 3> d{};
  double size = 0, reach = 0;
};

class Matrix {
 public:
  /// weight n n^T
  void add(double weight, const double* n) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t l = 0; l < 3; ++l) rows_[k][l] += weight * n[k] * n[l];
    }
  }
  double largest_row_sum() const {
    double largest = 0;
    for (const auto& row : rows_)
      largest = std::max(largest, std::abs(row[0]) + std::abs(row[1]) + std::abs(row[2]));
    return largest;
  }

 private:
  std::array<std::array<double, 3>, 3> rows_{};
};

}  // namespace

double dilatation_bound(const Lattice& lattice, const BondFamilies& families, bool periodic) {
  const double unit_volume = lattice.spacing * lattice.spacing * lattice.spacing;
  const double weighted_volume = Lps::weighted_volume(lattice.horizon / lattice.spacing);
  // a_ij of a bond.
  const auto share = [&](const Bond& bond) {
    return 3 * bond.weight * lattice.volume(static_cast<std::size_t>(bond.other)) / unit_volume /
           weighted_volume;
  };
  // Families look alike from one reach off an end on, families of families from two.
  const auto rows_up_to = [&](std::int64_t count) { return periodic ? 1 : std::min(lattice.rows, count); };
  const std::int64_t rows = rows_up_to(2 * families.reach + 1),
                     near_rows = rows_up_to(3 * families.reach + 1);
  const std::size_t columns = lattice.section.size();
  const auto each_bond = [&](std::size_t column, std::int64_t row, const auto& visit) {
    for (std::int64_t b = families.first[column]; b < families.first[column + 1]; ++b) {
      const Bond& bond = families.bonds[static_cast<std::size_t>(b)];
      const std::int64_t other_row = periodic ? 0 : row + bond.row_offset;
      if (other_row >= 0 && other_row < lattice.rows) visit(bond, other_row);
    }
  };

  std::vector<Imbalance> imbalances(columns * static_cast<std::size_t>(near_rows));
  const auto imbalance = [&](std::size_t column, std::int64_t row) -> Imbalance& {
    return imbalances[column * static_cast<std::size_t>(near_rows) + static_cast<std::size_t>(row)];
  };
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::int64_t row = 0; row < near_rows; ++row) {
      Imbalance& own = imbalance(c, row);
      each_bond(c, row, [&](const Bond& bond, std::int64_t) {
        for (std::size_t k = 0; k < 3; ++k) own.d[k] += share(bond) * bond.xi[k] / bond.length;
        own.reach += share(bond);
      });
      own.size = std::hypot(own.d[0], own.d[1], own.d[2]);
      own.reach += own.size;
    }
  }

  double bound = 0;
  for (std::size_t c = 0; c < columns; ++c) {
    for (std::int64_t row = 0; row < rows; ++row) {
      Matrix m;
      each_bond(c, row, [&](const Bond& bond, std::int64_t other_row) {
        const Imbalance& other = imbalance(static_cast<std::size_t>(bond.other), other_row);
        m.add(share(bond) * other.reach / (bond.length * bond.length), bond.xi);
      });
      const Imbalance& own = imbalance(c, row);
      if (own.size > 0) m.add(own.reach / own.size, own.d.data());
      bound = std::max(bound, m.largest_row_sum());
    }
  }
  return bound;
}

}  // namespace rhexis::peridynamics
