// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/monitors/stress_fields.hpp"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <stdexcept>
#include <string>

#include "parallel/threads.hpp"
#include "peridynamics/laws/correspondence/wall_deformation.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr std::array known_fields = {
    FieldInfo{"hoop_stress", "Pa", 1},
    FieldInfo{"axial_stress", "Pa", 1},
    FieldInfo{"radial_stress", "Pa", 1},
    FieldInfo{"von_mises_stress", "Pa", 1},
    FieldInfo{"largest_principal_stress", "Pa", 1},
    FieldInfo{"hoop_stretch", "1", 1},
    FieldInfo{"axial_stretch", "1", 1},
    FieldInfo{"radial_stretch", "1", 1},
    FieldInfo{"volume_ratio", "1", 1},
    FieldInfo{"fibre_stretch", "1", 1},
};

Eigen::Matrix3d matrix(const Tensor<double>& t) {
  Eigen::Matrix3d m;
  m << t.xx, t.xy, t.xz, t.yx, t.yy, t.yz, t.zx, t.zy, t.zz;
  return m;
}

/// In the order of known_fields.
std::array<double, known_fields.size()> fields_of(const WallDeformation& wall) {
  using Vector = Eigen::Vector3d;
  const Eigen::Matrix3d f = Eigen::Matrix3d::Identity() + matrix(wall.gradient), p = matrix(wall.stress);
  const double j = f.determinant();
  const Eigen::Matrix3d sigma = p * f.transpose() / j;
  const auto vector = [](const std::array<double, 3>& v) { return Vector(v[0], v[1], v[2]); };
  const Vector hoop = f * vector(wall.hoop), axial = f * vector(wall.axial), normal = hoop.cross(axial);
  const auto along = [&](const Vector& v) { return v.dot(sigma * v) / v.squaredNorm(); };
  const Eigen::Matrix3d symmetric = 0.5 * (sigma + sigma.transpose());
  const Vector principal =
      Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(symmetric, Eigen::EigenvaluesOnly).eigenvalues();
  const Vector apart(principal[0] - principal[1], principal[1] - principal[2], principal[2] - principal[0]);
  return {along(hoop),
          along(axial),
          along(normal),
          std::sqrt(0.5) * apart.norm(),
          principal[2],
          hoop.norm(),
          axial.norm(),
          j / normal.norm(),
          j,
          wall.fibre_stretch};
}

}  // namespace

std::span<const FieldInfo> stress_fields() {
  return known_fields;
}

double StressFields::bytes(double particles) {
  return static_cast<double>(known_fields.size()) * particles * sizeof(double);
}

void StressFields::evaluate(const Body& body) {
  const std::size_t particles = body.displacement()[0].size();
  values_.resize(known_fields.size());
  for (std::vector<double>& field : values_) field.resize(particles);
  parallel::for_each_share(parallel::thread_count(), particles, [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto fields = fields_of(body.wall_deformation(i));
      for (std::size_t k = 0; k < fields.size(); ++k) values_[k][i] = fields[k];
    }
  });
}

const std::vector<double>& StressFields::values(std::string_view name) const {
  for (std::size_t k = 0; k < known_fields.size(); ++k) {
    if (known_fields[k].name == name) return values_[k];
  }
  throw std::out_of_range("no field " + std::string(name));
}

}  // namespace rhexis::peridynamics
