// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/statics/elastic_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include "core/error.hpp"
#include "peridynamics/engine/general_body.hpp"
#include "peridynamics/laws/all_laws.hpp"
#include "peridynamics/statics/small_strain.hpp"

namespace rhexis::peridynamics {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor, std::ptrdiff_t>;

/// Columns that a column has bonds with, itself among them: for each, what `Block` gathers of these bonds.
template <class Block>
using BlockRow = std::map<std::int32_t, Block>;

/// An empty matrix with room for `height` rows a column and two entries in each for every column that it has
/// bonds with: lists of single entries, a dozen for every bond, would take more room than the bonds.
Matrix matrix_for(const BondFamilies& families, Eigen::Index height) {
  const std::size_t columns = families.first.size() - 1;
  std::vector<std::int32_t> seen_by(columns, -1);
  Eigen::Index blocks = 0;
  for (std::size_t i = 0; i < columns; ++i) {
    const auto own = static_cast<std::int32_t>(i);
    ++blocks;
    seen_by[i] = own;
    for (const Bond& bond : families.of(i)) {
      std::int32_t& seen = seen_by[static_cast<std::size_t>(bond.other)];
      if (seen != own) ++blocks;
      seen = own;
    }
  }
  Matrix matrix(height * static_cast<Eigen::Index>(columns), 2 * static_cast<Eigen::Index>(columns));
  matrix.reserve(2 * height * blocks);
  return matrix;
}

/// Stiffness of a slice one row thick, N/m over m: column i's unknowns are 2 i and 2 i + 1.
Matrix stiffness(const BodySetup& setup) {
  const Lattice& lattice = setup.lattice;
  Matrix matrix = matrix_for(*setup.families, 2);
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const auto own = static_cast<std::int32_t>(i);
    BlockRow<std::array<std::array<double, 2>, 2>> blocks;
    for (const Bond& bond : setup.families->of(i)) {
      const double size = setup.bond_constant * bond.weight * lattice.volume(i) *
                          lattice.volume(static_cast<std::size_t>(bond.other)) /
                          (std::pow(bond.length, 3) * lattice.spacing);
      for (std::size_t a = 0; a < 2; ++a) {
        for (std::size_t b = 0; b < 2; ++b) {
          const double value = size * bond.xi[a] * bond.xi[b];
          blocks[own][a][b] += value;
          blocks[bond.other][a][b] -= value;
        }
      }
    }
    for (std::size_t a = 0; a < 2; ++a) {
      const auto row = static_cast<Eigen::Index>(2 * i + a);
      matrix.startVec(row);
      for (const auto& [other, block] : blocks) {
        for (std::size_t b = 0; b < 2; ++b)
          matrix.insertBack(row, 2 * Eigen::Index{other} + static_cast<Eigen::Index>(b)) = block[a][b];
      }
    }
  }
  matrix.finalize();
  return matrix;
}

/// The stiffness that the dilatations of a state-based law add: c m V_i times the second derivative of their
/// energy, as in laws/lps.hpp.
Matrix dilatation_stiffness(const BodySetup& setup, const Lps& law) {
  const Lattice& lattice = setup.lattice;
  const auto columns = static_cast<Eigen::Index>(lattice.section.size());
  const double weighted_volume = law.weighted_volume(lattice.horizon);
  Matrix dilatation = matrix_for(*setup.families, 1);
  Eigen::VectorXd size(columns);
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(i);
    size[row] = 2 * law.dilatation_energy(1) * setup.bond_constant * weighted_volume * lattice.volume(i);
    BlockRow<std::array<double, 2>> blocks;
    for (const Bond& bond : setup.families->of(i)) {
      for (std::size_t a = 0; a < 2; ++a) {
        const double value = 3 / weighted_volume * bond.weight *
                             lattice.volume(static_cast<std::size_t>(bond.other)) * bond.xi[a] / bond.length;
        blocks[bond.other][a] += value;
        blocks[static_cast<std::int32_t>(i)][a] -= value;
      }
    }
    dilatation.startVec(row);
    for (const auto& [other, block] : blocks) {
      for (std::size_t a = 0; a < 2; ++a)
        dilatation.insertBack(row, 2 * Eigen::Index{other} + static_cast<Eigen::Index>(a)) = block[a];
    }
  }
  dilatation.finalize();
  return dilatation.transpose() * size.asDiagonal() * dilatation;
}

/// Takes out what would move or turn the slice as a whole: its stiffness does not resist that.
void balance(const CrossSection& s, Eigen::VectorXd& load) {
  Eigen::MatrixXd modes = Eigen::MatrixXd::Zero(load.size(), 3);
  for (std::size_t i = 0; i < s.size(); ++i) {
    const auto row = static_cast<Eigen::Index>(2 * i);
    modes(row, 0) = modes(row + 1, 1) = 1;
    modes(row, 2) = -s.y[i];
    modes(row + 1, 2) = s.x[i];
  }
  load -= modes * (modes.transpose() * modes).ldlt().solve(modes.transpose() * load);
}

/// Radial displacements against the exact ones.
class Comparison {
 public:
  /// `size`: area or volume that has this displacement.
  void add(double size, double radial, double exact) {
    error_ += size * (radial - exact) * (radial - exact);
    size_ += size * exact * exact;
    least_ = std::min(least_, radial / exact);
    most_ = std::max(most_, radial / exact);
  }
  ElasticError result() const {
    return {.relative_l2 = std::sqrt(error_ / size_), .spread = most_ / least_ - 1};
  }

 private:
  double error_ = 0, size_ = 0, least_ = INFINITY, most_ = -INFINITY;
};

}  // namespace

double lame_displacement(const Parameters& p, double pressure, double r) {
  const double nu = p.law.poisson_ratio;
  const double inner2 = p.inner_radius * p.inner_radius, outer2 = p.outer_radius * p.outer_radius;
  return (1 + nu) / p.young_modulus * pressure * inner2 / (outer2 - inner2) * ((1 - 2 * nu) * r + outer2 / r);
}

std::optional<ElasticError> elastic_error(const Parameters& p, const BodySetup& setup,
                                          double most_multiplications) {
  const CrossSection& s = setup.lattice.section;
  Eigen::VectorXd load(static_cast<Eigen::Index>(2 * s.size()));
  for (std::size_t i = 0; i < s.size(); ++i) {
    load[static_cast<Eigen::Index>(2 * i)] = setup.lattice.volume(i) * setup.layer.bx[i];
    load[static_cast<Eigen::Index>(2 * i + 1)] = setup.lattice.volume(i) * setup.layer.by[i];
  }
  balance(s, load);
  Matrix matrix = stiffness(setup);
  with_law(setup.law, [&]<class Law>(const Law& law) {
    if constexpr (Law::state_based) matrix += dilatation_stiffness(setup, law);
  });
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(1e-8);
  const double most_iterations = most_multiplications / static_cast<double>(matrix.nonZeros());
  if (most_iterations < static_cast<double>(2 * load.size()))
    solver.setMaxIterations(static_cast<Eigen::Index>(most_iterations));
  Eigen::VectorXd u = solver.solve(load);
  if (solver.info() == Eigen::NoConvergence && solver.maxIterations() < 2 * load.size()) return std::nullopt;
  if (solver.info() != Eigen::Success) throw RunError("the bonds do not hold the wall together");
  balance(s, u);

  Comparison comparison;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double r = std::hypot(s.x[i], s.y[i]);
    const auto row = static_cast<Eigen::Index>(2 * i);
    const double radial = (u[row] * s.x[i] + u[row + 1] * s.y[i]) / r;
    comparison.add(s.area[i], radial, lame_displacement(p, 1, r));
  }
  return comparison.result();
}

std::optional<ElasticError> elastic_error(const WallModel& wall, double most_multiplications) {
  const Parameters& p = wall.parameters;
  if (!wall.by_gradient()) return elastic_error(p, wall.setup, most_multiplications);
  Parameters matrix = p;  // what Lame's solution is one of
  matrix.law.name = NeoHookean::name;
  const GeneralTube tube = make_short_tube(matrix, wall.setup);
  const auto self = parallel::Communicator::self();
  const auto body = make_body(tube.setup, self);
  const ParticleSet& set = tube.setup->geometry->particles;
  const SmallStrain found = find_small_strain(*body, 1e-5 * set.spacing, 1e-5, self);
  Comparison comparison;
  for (std::size_t i = 0; i < set.size(); ++i) {
    // In the middle, away from what the ends do.
    const std::int64_t rows = static_cast<std::int64_t>(set.size() / wall.lattice().section.size());
    if (const std::int64_t row = tube.lattice_number[i] % rows; row < rows / 4 || row >= rows - rows / 4)
      continue;
    const double x = set.position[0][i], y = set.position[1][i], r = std::hypot(x, y);
    const double radial = (found.displacement[0][i] * x + found.displacement[1][i] * y) / r;
    comparison.add(set.volume[i], radial, lame_displacement(p, 1, r));
  }
  return comparison.result();
}

double elastic_error_bytes(const Parameters& p, const WallSize& size) {
  const double entry = sizeof(double) + sizeof(Matrix::StorageIndex);
  const double vectors = 2 * 10 * sizeof(double);  // of two unknowns a column
  const double of_bonds = size.columns * (4 * size.neighbours * entry + vectors);
  return with_law(p.law, [&]<class Law>(const Law&) {
    // Dilatation joins neighbours' neighbours too, 2.5 times as many; the allocator keeps some of what is
    // freed.
    if constexpr (Law::state_based)
      return of_bonds + size.columns * size.neighbours * entry * (2 + 4 * 4 * 2.8);
    return of_bonds;
  });
}

}  // namespace rhexis::peridynamics
