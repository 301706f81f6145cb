// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/stability/bond_step.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

namespace rhexis::peridynamics {

double stable_bond_step(const Lattice& lattice, const BondFamilies& families, double bond_constant,
                        double density, double critical_stretch) {
  double stiffest = 0;  // lambda_i / c, m2
  for (std::size_t c = 0; c < lattice.section.size(); ++c) {
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    for (const Bond& bond : families.of(c)) {
      const Eigen::Vector3d n = Eigen::Vector3d(bond.xi[0], bond.xi[1], bond.xi[2]) / bond.length;
      sum += bond.weight * lattice.volume(bond.other) / (bond.length * lattice.spacing) * n * n.transpose();
    }
    const double largest = sum.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
    stiffest = std::max(stiffest, std::min((1 + critical_stretch) * largest, sum.trace()));
  }
  return std::sqrt(2 * density / (bond_constant * stiffest));
}

}  // namespace rhexis::peridynamics
