// SPDX-License-Identifier: BSD-3-Clause
/// The one implementation of Body: an extruded tube of columns, with bond laws.
///
/// Its parts: which particles are here (Domain), properties by place (PlaceProperties), bonds (BondStorage),
/// the displacement that bonds read (BondDisplacement), the pressure (PressureLoad, and FollowerPressure
/// where it follows the wall), forces by subdomains of threads (BondForces), a state-based law's dilatations
/// (Dilatation), energies (FractureEnergy, WorkAccount). What is left here is the state, and its course: a
/// step in time (column_body_step.hpp), observation (column_body_observe.hpp), and restarts
/// (column_body_restart.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "parallel/partition.hpp"
#include "parallel/threads.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/bond_forces.hpp"
#include "peridynamics/engine/dilatation.hpp"
#include "peridynamics/engine/energy_account.hpp"
#include "peridynamics/engine/follower_pressure.hpp"
#include "peridynamics/engine/pressure_load.hpp"

namespace rhexis::peridynamics {

/// Steps between looks at how far the body has moved as a whole.
inline constexpr long frame_interval = 64;

/// What drives a step in time.
struct StepLoad {
  double pressure, work_pressure;  ///< Pa, at t_n and the mean over the step
  double kick;                     ///< s, by which velocities lag behind
  double fastest;                  ///< m/s, see ColumnBody::load_speed_
};

template <class Law, class Real>
class ColumnBody final : public Body {
  using Subdomain = ThreadSubdomain<Real>;

 public:
  ColumnBody(Law law, BodySetup setup, parallel::Communicator comm)
      : setup_(std::move(setup)),
        comm_(comm),
        threads_(parallel::thread_count()),
        domain_(checked_domain(setup_, comm)),
        ids_(domain_.layout().ids()),
        units_(setup_.lattice, setup_.bond_constant),
        load_(setup_, domain_, comm),
        properties_(setup_, domain_, threads_),
        follower_(setup_, domain_, threads_),
        bonds_(domain_, *setup_.families, units_, properties_),
        displacement_(domain_, setup_.lattice.spacing),
        halo_(comm, domain_.halo_messages(), 3),
        work_(setup_.energy_scale),
        fracture_(law, setup_, domain_, bonds_, properties_) {
    if constexpr (Law::state_based) dilatation_.emplace(law, setup_, domain_, comm);
    kernel_input_.emplace(KernelInput<Real>{domain_, bonds_, properties_, displacement_,
                                            static_cast<Real>(t_of_stretch(setup_.critical_stretch)),
                                            dilatation_pressure()});
    forces_.emplace(law, *kernel_input_, bonds_, *setup_.families, threads_);
    for (int k = 0; k < 3; ++k) {
      free_rows_.push_back(peridynamics::free_rows(setup_, k));
      u_[k].assign(particles(), 0.0);
      v_[k].assign(particles(), 0.0);
    }
  }

  /// Memory that such a body takes on all ranks, without its families and before it is observed.
  static double bytes(const BodySize& size) {
    const double dilatation = Law::state_based ? Dilatation<Law, Real>::bytes(size) : 0;
    return 6 * size.particles() * sizeof(double) + Domain::bytes(size) + PressureLoad::bytes(size) +
           FollowerPressure<Real>::bytes(size) + PlaceProperties<Real>::bytes(size) +
           BondStorage<Real>::bytes(size) + BondDisplacement<Real>::bytes(size) + Subdomain::bytes(size) +
           FractureEnergy<Law, Real>::bytes(size) + dilatation;
  }

  const IdRanges& ids() const override { return ids_; }
  const ColumnLayout* columns() const override { return &domain_.layout(); }
  std::array<std::span<const double>, 3> displacement() const override { return {u_[0], u_[1], u_[2]}; }
  std::int64_t bonds() const override {
    return comm_.all_reduce(bonds_.initial_count(), parallel::Reduce::sum) / 2;
  }
  std::int64_t bond_evaluations() const override { return bond_evaluations_; }
  parallel::Traffic traffic() const override {
    if constexpr (Law::state_based) return halo_.traffic() + dilatation_->traffic();
    return halo_.traffic();
  }

  std::array<double, 3> reference_position(std::size_t particle) const override {
    const ColumnLayout& l = domain_.layout();
    const auto rows = static_cast<std::size_t>(l.row_count);
    const std::size_t c = static_cast<std::size_t>(l.first_column) + particle / rows;
    return {setup_.lattice.section.x[c], setup_.lattice.section.y[c],
            setup_.lattice.height(l.first_row + static_cast<std::int64_t>(particle % rows))};
  }
  std::vector<double> volumes() const override;
  double largest_load() const override { return load_.largest(); }
  void clear_held(std::array<std::vector<double>, 3>& field) const override;

  void set_state(const std::array<std::vector<double>, 3>& displacement,
                 const std::array<std::vector<double>, 3>& velocity) override {
    u_ = displacement;
    v_ = velocity;
    first_kick_pending_ = true;
    forces_known_ = false;
    displacement_.follow(u_, comm_);
    displacement_.fill(u_);
  }

  void set_axial_profile(const std::function<double(double z)>& profile) override {
    std::vector<double> shares(static_cast<std::size_t>(domain_.layout().rows));
    for (std::size_t row = 0; row < shares.size(); ++row)
      shares[row] = profile(setup_.lattice.height(static_cast<std::int64_t>(row)));
    load_.set_profile(std::move(shares));
  }
  StepEvents advance(double pressure, double next_pressure) override;
  void find_forces(double pressure) override;
  const Observation& observe(double pressure) override;
  Totals totals() const override;
  double max_displacement() const override;
  TablePart word_table() const override { return bonds_.word_table(); }
  Saved save() const override;
  void restore(const Saved& saved) override;

 private:
  static Domain checked_domain(const BodySetup& setup, const parallel::Communicator& comm);
  const Real* dilatation_pressure() const {
    if constexpr (Law::state_based) return dilatation_->pressure();
    return nullptr;
  }
  std::size_t particles() const { return static_cast<std::size_t>(domain_.layout().local_count()); }
  std::vector<ThreadEvents> make_events() const {
    return std::vector<ThreadEvents>(static_cast<std::size_t>(threads_), ThreadEvents(setup_.energy_scale));
  }

  /// Calls `work(subdomain, thread)` for each subdomain.
  template <class Work>
  void for_each_subdomain(const Work& work) {
    std::vector<Subdomain>& subdomains = forces_->subdomains();
    parallel::for_each_share(threads_, subdomains.size(),
                             [&](int thread, std::size_t begin, std::size_t end) {
                               for (std::size_t s = begin; s < end; ++s)
                                 work(subdomains[s], static_cast<std::size_t>(thread));
                             });
  }

  /// Rows of [begin, past), local, whose motion along axis `component` the ends do not hold.
  std::pair<std::int64_t, std::int64_t> local_free_rows(std::int64_t begin, std::int64_t past,
                                                        int component) const;
  /// The same of a block's rows, counted from its first.
  std::pair<int, int> free_lanes(RowBlock b, int component) const;

  void prepare_forces(std::vector<ThreadEvents>& per_thread);
  void look_for_rupture(ThreadEvents& events) const;
  void push_column(const Subdomain& s, std::int32_t slot, const StepLoad& load, ExactSum& work);
  void push_deformed_column(const Subdomain& s, std::int32_t slot, const StepLoad& load, ExactSum& work);
  void move_column(const Subdomain& s, std::int32_t slot, const StepLoad& load, ThreadEvents& events);
  void observe_block(const Subdomain& s, RowBlock b, double pressure, double kick, ObservedSums& sums);
  double observe_motion(const Subdomain& s, RowBlock b, double pressure, double kick);
  double work_of_half_step(RowBlock b, double pressure);

  BodySetup setup_;
  parallel::Communicator comm_;
  int threads_;
  Domain domain_;
  IdRanges ids_;
  KernelUnits units_;
  PressureLoad load_;
  PlaceProperties<Real> properties_;
  FollowerPressure<Real> follower_;
  BondStorage<Real> bonds_;
  BondDisplacement<Real> displacement_;
  parallel::HaloExchange<Real> halo_;  ///< exchanges displacement_
  std::optional<Dilatation<Law, Real>> dilatation_;
  std::optional<KernelInput<Real>> kernel_input_;
  std::optional<BondForces<Law, Real>> forces_;
  WorkAccount work_;
  FractureEnergy<Law, Real> fracture_;
  std::vector<std::pair<std::int64_t, std::int64_t>>
      free_rows_;  ///< rows of the whole body that move freely along each axis

  std::array<std::vector<double>, 3> u_, v_;  ///< m; m/s at half a step back (see first_kick_pending_)
  bool first_kick_pending_ = true;            ///< v_ is at the same time as u_
  long steps_ = 0;
  /// m/s, the speed that the load so far would have given a loose particle. A particle that is four times as
  /// fast, and moves more than two spacings a step besides, was not moved by forces of the model: the step is
  /// unstable.
  double load_speed_ = 0;

  bool forces_known_ = false;        ///< subdomains hold the present forces and energies
  bool damaged_ = false;             ///< damage has reached `rupture_damage` on this rank
  std::int64_t pending_broken_ = 0;  ///< directed bonds found broken before the step that tells of it
  std::int64_t crushed_ = 0;         ///< directed bonds, when forces were last found
  std::int64_t bond_evaluations_ = 0;
  Observation observation_;
  ObservedSums observed_{1.0};
};

template <class Law, class Real>
Domain ColumnBody<Law, Real>::checked_domain(const BodySetup& setup, const parallel::Communicator& comm) {
  std::vector<double> weights(setup.lattice.section.size());
  for (std::size_t c = 0; c < weights.size(); ++c) weights[c] = static_cast<double>(setup.families->count(c));
  const ColumnCut cut = mean_column_cut(*setup.families);
  const parallel::Partition partition =
      parallel::make_partition(comm.size(), weights, setup.lattice.rows,
                               {.bonds_across = cut.bonds,
                                .halo_columns = cut.columns,
                                .halo_rows = static_cast<double>(setup.families->reach)});
  Domain domain(setup.lattice, *setup.families, partition, comm.rank(),
                setup.ends == EndCondition::axial_periodic, setup.lumen);
  // Offsets between particles are 32-bit numbers in the kernel's tables.
  if (comm.all_reduce(static_cast<std::int64_t>(domain.padded_size()), parallel::Reduce::max) > INT32_MAX)
    throw InputError("the body is too large for " + std::to_string(comm.size()) + " rank(s); use more");
  return domain;
}

}  // namespace rhexis::peridynamics
