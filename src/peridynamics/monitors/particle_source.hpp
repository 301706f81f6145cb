// SPDX-License-Identifier: BSD-3-Clause
/// A body's particles as observers see them: fields with names and units, evaluated when first asked for.
#pragma once

#include <optional>

#include "core/field_view.hpp"
#include "peridynamics/engine/body.hpp"

namespace rhexis::peridynamics {

/// Fields: displacement, velocity, force_density (vectors), strain_energy_density, damage (scalars).
/// Displacement, velocity, force density, energy density and damage are the solver's own memory; only
/// positions are computed here.
class ParticleSource final : public PointSource {
 public:
  explicit ParticleSource(Body& body) : body_(&body) {}

  /// Memory that this takes on all ranks: the positions.
  static double bytes(double particles) { return 3 * particles * sizeof(double); }

  /// A new moment: `observation` holds its fields (see Body::observe).
  void moment(long step, double time_s, const Observation& observation, std::vector<Annotation> annotations);

  long step() const override { return step_; }
  double time_s() const override { return time_; }
  const IdRanges& ids() const override { return body_->ids(); }
  std::span<const FieldInfo> fields() const override { return all_fields(); }
  FieldView positions() override;
  /// Positions of the body at rest; valid until `positions` or the next moment.
  FieldView reference_positions();
  FieldView field(std::string_view name) override;
  std::vector<Annotation> annotations() const override { return annotations_; }

  static std::span<const FieldInfo> all_fields();

 private:
  Body* body_;
  long step_ = 0;
  double time_ = 0;
  const Observation* observation_ = nullptr;
  std::vector<Annotation> annotations_;
  std::array<std::vector<double>, 3> positions_;
  bool positions_valid_ = false;

  template <class Displacement>
  FieldView fill_positions(std::string_view name, const Displacement& u);
};

}  // namespace rhexis::peridynamics
