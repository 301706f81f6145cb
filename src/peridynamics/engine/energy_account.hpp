// SPDX-License-Identifier: BSD-3-Clause
/// Energies of a body: what it took to break its bonds, the work done on it, and the sums of what was
/// observed.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

#include "parallel/exact_sum.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/bond_storage.hpp"

namespace rhexis::peridynamics {

using parallel::ExactSum;

/// What a thread gathers while it observes; in cache lines of its own, which are fetched in pairs.
struct alignas(128) ObservedSums {
  explicit ObservedSums(double energy_scale)
      : kinetic(energy_scale), strain(energy_scale), fracture(energy_scale), half_step_work(energy_scale) {}

  ExactSum kinetic, strain, fracture;  ///< J
  ExactSum half_step_work;             ///< J, that the account of work does not hold yet
  double max_damage = 0;
  std::int64_t ruptured_first = INT64_MAX, ruptured_last = -1;  ///< rows of the whole body

  void add(const ObservedSums& other) {
    kinetic.add(other.kinetic);
    strain.add(other.strain);
    fracture.add(other.fracture);
    half_step_work.add(other.half_step_work);
    max_damage = std::max(max_damage, other.max_damage);
    ruptured_first = std::min(ruptured_first, other.ruptured_first);
    ruptured_last = std::max(ruptured_last, other.ruptured_last);
  }
};

/// Energy of fracture, block by block. A bond's energy is shared equally between its ends.
template <class Law, class Real>
class FractureEnergy {
 public:
  /// Keeps pointers to `bonds` and `properties`.
  FractureEnergy(const Law& law, const BodySetup& setup, const Domain& domain, const BondStorage<Real>& bonds,
                 const PlaceProperties<Real>& properties)
      : law_(law),
        critical_stretch_(setup.critical_stretch),
        domain_(&domain),
        bonds_(&bonds),
        properties_(&properties),
        found_(static_cast<std::size_t>(domain.layout().column_count * domain.blocks())) {
    const KernelUnits units(setup.lattice, setup.bond_constant);
    per_weight_ = 0.25 * units.energy_density() * critical_stretch_ * critical_stretch_ * units.volume();
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) { return size.blocks() * sizeof(double); }

  /// J, the block's half of what its broken bonds took: c s0^2 |xi| V_i V_j / 2 each (PMB).
  double of(RowBlock b) const { return found_[domain_->number(b)]; }

  /// Finds it anew, once bonds of the block broke.
  void find(RowBlock b) {
    const auto constants = bonds_->bonds(b.slot);
    double sum = 0;
    for (std::size_t bond = 0; bond < constants.size(); ++bond) {
      if (const std::uint16_t rows = bonds_->broken(b, bond); rows != 0)
        sum += relative_energy(b, constants[bond], rows) * double{constants[bond].energy_weight};
    }
    found_[domain_->number(b)] = per_weight_ * sum;
  }

 private:
  /// What it took to break a bond in the rows of `broken`, relative to one bond of a uniform PMB wall.
  double relative_energy(RowBlock b, const BondConstants<Real>& bond, std::uint16_t broken) const {
    if (properties_->uniform()) return std::popcount(broken) * law_.energy_ratio(critical_stretch_);
    const std::size_t here = domain_->padded(b),
                      there = here + static_cast<std::size_t>(std::int64_t{bond.offset});
    double energy = 0;
    for (unsigned rows = broken; rows != 0; rows &= rows - 1) {
      const auto row = static_cast<std::size_t>(std::countr_zero(rows));
      const double s = properties_->bond_stretch(here + row, there + row);
      const double in_uniform = s / critical_stretch_;
      energy += in_uniform * in_uniform * law_.energy_ratio(s) *
                properties_->bond_stiffness(here + row, there + row);
    }
    return energy;
  }

  Law law_;
  double critical_stretch_, per_weight_ = 0;
  const Domain* domain_;
  const BondStorage<Real>* bonds_;
  const PlaceProperties<Real>* properties_;
  std::vector<double> found_;  ///< J, [blocks]
};

/// Sums over time: the work done on the body, and what fracture released besides.
class WorkAccount {
 public:
  explicit WorkAccount(double energy_scale) : scale_(energy_scale), work_(scale_), released_(scale_) {}

  void add_work(const ExactSum& work) { work_.add(work); }
  void add_released(const ExactSum& energy) { released_.add(energy); }

  /// J, over all ranks. Collective.
  double work(const parallel::Communicator& comm) const { return work_.value(comm); }
  double released(const parallel::Communicator& comm) const { return released_.value(comm); }

  /// What sums may have lost, J: a quantum of 2^-80 for each of 2^40 terms.
  double lost() const { return std::ldexp(scale_, -40); }

  using Parts = std::array<double, 2>;  ///< as ExactSum::parts
  Parts work_parts(const parallel::Communicator& comm) const { return work_.parts(comm); }
  Parts released_parts(const parallel::Communicator& comm) const { return released_.parts(comm); }
  void restore(const Parts& work, const Parts& released, const parallel::Communicator& comm) {
    work_ = restored(work, comm);
    released_ = restored(released, comm);
  }

 private:
  ExactSum restored(const Parts& parts, const parallel::Communicator& comm) const {
    ExactSum sum(scale_);
    for (const double part : parts) sum.add(comm.is_root() ? part : 0.0);
    return sum;
  }

  double scale_;  ///< J
  ExactSum work_, released_;
};

}  // namespace rhexis::peridynamics
