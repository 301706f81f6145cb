// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/geometry/particle_set.hpp"

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace rhexis::peridynamics {
namespace {

void add_particle(ParticleSet& set, const Vector3& place, double volume) {
  for (std::size_t k = 0; k < 3; ++k) set.position[k].push_back(place[k]);
  set.volume.push_back(volume);
}

}  // namespace

ParticleSet tube_particles(const Lattice& lattice) {
  const CrossSection& s = lattice.section;
  if (s.rings == 0) throw std::invalid_argument("tube_particles: the cross-section is not polar");
  ParticleSet set{.spacing = lattice.spacing};
  const auto rings = static_cast<std::size_t>(s.rings), per_ring = static_cast<std::size_t>(s.per_ring);
  const double angle = 2 * std::numbers::pi / static_cast<double>(per_ring), dz = lattice.row_spacing;
  double first = INFINITY, last = 0;  // radii of the innermost and outermost rings
  for (std::size_t c = 0; c < s.size(); ++c) {
    first = std::min(first, std::hypot(s.x[c], s.y[c]));
    last = std::max(last, std::hypot(s.x[c], s.y[c]));
  }
  const double half =
      rings > 1 ? 0.5 * (last - first) / static_cast<double>(rings - 1) : 0.5 * s.area[0] / (first * angle);
  for (std::size_t c = 0; c < s.size(); ++c) {
    const double r = std::hypot(s.x[c], s.y[c]), nx = s.x[c] / r, ny = s.y[c] / r;
    const bool innermost = r<first + half, outermost = r> last - half;
    for (std::int64_t row = 0; row < lattice.rows; ++row) {
      const std::size_t i = set.size();
      add_particle(set, {s.x[c], s.y[c], lattice.height(row)}, lattice.volume(c));
      set.frame.push_back({.radial = {static_cast<float>(nx), static_cast<float>(ny), 0},
                           .axial = {0, 0, 1},
                           .depth = static_cast<float>((r - first + half) / (last - first + 2 * half))});
      if (innermost) {
        const double area = (r - half) * angle * dz;
        set.surface.push_back({i, {-half * nx, -half * ny, 0}, {-area * nx, -area * ny, 0}, true});
      }
      if (outermost) {
        const double area = (r + half) * angle * dz;
        set.surface.push_back({i, {half * nx, half * ny, 0}, {area * nx, area * ny, 0}, false});
      }
      if (row == 0) set.surface.push_back({i, {0, 0, -dz / 2}, {0, 0, -s.area[c]}, false});
      if (row == lattice.rows - 1) set.surface.push_back({i, {0, 0, dz / 2}, {0, 0, s.area[c]}, false});
    }
  }
  return set;
}

ParticleSet box_particles(const std::array<std::size_t, 3>& count, double spacing) {
  ParticleSet set{.spacing = spacing};
  const double half = spacing / 2, area = spacing * spacing;
  std::array<std::size_t, 3> at{};
  for (at[0] = 0; at[0] < count[0]; ++at[0]) {
    for (at[1] = 0; at[1] < count[1]; ++at[1]) {
      for (at[2] = 0; at[2] < count[2]; ++at[2]) {
        const std::size_t i = set.size();
        Vector3 place;
        for (std::size_t k = 0; k < 3; ++k) {
          place[k] = (static_cast<double>(at[k]) + 0.5) * spacing;
          Vector3 offset{}, normal{};
          if (at[k] == 0) {
            offset[k] = -half, normal[k] = -area;
            set.surface.push_back({i, offset, normal, false});
          }
          if (at[k] == count[k] - 1) {
            offset[k] = half, normal[k] = area;
            set.surface.push_back({i, offset, normal, false});
          }
        }
        add_particle(set, place, spacing * area);
      }
    }
  }
  return set;
}

ParticleSet sphere_particles(double inner_radius, double outer_radius, std::size_t layers) {
  using std::numbers::pi;
  const double h = (outer_radius - inner_radius) / static_cast<double>(layers);
  ParticleSet set{.spacing = h};
  const double middle = 0.5 * (inner_radius + outer_radius);
  const auto points = static_cast<std::size_t>(std::lround(4 * pi * middle * middle / (h * h)));
  const double golden = pi * (1 + std::sqrt(5.0));
  std::vector<SurfacePatch> inside, outside;
  for (std::size_t layer = 0; layer < layers; ++layer) {
    const double below = inner_radius + static_cast<double>(layer) * h, above = below + h;
    const double volume =
        4 * pi / 3 * (std::pow(above, 3) - std::pow(below, 3)) / static_cast<double>(points);
    for (std::size_t p = 0; p < points; ++p) {
      const double z = 1 - (2 * static_cast<double>(p) + 1) / static_cast<double>(points);
      const double across = std::sqrt(1 - z * z), turn = golden * static_cast<double>(p);
      const Vector3 normal{across * std::cos(turn), across * std::sin(turn), z};
      const std::size_t i = set.size();
      const double r = below + h / 2;
      add_particle(set, {r * normal[0], r * normal[1], r * normal[2]}, volume);
      const auto single = [](double number) { return static_cast<float>(number); };
      set.frame.push_back(
          {.radial = {single(normal[0]), single(normal[1]), single(normal[2])},
           .axial = {single(-z * std::cos(turn)), single(-z * std::sin(turn)), single(across)},
           .depth = single((r - inner_radius) / (outer_radius - inner_radius))});
      const auto patch_at = [&](double surface, double side, bool loaded) {
        const double area = side * 4 * pi * surface * surface / static_cast<double>(points);
        SurfacePatch patch{i, {}, {}, loaded};
        for (std::size_t k = 0; k < 3; ++k) {
          patch.offset[k] = (surface - r) * normal[k];
          patch.area[k] = area * normal[k];
        }
        return patch;
      };
      if (layer == 0) inside.push_back(patch_at(inner_radius, -1, true));
      if (layer == layers - 1) outside.push_back(patch_at(outer_radius, 1, false));
    }
  }
  close_surface(set, inside, -4 * pi / 3 * std::pow(inner_radius, 3));
  close_surface(set, outside, 4 * pi / 3 * std::pow(outer_radius, 3));
  set.surface = std::move(inside);
  set.surface.insert(set.surface.end(), outside.begin(), outside.end());
  return set;
}

void close_surface(const ParticleSet& set, std::span<SurfacePatch> surface, double volume) {
  // A correction |area| (a + B x), x the place from the middle, whose sums fill what is missing.
  using Vector = Eigen::Vector3d;
  using Matrix = Eigen::Matrix3d;
  const auto vector = [](const Vector3& v) { return Vector(v[0], v[1], v[2]); };
  std::vector<Vector> place;
  std::vector<double> size;
  Vector middle = Vector::Zero();
  for (const SurfacePatch& patch : surface) {
    place.push_back(vector(set.at(patch.particle)) + vector(patch.offset));
    size.push_back(vector(patch.area).norm());
    middle += size.back() * place.back();
  }
  const double total = std::accumulate(size.begin(), size.end(), 0.0);
  middle /= total;
  Vector sum = Vector::Zero();
  Matrix moment = Matrix::Zero(), spread = Matrix::Zero();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    place[i] -= middle;
    sum += vector(surface[i].area);
    moment += vector(surface[i].area) * place[i].transpose();
    spread += size[i] * place[i] * place[i].transpose();
  }
  const Matrix turn = (volume * Matrix::Identity() - moment) * spread.inverse();
  for (std::size_t i = 0; i < surface.size(); ++i) {
    const Vector change = size[i] * (turn * place[i] - sum / total);
    for (int k = 0; k < 3; ++k) surface[i].area[static_cast<std::size_t>(k)] += change[k];
  }
}

ParticleSet reordered(const ParticleSet& set, const std::vector<std::size_t>& order) {
  ParticleSet result{.spacing = set.spacing};
  std::vector<std::size_t> place(set.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    add_particle(result, set.at(order[i]), set.volume[order[i]]);
    place[order[i]] = i;
    if (!set.frame.empty()) result.frame.push_back(set.frame[order[i]]);
  }
  result.surface = set.surface;
  for (SurfacePatch& patch : result.surface) patch.particle = place[patch.particle];
  return result;
}

}  // namespace rhexis::peridynamics
