#include "peridynamics/body.hpp"

#include <hwy/aligned_allocator.h>

#include <algorithm>
#include <bit>
#include <cmath>

#include "parallel/exact_sum.hpp"
#include "parallel/partition.hpp"
#include "parallel/threads.hpp"
#include "peridynamics/bond_kernel.hpp"
#include "peridynamics/domain.hpp"
#include "peridynamics/materials/pmb.hpp"

namespace rhexis::peridynamics {
namespace {

using parallel::block_rows;
using parallel::ExactSum;

/// Steps between looks at how far the body has moved as a whole.
constexpr long frame_interval = 64;
/// Once its middle is this many spacings from the frame, the frame follows, lest single precision loses
/// digits.
constexpr double frame_tolerance = 4;

/// One block of 16 rows of one owned column: the unit of work.
struct Unit {
  std::int32_t slot, block;
};

/// What a thread gathers while it works.
struct ThreadEvents {
  explicit ThreadEvents(double energy_scale) : work(energy_scale) {}
  ExactSum work;
  std::int64_t broken = 0;
  bool damaged = false, unstable = false;
};

/// What a thread gathers while it observes.
struct ThreadTotals {
  explicit ThreadTotals(double scale) : kinetic(scale), strain(scale), fracture(scale) {}
  ExactSum kinetic, strain, fracture;
  double max_damage = 0;
  std::int64_t broken = 0;
  std::int64_t ruptured_first = INT64_MAX, ruptured_last = -1;
};

template <class Law, class Real>
class ColumnBody final : public Body {
 public:
  ColumnBody(BodySetup setup, parallel::Communicator comm)
      : setup_(std::move(setup)),
        comm_(comm),
        periodic_(setup_.ends == EndCondition::axial_periodic),
        threads_(parallel::thread_count()),
        domain_(setup_.lattice, setup_.families, partition(setup_, comm.size()), comm.rank(), periodic_),
        halo_(comm, domain_.halo_messages()),
        inverse_spacing_(1 / setup_.lattice.spacing),
        work_(setup_.energy_scale) {
    make_bonds();
    make_units();
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
  std::int64_t bond_evaluations() const override { return bond_evaluations_; }

  std::array<double, 3> reference_position(std::int64_t column, std::int64_t row) const override {
    const PointLayout& l = domain_.layout();
    const auto c = static_cast<std::size_t>(l.first_column + column);
    return {setup_.lattice.section.x[c], setup_.lattice.section.y[c],
            (static_cast<double>(l.first_row + row) + 0.5) * setup_.lattice.row_spacing};
  }

  void set_state(const std::array<std::vector<double>, 3>& displacement,
                 const std::array<std::vector<double>, 3>& velocity) override {
    u_ = displacement;
    v_ = velocity;
    first_kick_pending_ = true;
    follow_body();
    fill_padded();
  }

  StepEvents advance(double pressure, double next_pressure) override;
  const Observation& observe(double pressure) override;
  Totals totals() const override;
  double max_displacement() const override;
  BondWordLayout bond_word_layout() const override;
  Saved save() const override;
  void restore(const Saved& saved) override;

 private:
  static parallel::Partition partition(const BodySetup& setup, int ranks) {
    const std::size_t columns = setup.lattice.section.size();
    std::vector<double> weights(columns);
    for (std::size_t c = 0; c < columns; ++c) weights[c] = static_cast<double>(setup.families.count(c));
    // Columns within a horizon of a radial cut through one side of the wall, both sides cut.
    const double share =
        setup.lattice.horizon / (setup.lattice.spacing * std::sqrt(static_cast<double>(columns)));
    const auto halo = static_cast<std::int64_t>(share * static_cast<double>(columns)) + 1;
    return parallel::make_partition(ranks, weights, setup.lattice.rows, halo, setup.families.reach);
  }

  std::size_t global_column(std::int32_t slot) const {
    return static_cast<std::size_t>(domain_.layout().first_column + slot);
  }
  /// First particle of a unit in the state arrays.
  std::size_t particle(Unit unit) const {
    return static_cast<std::size_t>(unit.slot * domain_.layout().row_count + unit.block * block_rows);
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
  const Bond& reference_bond(Unit unit, std::size_t b) const {
    return setup_.families.bonds[setup_.families.first[global_column(unit.slot)] + b];
  }
  std::array<Real*, 3> current() { return pointers(padded_[now_]); }
  std::array<Real*, 3> next() { return pointers(padded_[1 - now_]); }
  using Padded = std::array<hwy::AlignedFreeUniquePtr<Real[]>, 3>;
  static std::array<Real*, 3> pointers(Padded& p) { return {p[0].get(), p[1].get(), p[2].get()}; }

  void make_bonds();
  void make_units();
  void follow_body();
  void fill_padded();
  BlockView<Real> view(Unit unit);
  std::pair<int, int> free_rows(Unit unit) const;
  void family_volumes(Unit unit, double (&intact)[block_rows], double (&whole)[block_rows]) const;
  bool has_ruptured(Unit unit) const;
  void step_unit(Unit unit, double pressure, double work_pressure, double kick, ThreadEvents& events);
  void observe_unit(Unit unit, double pressure, double kick, ThreadTotals& totals);
  template <class PerThread, class Work>
  void with_halo(std::vector<PerThread>& per_thread, const Work& work);

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
  std::vector<Unit> interior_, boundary_;  ///< units that read no halo, units that do

  std::array<std::vector<double>, 3> u_, v_;  ///< m; m/s at half a step back (see first_kick_pending_)
  std::array<Padded, 2> padded_;
  int now_ = 0;
  std::array<double, 3> frame_{};   ///< m, subtracted from u in padded arrays
  bool first_kick_pending_ = true;  ///< v_ is at the same time as u_
  long steps_ = 0;
  bool damaged_ = false;
  std::int64_t pending_broken_ = 0;  ///< broken while observing, to be told by the next step
  std::int64_t intact_directed_ = 0;
  std::int64_t bond_evaluations_ = 0;
  ExactSum work_;
  double work_before_ = 0;  ///< J, done before a restart (on rank 0)
  Observation observation_;
  Totals local_totals_;
  ThreadTotals observed_{1.0};
};

template <class Law, class Real>
void ColumnBody<Law, Real>::make_bonds() {
  const Lattice& lattice = setup_.lattice;
  const double unit_volume = lattice.spacing * lattice.spacing * lattice.spacing;
  const PointLayout& layout = domain_.layout();
  first_bond_.push_back(0);
  for (std::int64_t c = 0; c < layout.column_count; ++c) {
    const auto column = static_cast<std::size_t>(layout.first_column + c);
    for (std::int64_t b = setup_.families.first[column]; b < setup_.families.first[column + 1]; ++b) {
      const Bond& bond = setup_.families.bonds[b];
      const double volume = lattice.volume(bond.other) / unit_volume;
      const auto offset = static_cast<std::int64_t>(domain_.padded(domain_.slot(bond.other))) +
                          bond.row_offset -
                          static_cast<std::int64_t>(domain_.padded(static_cast<std::size_t>(c)));
      bonds_.push_back({{Real(bond.xi[0]), Real(bond.xi[1]), Real(bond.xi[2])},
                        Real(1 / (bond.length * bond.length)),
                        Real(volume / bond.length),
                        Real(volume),
                        Real(volume * bond.length),
                        static_cast<std::int32_t>(offset)});
    }
    first_bond_.push_back(static_cast<std::int64_t>(bonds_.size()));
  }
  intact_.resize(bonds_.size() * static_cast<std::size_t>(domain_.blocks()));
  for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
    for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
      const Unit unit{slot, block};
      for (std::size_t b = 0; b < bonds_of(unit).size(); ++b) {
        const std::uint16_t word = domain_.partners(block, reference_bond(unit, b).row_offset);
        intact_[first_word(unit) + b] = word;
        intact_directed_ += std::popcount(word);
      }
    }
  }
}

template <class Law, class Real>
void ColumnBody<Law, Real>::make_units() {
  for (std::int32_t slot = 0; slot < domain_.layout().column_count; ++slot) {
    for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
      (domain_.interior(static_cast<std::size_t>(slot), block) ? interior_ : boundary_)
          .push_back({slot, block});
    }
  }
}

/// Moves the frame to the middle of the body's displacements, found from exact minima and maxima so that
/// every partition takes the same.
template <class Law, class Real>
void ColumnBody<Law, Real>::follow_body() {
  double extremes[6];
  for (int k = 0; k < 3; ++k) {
    const auto [low, high] = std::minmax_element(u_[k].begin(), u_[k].end());
    extremes[k] = -*low;
    extremes[3 + k] = *high;
  }
  comm_.all_reduce(extremes, parallel::Reduce::max);
  bool moved = false;
  for (int k = 0; k < 3; ++k) {
    const double middle = 0.5 * (extremes[3 + k] - extremes[k]);
    if (std::abs(middle - frame_[k]) > frame_tolerance * setup_.lattice.spacing) {
      frame_[k] = middle;
      moved = true;
    }
  }
  if (moved) fill_padded();
}

template <class Law, class Real>
void ColumnBody<Law, Real>::fill_padded() {
  const PointLayout& layout = domain_.layout();
  for (auto& copy : padded_) {  // both: held rows are never written again
    for (int k = 0; k < 3; ++k) {
      for (std::int64_t c = 0; c < layout.column_count; ++c) {
        Real* out = copy[k].get() + domain_.padded(static_cast<std::size_t>(c));
        const double* in = u_[k].data() + c * layout.row_count;
        for (std::int64_t r = 0; r < layout.row_count; ++r) {
          out[r] = static_cast<Real>((in[r] - frame_[k]) * inverse_spacing_);
        }
      }
    }
  }
}

template <class Law, class Real>
BlockView<Real> ColumnBody<Law, Real>::view(Unit unit) {
  const std::size_t place = padded_place(unit);
  const auto u = current();
  return {{u[0] + place, u[1] + place, u[2] + place},
          bonds_of(unit),
          intact_.data() + first_word(unit),
          static_cast<Real>(Law::breaking_t(setup_.critical_stretch))};
}

/// Rows of a unit, [first, past), that ends do not hold.
template <class Law, class Real>
std::pair<int, int> ColumnBody<Law, Real>::free_rows(Unit unit) const {
  const int rows = domain_.rows_in(unit.block);
  if (setup_.ends != EndCondition::clamped && setup_.ends != EndCondition::sliding) return {0, rows};
  const auto held =
      static_cast<std::int64_t>(std::ceil(setup_.end_length / setup_.lattice.row_spacing - 1e-9));
  const std::int64_t first = domain_.layout().first_row + unit.block * block_rows;
  const auto local = [&](std::int64_t row) {
    return static_cast<int>(std::clamp<std::int64_t>(row - first, 0, rows));
  };
  return {local(held), std::max(local(held), local(domain_.layout().rows - held))};
}

/// Sums of V_j / spacing^3 over each row's unbroken bonds and over all it was born with.
template <class Law, class Real>
void ColumnBody<Law, Real>::family_volumes(Unit unit, double (&intact)[block_rows],
                                           double (&whole)[block_rows]) const {
  std::fill_n(intact, block_rows, 0.0);
  std::fill_n(whole, block_rows, 0.0);
  const auto bonds = bonds_of(unit);
  const std::uint16_t* words = intact_.data() + first_word(unit);
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const unsigned now = words[b];
    const unsigned born = domain_.partners(unit.block, reference_bond(unit, b).row_offset);
    const double volume = bonds[b].volume;
    for (int lane = 0; lane < block_rows; ++lane) {
      intact[lane] += (now >> lane & 1u) ? volume : 0.0;
      whole[lane] += (born >> lane & 1u) ? volume : 0.0;
    }
  }
}

/// Eq. (6) reaches `rupture_damage` somewhere in the unit.
template <class Law, class Real>
bool ColumnBody<Law, Real>::has_ruptured(Unit unit) const {
  double intact[block_rows], whole[block_rows];
  family_volumes(unit, intact, whole);
  for (int lane = 0; lane < domain_.rows_in(unit.block); ++lane) {
    if (whole[lane] > 0 && 1 - intact[lane] / whole[lane] >= rupture_damage) return true;
  }
  return false;
}

/// Runs `work(unit, per_thread[t])` over all units; the halo travels while units that do not need it are
/// done.
template <class Law, class Real>
template <class PerThread, class Work>
void ColumnBody<Law, Real>::with_halo(std::vector<PerThread>& per_thread, const Work& work) {
  const auto run = [&](const std::vector<Unit>& units) {
    parallel::for_each_share(threads_, units.size(), [&](int thread, std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) work(units[i], per_thread[thread]);
    });
  };
  halo_.start(current());
  run(interior_);
  halo_.finish(current());
  run(boundary_);
}

template <class Law, class Real>
void ColumnBody<Law, Real>::step_unit(Unit unit, double pressure, double work_pressure, double kick,
                                      ThreadEvents& events) {
  BlockSums<Real> sums;
  sum_block<Law, false>(view(unit), sums);
  if (sums.broken > 0) {
    events.broken += sums.broken;
    if (!damaged_ && !events.damaged) events.damaged = has_ruptured(unit);
  }

  const std::size_t column = global_column(unit.slot);
  const Lattice& lattice = setup_.lattice;
  const double body_force[3] = {pressure * setup_.layer.bx[column], pressure * setup_.layer.by[column], 0.0};
  const double volume = lattice.spacing * lattice.spacing * lattice.spacing;
  const double bond_acceleration = setup_.bond_constant * volume / setup_.density;
  const double dt = setup_.time_step;
  const double fastest = lattice.spacing / dt;
  const auto [first_free, past_free] = free_rows(unit);
  const auto next_u = next();
  bool sane = true;
  double work = 0;
  for (int k = 0; k < 3; ++k) {
    // Sliding ends hold the axial component only.
    const bool held = setup_.ends == EndCondition::clamped || k == 2;
    const int first = held ? first_free : 0;
    const int past = held ? past_free : domain_.rows_in(unit.block);
    double* u = u_[k].data() + particle(unit);
    double* v = v_[k].data() + particle(unit);
    Real* out = next_u[k] + padded_place(unit);
    const double load = body_force[k] / setup_.density;
    const double frame = frame_[k];
    double path = 0;
    for (int lane = first; lane < past; ++lane) {
      v[lane] += kick * (bond_acceleration * static_cast<double>(sums.force[k][lane]) + load);
      u[lane] += dt * v[lane];
      out[lane] = static_cast<Real>((u[lane] - frame) * inverse_spacing_);
      path += v[lane];
      sane &= std::abs(v[lane]) < fastest;
    }
    if (k == 0) work += setup_.layer.bx[column] * path;
    if (k == 1) work += setup_.layer.by[column] * path;
  }
  if (setup_.layer.loads(column)) events.work.add(work_pressure * dt * lattice.volume(column) * work);
  events.unstable = events.unstable || !sane;
}

template <class Law, class Real>
StepEvents ColumnBody<Law, Real>::advance(double pressure, double next_pressure) {
  if (steps_ % frame_interval == 0) follow_body();
  const double kick = first_kick_pending_ ? 0.5 * setup_.time_step : setup_.time_step;
  const double work_pressure = 0.5 * (pressure + next_pressure);
  std::vector<ThreadEvents> per_thread(static_cast<std::size_t>(threads_), ThreadEvents(setup_.energy_scale));
  with_halo(per_thread,
            [&](Unit unit, ThreadEvents& events) { step_unit(unit, pressure, work_pressure, kick, events); });
  now_ = 1 - now_;
  first_kick_pending_ = false;
  ++steps_;

  StepEvents events;
  events.broken = std::exchange(pending_broken_, 0);
  for (const ThreadEvents& t : per_thread) {
    work_.add(t.work);
    events.broken += t.broken;
    intact_directed_ -= t.broken;
    events.unstable = events.unstable || t.unstable;
    damaged_ = damaged_ || t.damaged;
  }
  events.damaged = damaged_;
  bond_evaluations_ += intact_directed_;
  return events;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::observe_unit(Unit unit, double pressure, double kick, ThreadTotals& totals) {
  BlockSums<Real> sums;
  sum_block<Law, true>(view(unit), sums);
  totals.broken += sums.broken;

  const std::size_t column = global_column(unit.slot);
  const Lattice& lattice = setup_.lattice;
  const double volume = lattice.spacing * lattice.spacing * lattice.spacing;
  const double force_scale = setup_.bond_constant * volume;
  const double energy_scale = force_scale * lattice.spacing;
  const double particle_volume = lattice.volume(column);
  const double load[3] = {pressure * setup_.layer.bx[column], pressure * setup_.layer.by[column], 0.0};
  const auto [first_free, past_free] = free_rows(unit);
  const std::size_t first = particle(unit);
  const int rows = domain_.rows_in(unit.block);

  double speed2 = 0, strain = 0;
  for (int k = 0; k < 3; ++k) {
    const bool held = setup_.ends == EndCondition::clamped || k == 2;
    for (int lane = 0; lane < rows; ++lane) {
      const double force = force_scale * static_cast<double>(sums.force[k][lane]) + load[k];
      const bool moves = !held || (lane >= first_free && lane < past_free);
      const double v = v_[k][first + lane] + (moves ? kick * force / setup_.density : 0.0);
      observation_.force_density[k][first + lane] = force;
      observation_.velocity[k][first + lane] = v;
      speed2 += v * v;
    }
  }
  double intact[block_rows], whole[block_rows];
  family_volumes(unit, intact, whole);
  for (int lane = 0; lane < rows; ++lane) {
    const double energy = energy_scale * static_cast<double>(sums.energy[lane]);
    const double damage = whole[lane] > 0 ? 1 - intact[lane] / whole[lane] : 0;
    observation_.strain_energy_density[first + lane] = energy;
    observation_.damage[first + lane] = damage;
    strain += energy;
    totals.max_damage = std::max(totals.max_damage, damage);
    if (damage >= rupture_damage) {
      const std::int64_t row = domain_.layout().first_row + unit.block * block_rows + lane;
      totals.ruptured_first = std::min(totals.ruptured_first, row);
      totals.ruptured_last = std::max(totals.ruptured_last, row);
    }
  }
  totals.kinetic.add(0.5 * setup_.density * particle_volume * speed2);
  totals.strain.add(particle_volume * strain);

  // A bond took c s0^2 |xi| V_i V_j / 2 to break; each of its ends accounts for half.
  const double s0 = setup_.critical_stretch;
  const double per_weight = 0.25 * energy_scale * s0 * s0 * particle_volume;
  const auto bonds = bonds_of(unit);
  const std::uint16_t* words = intact_.data() + first_word(unit);
  double fracture = 0;
  for (std::size_t b = 0; b < bonds.size(); ++b) {
    const std::uint16_t born = domain_.partners(unit.block, reference_bond(unit, b).row_offset);
    fracture += std::popcount(static_cast<std::uint16_t>(born & ~words[b])) * double{bonds[b].energy_weight};
  }
  totals.fracture.add(per_weight * fracture);
}

template <class Law, class Real>
const Observation& ColumnBody<Law, Real>::observe(double pressure) {
  const std::size_t particles = u_[0].size();
  for (int k = 0; k < 3; ++k) {
    observation_.velocity[k].resize(particles);
    observation_.force_density[k].resize(particles);
  }
  observation_.strain_energy_density.resize(particles);
  observation_.damage.resize(particles);

  const double kick = first_kick_pending_ ? 0.0 : 0.5 * setup_.time_step;
  std::vector<ThreadTotals> per_thread(static_cast<std::size_t>(threads_), ThreadTotals(setup_.energy_scale));
  with_halo(per_thread, [&](Unit unit, ThreadTotals& totals) { observe_unit(unit, pressure, kick, totals); });
  observed_ = per_thread.front();
  for (std::size_t t = 1; t < per_thread.size(); ++t) {
    const ThreadTotals& other = per_thread[t];
    observed_.kinetic.add(other.kinetic);
    observed_.strain.add(other.strain);
    observed_.fracture.add(other.fracture);
    observed_.broken += other.broken;
    observed_.max_damage = std::max(observed_.max_damage, other.max_damage);
    observed_.ruptured_first = std::min(observed_.ruptured_first, other.ruptured_first);
    observed_.ruptured_last = std::max(observed_.ruptured_last, other.ruptured_last);
  }
  pending_broken_ += observed_.broken;
  intact_directed_ -= observed_.broken;
  damaged_ = damaged_ || observed_.max_damage >= rupture_damage;
  return observation_;
}

template <class Law, class Real>
Totals ColumnBody<Law, Real>::totals() const {
  Totals totals;
  totals.kinetic = observed_.kinetic.value(comm_);
  totals.strain = observed_.strain.value(comm_);
  totals.fracture = observed_.fracture.value(comm_);
  totals.external_work = work_.value(comm_) + comm_.all_reduce(work_before_, parallel::Reduce::max);
  totals.max_displacement = max_displacement();
  totals.max_damage = comm_.all_reduce(observed_.max_damage, parallel::Reduce::max);
  std::int64_t born = 0;
  for (std::int32_t slot = 0; slot < domain_.layout().column_count; ++slot) {
    for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
      for (std::size_t b = 0; b < bonds_of({slot, block}).size(); ++b) {
        born += std::popcount(domain_.partners(block, reference_bond({slot, block}, b).row_offset));
      }
    }
  }
  totals.broken_bonds = comm_.all_reduce(born - intact_directed_, parallel::Reduce::sum) / 2;
  const std::int64_t first = comm_.all_reduce(observed_.ruptured_first, parallel::Reduce::min);
  const std::int64_t last = comm_.all_reduce(observed_.ruptured_last, parallel::Reduce::max);
  if (last >= first)
    totals.rupture_length = static_cast<double>(last - first + 1) * setup_.lattice.row_spacing;
  return totals;
}

template <class Law, class Real>
double ColumnBody<Law, Real>::max_displacement() const {
  double largest = 0;
  for (std::size_t i = 0; i < u_[0].size(); ++i) {
    largest = std::max(largest, u_[0][i] * u_[0][i] + u_[1][i] * u_[1][i] + u_[2][i] * u_[2][i]);
  }
  return std::sqrt(comm_.all_reduce(largest, parallel::Reduce::max));
}

template <class Law, class Real>
BondWordLayout ColumnBody<Law, Real>::bond_word_layout() const {
  const PointLayout& l = domain_.layout();
  const auto& first = setup_.families.first;
  const std::int64_t row = first[static_cast<std::size_t>(l.first_column)];
  return {first.back(),
          (l.rows + block_rows - 1) / block_rows,
          row,
          first[static_cast<std::size_t>(l.first_column + l.column_count)] - row,
          l.first_row / block_rows,
          domain_.blocks()};
}

template <class Law, class Real>
Body::Saved ColumnBody<Law, Real>::save() const {
  Saved saved{u_, v_, {}, first_kick_pending_, 0, frame_};
  saved.external_work = work_.value(comm_) + comm_.all_reduce(work_before_, parallel::Reduce::max);
  saved.words.reserve(intact_.size());
  for (std::int32_t slot = 0; slot < domain_.layout().column_count; ++slot) {
    for (std::size_t b = 0; b < bonds_of({slot, 0}).size(); ++b) {
      for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
        saved.words.push_back(intact_[first_word({slot, block}) + b]);
      }
    }
  }
  return saved;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::restore(const Saved& saved) {
  u_ = saved.displacement;
  v_ = saved.leapfrog_velocity;
  first_kick_pending_ = saved.first_kick_pending;
  work_before_ = saved.external_work;
  frame_ = saved.frame;
  auto word = saved.words.begin();
  for (std::int32_t slot = 0; slot < domain_.layout().column_count; ++slot) {
    for (std::size_t b = 0; b < bonds_of({slot, 0}).size(); ++b) {
      for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
        std::uint16_t& mine = intact_[first_word({slot, block}) + b];
        intact_directed_ += std::popcount(*word) - std::popcount(mine);
        mine = *word++;
      }
    }
  }
  fill_padded();
}

}  // namespace

BodySetup make_setup(const Parameters& p, Lattice lattice, BondFamilies families, double time_step) {
  BodySetup setup;
  setup.layer = make_pressure_layer(p, lattice);
  setup.lattice = std::move(lattice);
  setup.families = std::move(families);
  setup.ends = end_condition(p);
  setup.end_length = *p.end_length;
  setup.density = p.density;
  setup.bond_constant = Pmb::bond_constant(p.young_modulus, *p.horizon);
  setup.critical_stretch = p.critical_stretch;
  setup.time_step = time_step;
  // Strain energy of the whole wall at the critical stretch: nothing that happens exceeds it by much.
  const double volume = static_cast<double>(setup.lattice.particles()) * setup.lattice.volume(0);
  setup.energy_scale = p.young_modulus * p.critical_stretch * p.critical_stretch * volume;
  setup.double_bonds = p.bond_precision == "double";
  return setup;
}

std::unique_ptr<Body> make_body(BodySetup setup, parallel::Communicator comm) {
  if (setup.double_bonds) return std::make_unique<ColumnBody<Pmb, double>>(std::move(setup), comm);
  return std::make_unique<ColumnBody<Pmb, float>>(std::move(setup), comm);
}

}  // namespace rhexis::peridynamics
