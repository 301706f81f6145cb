/// The one implementation of Body: what stands in memory and how it is found. Its work is in
/// column_body_step.hpp (a step in time), column_body_parts.hpp (the forces for it),
/// column_body_dilatation.hpp (what a state-based law does before), column_body_observe.hpp (fields and
/// totals) and column_body_state.hpp (bonds, state, restart); body.cpp includes all of them.
#pragma once

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <string>

#include "core/error.hpp"
#include "parallel/exact_sum.hpp"
#include "parallel/partition.hpp"
#include "parallel/threads.hpp"
#include "peridynamics/engine/body.hpp"
#include "peridynamics/engine/bond_kernel.hpp"
#include "peridynamics/engine/domain.hpp"
#include "peridynamics/engine/state_kernel.hpp"

namespace rhexis::peridynamics {

using parallel::block_rows;
using parallel::ExactSum;

/// Steps between looks at how far the body has moved as a whole.
inline constexpr long frame_interval = 64;
/// Once its middle is this many spacings from the frame, the frame follows, lest single precision loses
/// digits.
inline constexpr double frame_tolerance = 4;

/// Once the body's displacements are this many spacings apart from their middle, they are wrapped.
inline constexpr double wrap_distance = 512;

/// One block of 16 rows of one owned column.
struct Unit {
  std::int32_t slot, block;
};

/// What a thread gathers while it works; in cache lines of its own, fetched in pairs.
struct alignas(128) ThreadEvents {
  explicit ThreadEvents(double energy_scale) : work(energy_scale), released(energy_scale) {}
  ExactSum work, released;  ///< J; of state-based laws
  std::int64_t broken = 0, crushed = 0;
  std::vector<Unit> broken_units;  ///< where they have an end
  bool damaged = false, unstable = false;
};

/// A thread's columns and rows, see column_body_parts.hpp.
template <class Real>
struct Part {
  std::int32_t first_slot = 0, past_slot = 0;
  std::int64_t first_row = 0, past_row = 0;  ///< local
  std::vector<BondRun> runs;                 ///< see add_runs
  std::vector<std::size_t> first_run;        ///< of each column, into runs
  /// Of force and, when observing, energy; each column as in padded arrays.
  std::array<hwy::AlignedFreeUniquePtr<Real[]>, 4> sums;
  /// Words of the bonds that lead into the part from the 16 rows below it, and from those above; 0 for
  /// others.
  std::array<std::vector<std::uint16_t>, 2> beyond;
  bool beyond_known = false;
  std::vector<BrokenBond> broken;  ///< now, of one block, for both ends

  std::int32_t first_block() const { return static_cast<std::int32_t>(first_row / block_rows); }
  std::int32_t past_block() const {
    return static_cast<std::int32_t>((past_row + block_rows - 1) / block_rows);
  }
  /// First of the 16 rows next to an end.
  std::int64_t row_beyond(bool above) const { return above ? past_row : first_row - block_rows; }
  const BondRun& run_before(std::int32_t slot) const {
    return runs[first_run[static_cast<std::size_t>(slot - first_slot)]];
  }
  std::span<const BondRun> runs_from(std::int32_t slot) const {
    const std::size_t* const run = first_run.data() + (slot - first_slot);
    return {runs.data() + run[0] + 1, runs.data() + run[1]};
  }
};

/// What drives a step in time.
struct Push {
  double pressure, work_pressure;  ///< Pa, now and the mean over the step
  double kick;                     ///< s, by which velocities lag behind
  double fastest;                  ///< m/s, see load_speed_
};

/// What a thread gathers while it observes.
struct alignas(128) ThreadTotals {
  explicit ThreadTotals(double scale) : kinetic(scale), strain(scale), fracture(scale) {}
  ExactSum kinetic, strain, fracture;
  double max_damage = 0;
  std::int64_t ruptured_first = INT64_MAX, ruptured_last = -1;
};

/// What a state-based law keeps of its particles, see laws/lps.hpp.
template <class Real>
struct States {
  States(parallel::Communicator comm, const Domain& domain, double energy_scale)
      : halo(comm, domain.halo_messages(), 1),
        pressure(domain.padded_size()),
        dilatation(static_cast<std::size_t>(domain.layout().local_count())),
        released(energy_scale) {}

  parallel::HaloExchange<Real> halo;  ///< of the pressure
  std::vector<Real> pressure;         ///< p, padded
  std::vector<double> dilatation;     ///< theta of owned particles
  ExactSum released;                  ///< J, dilatation energy that breaking bonds took so far
};

template <class Law, class Real>
class ColumnBody final : public Body {
 public:
  ColumnBody(Law law, BodySetup setup, parallel::Communicator comm)
      : law_(law),
        setup_(std::move(setup)),
        comm_(comm),
        periodic_(setup_.ends == EndCondition::axial_periodic),
        threads_(parallel::thread_count()),
        domain_(setup_.lattice, *setup_.families, partition(setup_, comm.size()), comm.rank(), periodic_),
        halo_(comm, domain_.halo_messages(), 3),
        inverse_spacing_(1 / setup_.lattice.spacing),
        work_(setup_.energy_scale) {
    // Offsets between particles are 32-bit numbers in the kernel's tables.
    if (comm_.all_reduce(static_cast<std::int64_t>(domain_.padded_size()), parallel::Reduce::max) >
        INT32_MAX) {
      throw InputError("the body is too large for " + std::to_string(comm_.size()) + " rank(s); use more");
    }
    for (std::size_t c = 0; c < setup_.layer.bx.size(); ++c) {
      largest_load_ = std::max(largest_load_, std::hypot(setup_.layer.bx[c], setup_.layer.by[c]));
    }
    for (int k = 0; k < 3; ++k) free_rows_.push_back(peridynamics::free_rows(setup_, k));
    make_local_properties();
    make_thin_spots();
    make_bonds();
    if constexpr (Law::state_based) make_units();
    make_parts();
    if constexpr (Law::state_based) state_.emplace(comm_, domain_, setup_.energy_scale);
    set_axial_profile(std::vector<double>(static_cast<std::size_t>(domain_.layout().rows), 1.0));
    const auto particles = static_cast<std::size_t>(domain_.layout().local_count());
    for (int k = 0; k < 3; ++k) {
      u_[k].assign(particles, 0.0);
      v_[k].assign(particles, 0.0);
      for (auto& copy : padded_) {
        copy[k] = hwy::AllocateAligned<Real>(domain_.padded_size());
        std::fill_n(copy[k].get(), domain_.padded_size(), Real{0});
      }
    }
  }

  const PointLayout& layout() const override { return domain_.layout(); }
  std::array<std::span<const double>, 3> displacement() const override { return {u_[0], u_[1], u_[2]}; }
  std::int64_t bonds() const override { return comm_.all_reduce(born_directed_, parallel::Reduce::sum) / 2; }
  std::int64_t bond_evaluations() const override { return bond_evaluations_; }
  parallel::Traffic traffic() const override {
    if constexpr (Law::state_based) return halo_.traffic() + state_->halo.traffic();
    return halo_.traffic();
  }

  std::array<double, 3> reference_position(std::int64_t column, std::int64_t row) const override {
    const PointLayout& l = domain_.layout();
    const auto c = static_cast<std::size_t>(l.first_column + column);
    return {setup_.lattice.section.x[c], setup_.lattice.section.y[c],
            setup_.lattice.height(l.first_row + row)};
  }

  void set_state(const std::array<std::vector<double>, 3>& displacement,
                 const std::array<std::vector<double>, 3>& velocity) override {
    u_ = displacement;
    v_ = velocity;
    first_kick_pending_ = true;
    forces_known_ = false;
    follow_body();
    fill_padded();
  }

  void set_axial_profile(std::vector<double> profile) override { profile_ = std::move(profile); }
  StepEvents advance(double pressure, double next_pressure) override;
  void find_forces() override;
  const Observation& observe(double pressure) override;
  Totals totals() const override;
  double max_displacement() const override;
  BondWordLayout bond_word_layout() const override;
  Saved save() const override;
  void restore(const Saved& saved) override;

 private:
  static parallel::Partition partition(const BodySetup& setup, int ranks) {
    std::vector<double> weights(setup.lattice.section.size());
    for (std::size_t c = 0; c < weights.size(); ++c)
      weights[c] = static_cast<double>(setup.families->count(c));
    const ColumnCut cut = mean_column_cut(*setup.families);
    return parallel::make_partition(ranks, weights, setup.lattice.rows,
                                    {.bonds_across = cut.bonds,
                                     .halo_columns = cut.columns,
                                     .halo_rows = static_cast<double>(setup.families->reach)});
  }

  std::size_t global_column(std::int32_t slot) const {
    return static_cast<std::size_t>(domain_.layout().first_column + slot);
  }
  /// First particle of a unit in the state arrays.
  std::size_t particle(Unit unit) const {
    return static_cast<std::size_t>(unit.slot * domain_.layout().row_count + unit.block * block_rows);
  }
  /// The load of a unit's rows relative to the layer's; may be put into `space`.
  const double* load_shares(Unit unit, double (&space)[block_rows]) const {
    const double* profile = profile_.data() + domain_.layout().first_row + unit.block * block_rows;
    if (load_share_.empty()) return profile;
    const double* own = load_share_.data() + particle(unit);
    for (int lane = 0; lane < domain_.rows_in(unit.block); ++lane) space[lane] = profile[lane] * own[lane];
    return space;
  }
  std::size_t padded_place(Unit unit) const {
    return domain_.padded(static_cast<std::size_t>(unit.slot)) +
           static_cast<std::size_t>(unit.block * block_rows);
  }
  std::span<const BondConstants<Real>> bonds_of(Unit unit) const {
    const std::int64_t begin = first_bond_[unit.slot], end = first_bond_[unit.slot + 1];
    return {bonds_.data() + begin, static_cast<std::size_t>(end - begin)};
  }
  /// Words of a unit, one per bond of its column: [column][block][bond].
  std::size_t first_word(Unit unit) const {
    const std::int64_t bonds = first_bond_[unit.slot + 1] - first_bond_[unit.slot];
    return static_cast<std::size_t>(first_bond_[unit.slot] * domain_.blocks() + unit.block * bonds);
  }
  std::size_t number(Unit unit) const {
    return static_cast<std::size_t>(std::int64_t{unit.slot} * domain_.blocks() + unit.block);
  }
  bool is_absent(Unit unit, int lane) const {
    return !absent_.empty() && absent_[padded_place(unit) + static_cast<std::size_t>(lane)] != 0;
  }
  /// Rows of a unit that its column's bond `b` was born in.
  std::uint16_t born(Unit unit, std::size_t b) const {
    std::uint16_t rows = domain_.partners(unit.block, reference_bond(unit, b).row_offset);
    if (absent_.empty()) return rows;
    const char* here = absent_.data() + padded_place(unit);
    const char* there = here + bonds_of(unit)[b].offset;
    for (int lane = 0; lane < block_rows; ++lane) {
      if (here[lane] || there[lane]) rows = static_cast<std::uint16_t>(rows & ~(1u << lane));
    }
    return rows;
  }
  const Bond& reference_bond(Unit unit, std::size_t b) const {
    return setup_.families->bonds[setup_.families->first[global_column(unit.slot)] + b];
  }
  std::array<Real*, 3> current() { return pointers(padded_[now_]); }
  std::array<Real*, 3> next() { return pointers(padded_[1 - now_]); }
  using Padded = std::array<hwy::AlignedFreeUniquePtr<Real[]>, 3>;
  static std::array<Real*, 3> pointers(Padded& p) { return {p[0].get(), p[1].get(), p[2].get()}; }

  void make_bonds();
  void make_units();
  void make_parts();
  void add_runs(Part<Real>& part, std::int32_t slot) const;
  void find_opposites();
  std::pair<std::int64_t, std::vector<double>> padded_heights() const;
  void make_local_properties();
  void make_thin_spots();
  /// Factor on the stiffness of a particle at its place in padded arrays.
  double local_stiffness(std::size_t place) const {
    return half_stiffness_.empty() ? 1 : 2 * double{half_stiffness_[place]};
  }
  /// c spacing^4, J/m3: what sums over bonds are in units of.
  double energy_scale() const {
    const double spacing = setup_.lattice.spacing;
    return setup_.bond_constant * (spacing * spacing * spacing) * spacing;
  }
  /// Of a column's particles, in spacings cubed.
  double relative_volume(std::size_t column) const {
    const double spacing = setup_.lattice.spacing;
    return setup_.lattice.volume(column) / (spacing * spacing * spacing);
  }
  /// Factor that makes force density, N/m3, of a block's sums.
  double bond_force_density(std::size_t column) const {
    return energy_scale() / (setup_.lattice.spacing * relative_volume(column));
  }
  /// A sum as another run saved it.
  ExactSum restored(const std::array<double, 2>& parts) const {
    ExactSum sum(setup_.energy_scale);
    for (const double part : parts) sum.add(comm_.is_root() ? part : 0.0);
    return sum;
  }
  void follow_body();
  void fill_padded();
  /// A component of displacement (m) as bonds read it.
  Real in_frame(double u, double frame) const {
    const double x = (u - frame) * inverse_spacing_;
    return static_cast<Real>(x - wrap_period * std::nearbyint(x * per_period_));
  }
  BlockView<Real> view(std::int32_t slot, std::int64_t row, std::uint16_t* words);
  BlockView<Real> view(Unit unit) {
    return view(unit.slot, unit.block * block_rows, intact_.data() + first_word(unit));
  }
  BlockView<Real> view(Part<Real>& part, std::int32_t slot, std::int64_t row, std::uint16_t* words);
  template <class Use>
  void choose_kernel(const Use& use) const;
  template <bool observing>
  BlockEvents sum(const BlockView<Real>& block, std::span<const BondRun> runs) const;
  template <class Use>
  void each_opposite(const Part<Real>& part, std::int32_t slot, std::int64_t row, std::int32_t b,
                     const Use& use);
  void break_other_ends(Part<Real>& part, std::int32_t slot, std::int64_t row, std::size_t count,
                        ThreadEvents& events);
  /// Of a column, in Part::beyond.
  std::uint16_t* words_beyond(Part<Real>& part, std::int32_t slot, bool above) const {
    return part.beyond[above].data() + (first_bond_[slot] - first_bond_[part.first_slot]);
  }
  void find_beyond(Part<Real>& part, bool above);
  template <bool observing>
  void add_from_beyond(Part<Real>& part, std::int32_t slot, bool above, ThreadEvents& events);
  template <bool observing, class Use>
  void sum_part(Part<Real>& part, ThreadEvents& events, const Use& use);
  double breaking_energy(Unit unit, const BondConstants<Real>& bond, std::uint16_t broken) const;
  std::pair<std::int64_t, std::int64_t> free_rows(std::int64_t begin, std::int64_t past, int component) const;
  std::pair<int, int> free_rows(Unit unit, int component) const;
  std::uint16_t broken(Unit unit, std::size_t b) const;
  void find_damage(Unit unit, double (&damage)[block_rows]) const;
  bool has_ruptured(Unit unit) const;
  void note_broken(Unit unit, int broken, ThreadEvents& events);
  void look_for_rupture(ThreadEvents& events) const;
  double fracture_energy(Unit unit) const;
  double dilatation_energy(double theta, std::size_t place) const;
  void dilate_unit(Unit unit, ThreadEvents& events);
  void find_dilatations(std::vector<ThreadEvents>& per_thread);
  void push_column(const Part<Real>& part, std::int32_t slot, const Push& push, ExactSum& work);
  void move_column(const Part<Real>& part, std::int32_t slot, const Push& push, ThreadEvents& events);
  void observe_unit(const Part<Real>& part, Unit unit, double pressure, double kick, ThreadTotals& totals);
  void prepare_forces(std::vector<ThreadEvents>& per_thread);

  Law law_;
  BodySetup setup_;
  parallel::Communicator comm_;
  bool periodic_;
  int threads_;
  Domain domain_;
  parallel::HaloExchange<Real> halo_;
  double inverse_spacing_;

  std::vector<std::int64_t> first_bond_;  ///< of owned columns, into bonds_
  std::vector<BondConstants<Real>> bonds_;
  std::vector<std::uint16_t> intact_;
  std::vector<Real> half_stretch_, half_stiffness_;  ///< padded (see LocalProperties); empty: a uniform wall
  std::vector<char> absent_;               ///< padded, 1 where thin spots leave no particle; empty: nowhere
  std::vector<double> load_share_;         ///< [particles] relative to the whole wall's; empty: 1
  std::vector<double> family_volume_;      ///< [particles] sum of V_j / spacing^3, as born
  std::optional<States<Real>> state_;      ///< of state-based laws
  std::vector<Unit> interior_, boundary_;  ///< of state-based laws: units that read no halo, that do
  std::vector<Part<Real>> parts_;          ///< of threads
  std::vector<std::int32_t> opposite_;     ///< of bonds_, see find_opposites

  std::array<std::vector<double>, 3> u_, v_;  ///< m; m/s at half a step back (see first_kick_pending_)
  std::array<Padded, 2> padded_;
  int now_ = 0;
  std::array<double, 3> frame_{};   ///< m, subtracted from u in padded arrays
  double per_period_ = 0;           ///< 1 / wrap_period where padded arrays are wrapped, or 0
  bool first_kick_pending_ = true;  ///< v_ is at the same time as u_
  long steps_ = 0;
  bool damaged_ = false;
  bool forces_known_ = false;                             ///< parts hold the present forces and energies
  std::int64_t pending_broken_ = 0;                       ///< found broken before the step that tells of it
  std::int64_t born_directed_ = 0, intact_directed_ = 0;  ///< bonds of owned particles
  std::int64_t bond_evaluations_ = 0;
  ExactSum work_;
  /// m/s, what the load so far would have given a loose particle. One that is four times as fast, and moves
  /// more than two spacings a step besides, was not moved by forces of the model: the step is unstable.
  double load_speed_ = 0;
  std::vector<double> profile_;                                   ///< [rows of the whole body]
  double largest_load_ = 0;                                       ///< 1/m, of the pressure layer
  std::vector<std::pair<std::int64_t, std::int64_t>> free_rows_;  ///< of the whole body, along each axis
  Observation observation_;
  ThreadTotals observed_{1.0};
  std::int64_t crushed_ = 0;             ///< directed bonds, when forces were last found
  std::vector<char> changed_;            ///< [units] bonds broke since damage was last found
  std::vector<double> fracture_energy_;  ///< J, [units] when damage was last found
};

}  // namespace rhexis::peridynamics
