#include "peridynamics/elastic_error.hpp"

#include <Eigen/Cholesky>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>

#include "core/error.hpp"
#include "peridynamics/materials/with_law.hpp"

namespace rhexis::peridynamics {
namespace {

/// Stiffness of a slice one row thick, N/m over m: column i's unknowns are 2 i and 2 i + 1.
Eigen::SparseMatrix<double> stiffness(const BodySetup& setup) {
  const Lattice& lattice = setup.lattice;
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const int row = 2 * static_cast<int>(i);
    for (const Bond& bond : setup.families.of(i)) {
      const double size = setup.bond_constant * bond.weight * lattice.volume(i) *
                          lattice.volume(static_cast<std::size_t>(bond.other)) /
                          (std::pow(bond.length, 3) * lattice.spacing);
      for (int a = 0; a < 2; ++a) {
        for (int b = 0; b < 2; ++b) {
          const double value = size * bond.xi[a] * bond.xi[b];
          entries.emplace_back(row + a, row + b, value);
          entries.emplace_back(row + a, 2 * bond.other + b, -value);
        }
      }
    }
  }
  const auto unknowns = static_cast<Eigen::Index>(2 * lattice.section.size());
  Eigen::SparseMatrix<double> matrix(unknowns, unknowns);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// What the dilatations of a state-based law add: c m V_i times the second derivative of their energy, as in
/// materials/lps.hpp.
Eigen::SparseMatrix<double> dilatation_stiffness(const BodySetup& setup, const Lps& law) {
  const Lattice& lattice = setup.lattice;
  const auto columns = static_cast<Eigen::Index>(lattice.section.size());
  const double weighted_volume = law.weighted_volume(lattice.horizon);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd size(columns);
  for (std::size_t i = 0; i < lattice.section.size(); ++i) {
    const int row = static_cast<int>(i);
    size[row] = 2 * law.dilatation_energy(1) * setup.bond_constant * weighted_volume * lattice.volume(i);
    for (const Bond& bond : setup.families.of(i)) {
      for (int a = 0; a < 2; ++a) {
        const double value = 3 / weighted_volume * bond.weight *
                             lattice.volume(static_cast<std::size_t>(bond.other)) * bond.xi[a] / bond.length;
        entries.emplace_back(row, 2 * bond.other + a, value);
        entries.emplace_back(row, 2 * row + a, -value);
      }
    }
  }
  Eigen::SparseMatrix<double> dilatation(columns, 2 * columns);
  dilatation.setFromTriplets(entries.begin(), entries.end());
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

}  // namespace

double lame_displacement(const Parameters& p, double pressure, double r) {
  const double nu = p.law.poisson_ratio;
  const double inner2 = p.inner_radius * p.inner_radius, outer2 = p.outer_radius * p.outer_radius;
  return (1 + nu) / p.young_modulus * pressure * inner2 / (outer2 - inner2) * ((1 - 2 * nu) * r + outer2 / r);
}

ElasticError elastic_error(const Parameters& p, const BodySetup& setup) {
  const CrossSection& s = setup.lattice.section;
  Eigen::VectorXd load(static_cast<Eigen::Index>(2 * s.size()));
  for (std::size_t i = 0; i < s.size(); ++i) {
    load[static_cast<Eigen::Index>(2 * i)] = setup.lattice.volume(i) * setup.layer.bx[i];
    load[static_cast<Eigen::Index>(2 * i + 1)] = setup.lattice.volume(i) * setup.layer.by[i];
  }
  balance(s, load);
  Eigen::SparseMatrix<double> matrix = stiffness(setup);
  with_law(setup.law, [&]<class Law>(const Law& law) {
    if constexpr (Law::state_based) matrix += dilatation_stiffness(setup, law);
  });
  Eigen::ConjugateGradient<Eigen::SparseMatrix<double>, Eigen::Lower | Eigen::Upper> solver(matrix);
  solver.setTolerance(1e-8);
  Eigen::VectorXd u = solver.solve(load);
  if (solver.info() != Eigen::Success) throw RunError("the bonds do not hold the wall together");
  balance(s, u);

  double error = 0, size = 0, least = INFINITY, most = -INFINITY;
  for (std::size_t i = 0; i < s.size(); ++i) {
    const double r = std::hypot(s.x[i], s.y[i]);
    const auto row = static_cast<Eigen::Index>(2 * i);
    const double radial = (u[row] * s.x[i] + u[row + 1] * s.y[i]) / r;
    const double exact = lame_displacement(p, 1, r);
    error += s.area[i] * (radial - exact) * (radial - exact);
    size += s.area[i] * exact * exact;
    least = std::min(least, radial / exact);
    most = std::max(most, radial / exact);
  }
  return {std::sqrt(error / size), most / least - 1};
}

}  // namespace rhexis::peridynamics
