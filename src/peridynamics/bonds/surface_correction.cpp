// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/bonds/surface_correction.hpp"

#include <Eigen/Dense>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace rhexis::peridynamics {
namespace {

/// Unit vector along a bond: radial, hoop and axial component in the frame of the wall at `angle`.
std::array<double, 3> direction(const Bond& bond, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {(c * bond.xi[0] + s * bond.xi[1]) / bond.length, (c * bond.xi[1] - s * bond.xi[0]) / bond.length,
          bond.xi[2] / bond.length};
}

/// V_j |xi|, what a bond counts for in sums of energy; m4.
double energy_size(const Lattice& lattice, const Bond& bond) {
  return lattice.volume(static_cast<std::size_t>(bond.other)) * bond.length * lattice.spacing;
}

double angle_of(const CrossSection& s, std::size_t column) {
  return std::atan2(s.y[column], s.x[column]);
}

template <class Weight>
void set_weights(BondFamilies& families, const Weight& weight) {
  for (std::size_t i = 0; i + 1 < families.first.size(); ++i) {
    for (std::int64_t b = families.first[i]; b < families.first[i + 1]; ++b) {
      Bond& bond = families.bonds[static_cast<std::size_t>(b)];
      const auto j = static_cast<std::size_t>(bond.other);
      // The same digits from both ends.
      bond.weight = i < j ? weight(i, j, bond) : weight(j, i, bond);
    }
  }
}

void correct_volume(const Lattice& lattice, BondFamilies& families) {
  const std::size_t columns = lattice.section.size();
  const double horizon3 = std::pow(lattice.horizon, 3);
  std::vector<double> share(columns);  // of a whole family's volume
  for (std::size_t i = 0; i < columns; ++i) {
    for (const Bond& bond : families.of(i)) share[i] += lattice.volume(static_cast<std::size_t>(bond.other));
    share[i] /= 4.0 / 3.0 * std::numbers::pi * horizon3;
  }
  set_weights(families, [&](std::size_t i, std::size_t j, const Bond&) { return 2 / (share[i] + share[j]); });
}

/// The component n_r n_r n_h n_h of the integral of V n n n n |xi| over a whole family, in m4, for unit bond
/// constant; the component n_r^4 is three times as large.
double whole_moment(double horizon) {
  return std::numbers::pi * std::pow(horizon, 4) / 15;
}

void correct_energy(const Lattice& lattice, BondFamilies& families) {
  const CrossSection& s = lattice.section;
  std::vector<std::array<double, 3>> lack(s.size());  // energy of a whole family / that of this one
  for (std::size_t i = 0; i < s.size(); ++i) {
    std::array<double, 3> moment{};
    for (const Bond& bond : families.of(i)) {
      const std::array<double, 3> n = direction(bond, angle_of(s, i));
      for (std::size_t k = 0; k < 3; ++k) moment[k] += energy_size(lattice, bond) * std::pow(n[k], 4);
    }
    for (std::size_t k = 0; k < 3; ++k) lack[i][k] = 3 * whole_moment(lattice.horizon) / moment[k];
  }
  set_weights(families, [&](std::size_t i, std::size_t j, const Bond& bond) {
    const std::array<double, 3> n = direction(bond, std::atan2(s.y[i] + s.y[j], s.x[i] + s.x[j]));
    double sum = 0;
    for (std::size_t k = 0; k < 3; ++k) sum += std::pow(2 * n[k] / (lack[i][k] + lack[j][k]), 2);
    return 1 / std::sqrt(sum);
  });
}

/// Components of the fourth moment that symmetry leaves, powers of n along (radial, hoop, axial), and what a
/// whole family has, in units of `whole_moment`.
struct Component {
  int power[3];
  double whole;
};
constexpr Component components[] = {{{4, 0, 0}, 3}, {{0, 4, 0}, 3}, {{0, 0, 4}, 3},
                                    {{2, 2, 0}, 1}, {{2, 0, 2}, 1}, {{0, 2, 2}, 1}};
constexpr int component_count = static_cast<int>(std::size(components));

double value(const Component& component, const std::array<double, 3>& n) {
  double product = 1;
  for (std::size_t k = 0; k < 3; ++k) product *= std::pow(n[k], component.power[k]);
  return product;
}

/// Linear conditions A w = b on the weights w of bond classes, each with the compliance of its bond.
struct Conditions {
  Eigen::SparseMatrix<double> a;
  Eigen::VectorXd b;
  Eigen::VectorXd softness;
};

/// Minimises sum_k count_k (w_k - 1)^2 / 2 + sum_q (A w - b)_q^2 / (2 softness_q) over w >= least_weight, by
/// Newton's method on the dual problem, which is concave and piecewise quadratic: w is then
/// max(least_weight, 1 + A^T multipliers / count).
Eigen::VectorXd least_change(const Conditions& c, const Eigen::VectorXd& count) {
  const Eigen::VectorXd compliance = count.cwiseInverse();
  Eigen::VectorXd multipliers = Eigen::VectorXd::Zero(c.b.size());
  const auto weights = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd free = compliance.cwiseProduct(c.a.transpose() * at).array() + 1;
    return Eigen::VectorXd(free.cwiseMax(least_weight));
  };
  const auto dual = [&](const Eigen::VectorXd& at) {
    const Eigen::VectorXd w = weights(at);
    return at.dot(c.b - c.a * w) + 0.5 * (w.array() - 1).square().matrix().dot(count) -
           0.5 * at.cwiseAbs2().dot(c.softness);
  };
  constexpr int most_iterations = 50;
  for (int iteration = 0; iteration < most_iterations; ++iteration) {
    const Eigen::VectorXd w = weights(multipliers);
    const Eigen::VectorXd slope = c.b - c.a * w - c.softness.cwiseProduct(multipliers);
    if (slope.lpNorm<Eigen::Infinity>() < 1e-10) break;
    const Eigen::VectorXd moving = (w.array() > least_weight).select(compliance, 0.0);
    Eigen::MatrixXd curvature = c.a * moving.asDiagonal() * c.a.transpose();
    curvature.diagonal() += c.softness;
    const Eigen::VectorXd step = curvature.ldlt().solve(slope);
    const double here = dual(multipliers), rise = slope.dot(step);
    double length = 1;
    while (length > 1e-6 && dual(multipliers + length * step) < here + 1e-4 * length * rise) length /= 2;
    multipliers += length * step;
  }
  return weights(multipliers);
}

/// Bonds that the symmetries of a polar cross-section make alike.
class BondClasses {
 public:
  BondClasses(const Parameters& p, const Lattice& lattice, const BondFamilies& families)
      : section_(&lattice.section),
        inner_radius_(p.inner_radius),
        thickness_((p.outer_radius - p.inner_radius) / lattice.section.rings) {
    for (std::size_t i = 0; i < section_->size(); ++i) {
      for (const Bond& bond : families.of(i)) numbers_.try_emplace(key(i, bond), 0);
    }
    int next = 0;
    for (auto& [key, number] : numbers_) number = next++;
  }

  int count() const { return static_cast<int>(numbers_.size()); }
  int of(std::size_t column, const Bond& bond) const { return numbers_.at(key(column, bond)); }
  int ring(std::size_t column) const {
    return static_cast<int>((std::hypot(section_->x[column], section_->y[column]) - inner_radius_) /
                            thickness_);
  }

 private:
  using Key = std::array<int, 4>;  ///< ring, ring, steps around, rows apart

  Key key(std::size_t i, const Bond& bond) const {
    const auto j = static_cast<std::size_t>(bond.other);
    const double turn = (angle_of(*section_, i) - angle_of(*section_, j)) / (2 * std::numbers::pi);
    const int apart = std::abs(static_cast<int>(std::lround(turn * section_->per_ring)));
    const auto [low, high] = std::minmax({ring(i), ring(j)});
    return {low, high, std::min(apart, section_->per_ring - apart), std::abs(bond.row_offset)};
  }

  const CrossSection* section_;
  double inner_radius_, thickness_;
  std::map<Key, int> numbers_;
};

void calibrate(const Parameters& p, const Lattice& lattice, BondFamilies& families) {
  // A ring may miss its energies by about as much as its bonds' weights change; the whole wall may not.
  constexpr double ring_softness = 0.1, wall_softness = 1e-9;
  const CrossSection& s = lattice.section;
  const BondClasses classes(p, lattice, families);
  const int rings = s.rings;

  Conditions conditions;
  const int rows = component_count * (rings + 1);
  conditions.a.resize(rows, classes.count());
  conditions.b.resize(rows);
  conditions.softness.resize(rows);
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::VectorXd count = Eigen::VectorXd::Zero(classes.count());
  const double wall_area =
      std::numbers::pi * (p.outer_radius * p.outer_radius - p.inner_radius * p.inner_radius) / s.per_ring;
  std::vector<bool> done(static_cast<std::size_t>(rings));
  for (std::size_t i = 0; i < s.size(); ++i) {
    const int ring = classes.ring(i);
    if (done[static_cast<std::size_t>(ring)]) continue;  // all columns of a ring have the same families
    done[static_cast<std::size_t>(ring)] = true;
    for (const Bond& bond : families.of(i)) {
      const int k = classes.of(i, bond);
      const std::array<double, 3> n = direction(bond, angle_of(s, i));
      const double size = energy_size(lattice, bond) / whole_moment(lattice.horizon);
      count[k] += 1;
      for (int q = 0; q < component_count; ++q) {
        const double moment = size * value(components[q], n);
        entries.emplace_back(component_count * ring + q, k, moment);
        entries.emplace_back(component_count * rings + q, k, moment * s.area[i] / wall_area);
      }
    }
  }
  conditions.a.setFromTriplets(entries.begin(), entries.end());
  for (int row = 0; row < rows; ++row) {
    conditions.b[row] = components[row % component_count].whole;
    conditions.softness[row] = row < component_count * rings ? ring_softness : wall_softness;
  }
  const Eigen::VectorXd weights = least_change(conditions, count);
  for (std::size_t i = 0; i < s.size(); ++i) {
    for (Bond& bond : families.of(i)) bond.weight = weights[classes.of(i, bond)];
  }
}

}  // namespace

SurfaceCorrection surface_correction(const Parameters& p) {
  if (p.surface_correction != SurfaceCorrection::automatic) return p.surface_correction;
  return p.cross_section == Arrangement::polar ? SurfaceCorrection::calibrated : SurfaceCorrection::none;
}

BondFamilies weighted_families(const Parameters& p, const Lattice& lattice) {
  BondFamilies families = find_families(lattice);
  const SurfaceCorrection correction = surface_correction(p);
  if (correction == SurfaceCorrection::volume) correct_volume(lattice, families);
  if (correction == SurfaceCorrection::energy) correct_energy(lattice, families);
  if (correction == SurfaceCorrection::calibrated) calibrate(p, lattice, families);
  return families;
}

SharedFamilies shared_families(const Parameters& p, const Lattice& lattice) {
  return std::make_shared<const BondFamilies>(weighted_families(p, lattice));
}

double weighting_bytes(const Parameters& p, const WallSize& size) {
  if (surface_correction(p) != SurfaceCorrection::calibrated) return 0;
  const double conditions = 6 * (size.rings + 1);
  constexpr double entries = 12, entry_bytes = 40;  // of a bond in the conditions
  return 3 * conditions * conditions * sizeof(double) +
         size.bonds_of_column() * size.rings * entries * entry_bytes;
}

}  // namespace rhexis::peridynamics
