// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/monitors/particle_source.hpp"

#include <stdexcept>

#include "parallel/communicator.hpp"
#include "parallel/threads.hpp"

namespace rhexis::peridynamics {
namespace {

constexpr FieldInfo fields_of_all_laws[] = {
    {"displacement", "m", 3},
    {"velocity", "m s-1", 3},
    {"force_density", "N m-3", 3},
    {"strain_energy_density", "J m-3", 1},
    {"damage", "1", 1},
};

template <class Components>
FieldView vector_view(const FieldInfo& info, const Components& c) {
  return {info, {c[0].data(), c[1].data(), c[2].data()}, c[0].size()};
}

FieldView scalar_view(const FieldInfo& info, const std::vector<double>& values) {
  return {info, {values.data(), nullptr, nullptr}, values.size()};
}

}  // namespace

std::span<const FieldInfo> ParticleSource::all_fields() {
  static const std::vector<FieldInfo> all = [] {
    std::vector<FieldInfo> fields(std::begin(fields_of_all_laws), std::end(fields_of_all_laws));
    fields.insert(fields.end(), stress_fields().begin(), stress_fields().end());
    return fields;
  }();
  return all;
}

std::span<const FieldInfo> ParticleSource::fields_of(bool law_by_gradient) {
  return law_by_gradient ? all_fields() : std::span<const FieldInfo>(fields_of_all_laws);
}

void ParticleSource::moment(long step, double time_s, const Observation& observation,
                            std::vector<Annotation> annotations) {
  step_ = step;
  time_ = time_s;
  observation_ = &observation;
  annotations_ = std::move(annotations);
  positions_valid_ = false;
  stress_valid_ = false;
}

/// Reference positions plus u(component, particle).
template <class Displacement>
FieldView ParticleSource::fill_positions(std::string_view name, const Displacement& u) {
  for (auto& component : positions_) component.resize(static_cast<std::size_t>(ids().local_count()));
  const auto fill = [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const auto x = body_->reference_position(i);
      for (std::size_t k = 0; k < 3; ++k) positions_[k][i] = x[k] + u(k, i);
    }
  };
  parallel::for_each_share(parallel::thread_count(), positions_[0].size(), fill);
  return vector_view({name, "m", 3}, positions_);
}

FieldView ParticleSource::positions() {
  const FieldInfo info{"position", "m", 3};
  if (positions_valid_) return vector_view(info, positions_);
  positions_valid_ = true;
  const auto u = body_->displacement();
  return fill_positions(info.name, [&](std::size_t k, std::size_t i) { return u[k][i]; });
}

FieldView ParticleSource::reference_positions() {
  positions_valid_ = false;
  return fill_positions("reference_position", [](std::size_t, std::size_t) { return 0.0; });
}

FieldView ParticleSource::field(std::string_view name) {
  const FieldInfo* info = nullptr;
  for (const FieldInfo& known : fields()) {
    if (known.name == name) info = &known;
  }
  if (!info) throw std::out_of_range("no field " + std::string(name));
  if (name == "displacement") return vector_view(*info, body_->displacement());
  if (name == "velocity") return vector_view(*info, observation_->velocity);
  if (name == "force_density") return vector_view(*info, observation_->force_density);
  if (name == "strain_energy_density") return scalar_view(*info, observation_->strain_energy_density);
  if (name == "damage") return scalar_view(*info, observation_->damage);
  if (!stress_valid_) stress_.evaluate(*body_);
  stress_valid_ = true;
  return scalar_view(*info, stress_.values(name));
}

}  // namespace rhexis::peridynamics
