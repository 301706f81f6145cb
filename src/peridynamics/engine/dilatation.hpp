// SPDX-License-Identifier: BSD-3-Clause
/// What a state-based law does before its forces can be summed: it finds the dilatation of each particle from
/// its family, and the pressure that follows from it (laws/lps.hpp).
#pragma once

#include <cstdint>
#include <vector>

#include "parallel/exact_sum.hpp"
#include "parallel/halo.hpp"
#include "parallel/threads.hpp"
#include "peridynamics/engine/bond_forces.hpp"
#include "peridynamics/engine/state_kernel.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
class Dilatation {
 public:
  Dilatation(const Law& law, const BodySetup& setup, const Domain& domain, parallel::Communicator comm)
      : law_(law),
        setup_(&setup),
        domain_(&domain),
        units_(setup.lattice, setup.bond_constant),
        weighted_volume_(Law::weighted_volume(setup.lattice.horizon / setup.lattice.spacing)),
        halo_(comm, domain.halo_messages(), 1),
        pressure_(domain.padded_size()),
        theta_(static_cast<std::size_t>(domain.layout().local_count())) {
    for (std::int32_t slot = 0; slot < domain.layout().column_count; ++slot) {
      for (std::int32_t block = 0; block < domain.blocks(); ++block) {
        const bool interior = domain.interior(static_cast<std::size_t>(slot), block);
        (interior ? interior_ : boundary_).push_back({slot, block});
      }
    }
  }

  /// Memory that this takes on all ranks.
  static double bytes(const BodySize& size) {
    return size.padded() * sizeof(Real) + size.particles() * sizeof(double) +
           size.blocks() * sizeof(RowBlock);
  }

  /// p of owned and halo particles, padded.
  const Real* pressure() const { return pressure_.data(); }
  const parallel::Traffic& traffic() const { return halo_.traffic(); }

  /// Dilatation energy (J/m3) of an owned particle, the `lane`-th of a block, as last found.
  double energy_density(RowBlock b, int lane, const PlaceProperties<Real>& properties) const {
    const auto row = static_cast<std::size_t>(lane);
    return energy_density(theta_[domain_->first_particle(b) + row],
                          properties.stiffness(domain_->padded(b) + row));
  }

  /// Fills the halo of the displacement, breaks bonds that are stretched too far, then finds dilatations and
  /// pressures. Collective.
  void find(const KernelInput<Real>& input, BondStorage<Real>& bonds, parallel::HaloExchange<Real>& halo,
            std::array<Real*, 3> displacement, std::vector<ThreadEvents>& per_thread) {
    const auto find_in = [&](const std::vector<RowBlock>& blocks) {
      parallel::for_each_share(static_cast<int>(per_thread.size()), blocks.size(),
                               [&](int thread, std::size_t begin, std::size_t end) {
                                 for (std::size_t i = begin; i < end; ++i)
                                   find_in_block(blocks[i], input, bonds,
                                                 per_thread[static_cast<std::size_t>(thread)]);
                               });
    };
    // The halo travels while blocks that do not need it are done.
    halo.start(displacement);
    find_in(interior_);
    halo.finish(displacement);
    find_in(boundary_);
    Real* const pressure = pressure_.data();
    halo_.start({&pressure, 1});
    halo_.finish({&pressure, 1});
  }

 private:
  double energy_density(double theta, double stiffness) const {
    return units_.energy_density() * stiffness * weighted_volume_ * law_.dilatation_energy(theta);
  }

  void find_in_block(RowBlock b, const KernelInput<Real>& input, BondStorage<Real>& bonds,
                     ThreadEvents& events) {
    ExtensionSums<Real> sums;
    const BlockView<Real> view = input.view(b.slot, b.block * block_rows, bonds.words(b));
    input.choose_kernel(
        [&]<bool heterogeneous, bool wrapped>() { sum_extensions<heterogeneous, wrapped>(view, sums); });
    events.note_broken(b, sums.broken, bonds);

    const std::size_t column = domain_->global_column(b.slot);
    const double per_extension = 3 / (weighted_volume_ * units_.relative_volume(column));
    double released = 0;
    for (int lane = 0; lane < domain_->rows_in(b.block); ++lane) {
      const auto row = static_cast<std::size_t>(lane);
      const std::size_t place = domain_->padded(b) + row;
      const double stiffness = input.properties.stiffness(place);
      const double theta = per_extension * double{sums.intact[lane]};
      theta_[domain_->first_particle(b) + row] = theta;
      pressure_[place] = static_cast<Real>(0.5 * law_.kappa() * stiffness * theta);
      if (sums.broken > 0) {
        const double before = theta + per_extension * double{sums.lost[lane]};
        released += energy_density(before, stiffness) - energy_density(theta, stiffness);
      }
    }
    events.released.add(setup_->lattice.volume(column) * released);
  }

  Law law_;
  const BodySetup* setup_;
  const Domain* domain_;
  KernelUnits units_;
  double weighted_volume_;                     ///< m of a whole family, in spacings^4
  parallel::HaloExchange<Real> halo_;          ///< exchanges the pressure
  std::vector<Real> pressure_;                 ///< p, padded
  std::vector<double> theta_;                  ///< [owned particles]
  std::vector<RowBlock> interior_, boundary_;  ///< blocks that read no halo, and those that do
};

}  // namespace rhexis::peridynamics
