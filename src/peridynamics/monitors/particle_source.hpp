// SPDX-License-Identifier: BSD-3-Clause
/// A body's particles as observers see them: fields with names and units, evaluated when first asked for.
#pragma once

#include <optional>

#include "core/field_view.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/monitors/stress_fields.hpp"

namespace rhexis::peridynamics {

/// Fields: displacement, velocity, force_density (vectors), strain_energy_density, damage (scalars), which
/// are the solver's own memory; and those of stress_fields, where the law is one by gradient. Only these and
/// positions are computed here.
class ParticleSource final : public PointSource {
 public:
  explicit ParticleSource(Body& body) : body_(&body) {}

  /// Memory that this takes on all ranks: the positions; and the stress, of a law by gradient.
  static double bytes(double particles, bool law_by_gradient) {
    return 3 * particles * sizeof(double) + (law_by_gradient ? StressFields::bytes(particles) : 0);
  }

  /// A new moment: `observation` holds its fields (see Body::observe).
  void moment(long step, double time_s, const Observation& observation, std::vector<Annotation> annotations);

  long step() const override { return step_; }
  double time_s() const override { return time_; }
  const IdRanges& ids() const override { return body_->ids(); }
  std::span<const FieldInfo> fields() const override { return fields_of(body_->has_wall_deformation()); }
  FieldView positions() override;
  /// Positions of the body at rest; valid until `positions` or the next moment.
  FieldView reference_positions();
  FieldView field(std::string_view name) override;
  std::vector<Annotation> annotations() const override { return annotations_; }

  /// The fields of any law, and those of a law that is one by gradient or of bonds.
  static std::span<const FieldInfo> all_fields();
  static std::span<const FieldInfo> fields_of(bool law_by_gradient);

 private:
  Body* body_;
  long step_ = 0;
  double time_ = 0;
  const Observation* observation_ = nullptr;
  std::vector<Annotation> annotations_;
  std::array<std::vector<double>, 3> positions_;
  bool positions_valid_ = false;
  StressFields stress_;
  bool stress_valid_ = false;

  template <class Displacement>
  FieldView fill_positions(std::string_view name, const Displacement& u);
};

}  // namespace rhexis::peridynamics
