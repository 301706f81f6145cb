// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/bond_family.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace rhexis::peridynamics {
namespace {

/// Columns sorted into square bins as wide as the horizon, so that only nine bins need a look.
class ColumnBins {
 public:
  ColumnBins(const CrossSection& section, double width) : width_(width) {
    for (std::size_t c = 0; c < section.size(); ++c) {
      bins_[key(section.x[c], section.y[c])].push_back(static_cast<std::int32_t>(c));
    }
  }

  /// Columns of the nine bins around (x, y), ascending.
  std::vector<std::int32_t> around(double x, double y) const {
    std::vector<std::int32_t> found;
    const auto [kx, ky] = key(x, y);
    for (long dx = -1; dx <= 1; ++dx) {
      for (long dy = -1; dy <= 1; ++dy) {
        const auto bin = bins_.find({kx + dx, ky + dy});
        if (bin != bins_.end()) found.insert(found.end(), bin->second.begin(), bin->second.end());
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

 private:
  std::pair<long, long> key(double x, double y) const {
    return {static_cast<long>(std::floor(x / width_)), static_cast<long>(std::floor(y / width_))};
  }

  double width_;
  std::map<std::pair<long, long>, std::vector<std::int32_t>> bins_;
};

/// Particles of rows 0..rows-1 that have a partner `offset` rows away.
std::int64_t rows_with_partner(std::int64_t rows, int offset, bool periodic) {
  return periodic ? rows : std::max<std::int64_t>(0, rows - std::abs(offset));
}

}  // namespace

BondFamilies find_families(const Lattice& lattice) {
  const CrossSection& s = lattice.section;
  // Neighbours exactly at the horizon count, whatever the last digit says.
  const double horizon = lattice.horizon / lattice.spacing * (1 + 1e-9);
  const double step = lattice.row_spacing / lattice.spacing;
  const auto reach = static_cast<int>(std::floor(horizon / step));
  const ColumnBins bins(s, lattice.horizon * (1 + 1e-9));

  const auto each_bond = [&](std::size_t i, const auto& use) {
    for (std::int32_t j : bins.around(s.x[i], s.y[i])) {
      const double xi_x = (s.x[j] - s.x[i]) / lattice.spacing;
      const double xi_y = (s.y[j] - s.y[i]) / lattice.spacing;
      for (int m = -reach; m <= reach; ++m) {
        const double xi_z = step * m;
        const double length = std::sqrt(xi_x * xi_x + xi_y * xi_y + xi_z * xi_z);
        if (length <= horizon && length != 0) use(Bond{j, m, {xi_x, xi_y, xi_z}, length});
      }
    }
  };

  BondFamilies families;
  families.first.reserve(s.size() + 1);
  families.first.push_back(0);
  // Counted first: an array that grows takes up to twice its room.
  std::size_t bonds = 0;
  for (std::size_t i = 0; i < s.size(); ++i) each_bond(i, [&](const Bond&) { ++bonds; });
  families.bonds.reserve(bonds);
  for (std::size_t i = 0; i < s.size(); ++i) {
    each_bond(i, [&](const Bond& bond) {
      families.bonds.push_back(bond);
      families.reach = std::max(families.reach, std::abs(bond.row_offset));
    });
    const auto first = families.bonds.begin() + families.first.back();
    const auto later = std::find_if(first, families.bonds.end(), [&](const Bond& bond) {
      return is_forward(bond, static_cast<std::int32_t>(i));
    });
    std::sort(later, families.bonds.end(), [](const Bond& a, const Bond& b) {
      return a.row_offset != b.row_offset ? a.row_offset > b.row_offset : a.other < b.other;
    });
    families.first.push_back(static_cast<std::int64_t>(families.bonds.size()));
  }
  return families;
}

std::int64_t count_bonds(const Lattice& lattice, const BondFamilies& families, bool periodic) {
  std::int64_t directed = 0;
  for (const Bond& bond : families.bonds)
    directed += rows_with_partner(lattice.rows, bond.row_offset, periodic);
  return directed / 2;
}

std::int64_t largest_family(const Lattice& lattice, const BondFamilies& families, bool periodic) {
  // A row in the middle of the body has most; short bodies have no row that is far from both ends.
  const std::int64_t middle = lattice.rows / 2;
  std::int64_t most = 0;
  for (std::size_t c = 0; c + 1 < families.first.size(); ++c) {
    most = std::max(most, static_cast<std::int64_t>(std::count_if(
                              families.bonds.begin() + families.first[c],
                              families.bonds.begin() + families.first[c + 1], [&](const Bond& bond) {
                                const std::int64_t row = middle + bond.row_offset;
                                return periodic || (row >= 0 && row < lattice.rows);
                              })));
  }
  return most;
}

ColumnCut mean_column_cut(const BondFamilies& families) {
  const auto columns = static_cast<std::int32_t>(families.first.size() - 1);
  std::int64_t steps_of_columns = 0, steps_of_bonds = 0;  // a bond of so many steps crosses as many cuts
  for (std::int32_t c = 0; c < columns; ++c) {
    std::int32_t furthest = 0;
    for (const Bond& bond : families.of(static_cast<std::size_t>(c))) {
      const std::int32_t ahead = (bond.other - c + columns) % columns;  // round the tube, the shorter way
      if (ahead > columns / 2) continue;
      steps_of_bonds += ahead;
      furthest = std::max(furthest, ahead);
    }
    steps_of_columns += furthest;
  }
  return {static_cast<double>(steps_of_columns) / columns, static_cast<double>(steps_of_bonds) / columns};
}

}  // namespace rhexis::peridynamics
