// SPDX-License-Identifier: BSD-3-Clause
/// A vessel that bulges and opens by formula: the paper's tube without a solver. Counts what it is asked for.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/field_view.hpp"

namespace rhexis::test {

/// A tube, 10 mm long, radii 1.5 and 2 mm, at 0.1 mm spacing (548 columns x 100 rows), cut into blocks of
/// rows.
class SyntheticVessel : public PointSource {
 public:
  static constexpr double spacing = 1e-4;
  static constexpr int rows = 100;

  SyntheticVessel(int rank, int ranks) {
    for (int i = -20; i < 20; ++i) {
      for (int j = -20; j < 20; ++j) {
        const double x = (i + 0.5) * spacing, y = (j + 0.5) * spacing;
        const double radius = std::hypot(x, y);
        if (radius >= 1.5e-3 && radius <= 2e-3) columns_.push_back({x, y});
      }
    }
    first_row_ = rows * rank / ranks;
    row_count_ = rows * (rank + 1) / ranks - first_row_;
    ids_.global_count = static_cast<std::int64_t>(columns_.size()) * rows;
    for (std::size_t column = 0; column < columns_.size(); ++column)
      ids_.add({static_cast<std::int64_t>(column) * rows + first_row_, row_count_});
  }

  /// Moves on; `progress` runs from 0 (at rest) to 1 (torn open).
  void advance(long step, double progress) {
    step_ = step;
    progress_ = progress;
    memory_.clear();
  }

  long step() const override { return step_; }
  double time_s() const override { return 2.5e-3 * progress_; }
  const IdRanges& ids() const override { return ids_; }
  std::span<const FieldInfo> fields() const override { return field_infos; }
  std::vector<Annotation> annotations() const override { return {{"pressure", "Pa", 238e3}}; }

  FieldView positions() override {
    return view({"position", "m", 3},
                [this](const Particle& p, int c) { return p.reference[index(c)] + move(p)[index(c)]; });
  }

  FieldView field(std::string_view name) override {
    for (const FieldInfo& info : field_infos) {
      if (info.name != name) continue;
      ++asked[std::string(name)];
      return view(info, [this, name](const Particle& p, int c) { return value(name, p, c); });
    }
    throw std::out_of_range(std::string(name));
  }

  std::map<std::string, int> asked;  ///< calls of `field` by name

 private:
  struct Particle {
    std::array<double, 3> reference;
    double opening;  ///< 0 far from the slit ... 1 on its edge
  };

  static constexpr FieldInfo field_infos[] = {{"displacement", "m", 3},
                                              {"velocity", "m/s", 3},
                                              {"force_density", "N/m3", 3},
                                              {"damage", "1", 1},
                                              {"strain_energy_density", "J/m3", 1}};

  static std::size_t index(int component) { return static_cast<std::size_t>(component); }

  template <class Value>
  FieldView view(const FieldInfo& info, Value value_of) {
    FieldView result{info, {}, static_cast<std::size_t>(ids_.local_count())};
    for (int c = 0; c < info.components; ++c) {
      auto& values = memory_[std::string(info.name) + std::to_string(c)];
      values.reserve(result.count);
      for (std::size_t column = 0; column < columns_.size(); ++column) {
        for (std::int64_t row = 0; row < row_count_; ++row) {
          values.push_back(value_of(particle(column, first_row_ + row), c));
        }
      }
      result.component[index(c)] = values.data();
    }
    return result;
  }

  Particle particle(std::size_t column, std::int64_t row) const {
    const auto [x, y] = columns_[column];
    const double z = (static_cast<double>(row) + 0.5) * spacing;
    const double half_length = 4e-3 * std::max(0.0, progress_ - 0.3);
    const double along = (z - 5e-3) / std::max(half_length, 1e-6);
    const double around = std::atan2(y, x) / 0.35;
    const double opening = std::abs(along) < 1 ? std::exp(-around * around) * (1 - along * along) : 0;
    return {{x, y, z}, opening};
  }

  /// A bulge, and lips that part at y = 0 on the side of +x.
  std::array<double, 3> move(const Particle& p) const {
    const auto [x, y, z] = p.reference;
    const double radius = std::hypot(x, y);
    const double bulge = 4e-4 * progress_ * std::exp(-std::pow((z - 5e-3) / 2.5e-3, 2));
    const double part = 1.4e-3 * progress_ * p.opening;
    const double side = y < 0 ? -1 : 1;
    return {bulge * x / radius + 0.5 * part * x / radius, bulge * y / radius + part * side, 0};
  }

  double value(std::string_view name, const Particle& p, int component) const {
    if (name == "displacement") return move(p)[index(component)];
    if (name == "damage") return 0.5 * p.opening * p.opening;
    return progress_ * p.reference[index(component)];
  }

  std::vector<std::array<double, 2>> columns_;
  std::int64_t first_row_, row_count_;
  IdRanges ids_;
  long step_ = 0;
  double progress_ = 0;
  std::map<std::string, std::vector<double>> memory_;
};

}  // namespace rhexis::test
