// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/general_body.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <stdexcept>
#include <utility>

#include "parallel/exact_sum.hpp"
#include "parallel/threads.hpp"
#include "peridynamics/engine/correspondence_kernel.hpp"
#include "peridynamics/engine/energy_account.hpp"
#include "peridynamics/laws/correspondence/wall_deformation.hpp"

namespace rhexis::peridynamics {
namespace {

/// What a thread gathers in one evaluation; in cache lines of its own.
struct alignas(128) EvaluationEvents {
  explicit EvaluationEvents(double energy_scale) : work(energy_scale), released(energy_scale) {}
  ExactSum work, released;  ///< J
  std::int64_t broken = 0;
  bool damaged = false;
};

template <class Law, class Real>
class GeneralBody final : public Body {
 public:
  GeneralBody(std::shared_ptr<const GeneralSetup> setup, parallel::Communicator comm)
      : setup_(std::move(setup)),
        comm_(comm),
        threads_(parallel::thread_count()),
        partition_(setup_->geometry->neighbours, comm),
        ids_(partition_.ids()),
        family_(*setup_->geometry, partition_),
        law_(std::get<Law>(setup_->law)),
        law_here_(law_, frames()),
        halo_(comm,
              partition_.halo(BlockPartition::Layer::known,
                              [](std::size_t block) {
                                return parallel::Run{quad * block * width, quad * width};
                              }),
              1),
        force_(3 * width * family_.slots() + 1, Real(0)),  // one more than load_triples uses
        account_(setup_->energy_scale) {
    const ParticleSet& set = setup_->geometry->particles;
    unit_ = set.spacing * set.spacing * law_.shear_modulus;
    const std::size_t known = width * partition_.known_blocks(),
                      evaluated = width * partition_.evaluated_blocks();
    for (std::size_t k = 0; k < 3; ++k) {
      u_[k].assign(particles(), 0.0);
      v_[k].assign(particles(), 0.0);
      sum_[k].assign(particles(), 0.0);
    }
    bond_u_.assign(quad * known, Real(0));
    for (auto& component : gradient_) component.assign(evaluated, Real(0));
    for (auto& component : own_force_) component.assign(evaluated, Real(0));
    for (std::size_t i = 0; i < particles(); ++i) {
      volumes_.push_back(set.volume[first_particle() + i]);
    }
    for (int t = 0; t < threads_; ++t) scratch_.emplace_back(family_.most_slots());
    place_load();
    for (std::size_t slot = 0; slot < owned_slots(); ++slot)
      initial_bonds_ += std::popcount(family_.words[slot]);
    intact_bonds_ = initial_bonds_;
  }

  const IdRanges& ids() const override { return ids_; }
  std::array<std::span<const double>, 3> displacement() const override { return {u_[0], u_[1], u_[2]}; }
  std::array<double, 3> reference_position(std::size_t particle) const override {
    return setup_->geometry->particles.at(first_particle() + particle);
  }
  std::vector<double> volumes() const override { return volumes_; }
  double largest_load() const override { return largest_load_; }
  bool has_wall_deformation() const override { return !setup_->geometry->particles.frame.empty(); }
  WallDeformation wall_deformation(std::size_t particle) const override;
  std::int64_t bonds() const override { return comm_.all_reduce(initial_bonds_, parallel::Reduce::sum) / 2; }
  std::int64_t bond_evaluations() const override { return bond_evaluations_; }
  parallel::Traffic traffic() const override { return halo_.traffic(); }

  void clear_held(std::array<std::vector<double>, 3>& field) const override {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = 0; i < particles(); ++i) {
        if (is_held(i, k)) field[k][i] = 0;
      }
    }
  }

  void set_state(const std::array<std::vector<double>, 3>& displacement,
                 const std::array<std::vector<double>, 3>& velocity) override {
    u_ = displacement;
    v_ = velocity;
    first_kick_pending_ = true;
    forces_known_ = false;
    load_moves_ = false;
    fill_bond_displacement();
  }

  void set_axial_profile(const std::function<double(double z)>& profile) override {
    profile_ = profile;
    place_load();
    forces_known_ = false;
  }

  StepEvents advance(double pressure, double next_pressure) override;
  void find_forces(double pressure) override { evaluate(pressure); }
  const std::array<std::vector<double>, 3>& force_density(double pressure) override;
  const Observation& observe(double pressure) override;
  Totals totals() const override;
  double max_displacement() const override;

  TablePart word_table() const override {
    // Slots of the whole body before this rank's: families are known everywhere.
    const Neighbours& all = setup_->geometry->neighbours;
    std::int64_t before = 0, total = 0;
    for (std::size_t first = 0; first < all.size(); first += width) {
      std::size_t longest = 0;
      for (std::size_t i = first; i < std::min(first + width, all.size()); ++i)
        longest = std::max(longest, all.family_size(i));
      if (first < first_particle()) before += static_cast<std::int64_t>(longest);
      total += static_cast<std::int64_t>(longest);
    }
    IdRanges rows{.global_count = total};
    rows.add({before, static_cast<std::int64_t>(owned_slots())});
    return {.rows = rows};
  }
  Saved save() const override;
  void restore(const Saved& saved) override;

 private:
  static constexpr std::size_t width = FamilyBlocks<Real>::width;

  std::size_t particles() const { return partition_.owned_particles(); }
  std::size_t first_particle() const {
    return static_cast<std::size_t>(partition_.first_block() * block_rows);
  }
  std::size_t owned_slots() const { return family_.first_slot(partition_.owned_blocks()); }
  double spacing() const { return setup_->geometry->particles.spacing; }
  /// eta of a bond, in spacings.
  Eigen::Vector3d extension(std::size_t particle, std::size_t other) const {
    return difference(bond_u_, particle, other);
  }
  bool is_held(std::size_t particle, std::size_t axis) const {
    return !setup_->held.empty() && (setup_->held[first_particle() + particle] >> axis & 1U) != 0;
  }

  std::vector<const WallFrame*> frames() const;
  void place_load();
  /// Calls use(last load of the block, lane, particle) for the owned particles of loaded blocks.
  template <class Self, class Use>
  static void for_each_loaded(Self& self, const Use& use) {
    for (std::size_t i = 0; i < self.particles(); ++i) {
      if (const std::int32_t place = self.load_of_[i / width]; place >= 0)
        use(self.last_loads_[static_cast<std::size_t>(place)], i % width, i);
    }
  }
  void find_reach(std::size_t block, std::size_t lane);
  Vector3 surface_step(std::size_t block, std::size_t lane) const;
  void share_words();
  void fill_bond_displacement();
  void evaluate(double pressure);
  void evaluate_share(std::size_t begin, std::size_t end, const KernelState<Real>& state, int thread,
                      EvaluationEvents& events);
  void add_load_work(std::size_t block, const BlockLoad<Real>& now, unsigned lanes, EvaluationEvents& events);
  Tensor<double> gradient_of(std::size_t particle) const;
  Tensor<double> evaluated_gradient(std::size_t particle) const;
  double energy_of(std::size_t particle, const Tensor<double>& h) const;

  std::shared_ptr<const GeneralSetup> setup_;
  parallel::Communicator comm_;
  int threads_;
  BlockPartition partition_;
  IdRanges ids_;
  FamilyBlocks<Real> family_;
  Law law_;
  typename Law::template AtParticles<Real> law_here_;  ///< at evaluated particles
  parallel::HaloExchange<Real> halo_;
  double unit_ = 0;                                  ///< N: mu h^2
  std::vector<double> volumes_;                      ///< m3, owned
  std::array<std::vector<double>, 3> u_, v_, sum_;   ///< m, m/s, N: forces at the present time
  std::vector<Real> bond_u_;                         ///< displacement in spacings, quads of known particles
  std::array<std::vector<Real>, 9> gradient_;        ///< H, evaluated particles
  std::vector<Real> force_;                          ///< T, [slots][16][3]
  std::array<std::vector<Real>, 3> own_force_;       ///< sum of T over the family, evaluated particles
  std::vector<BondScratch<Real>> scratch_;           ///< [threads]
  std::vector<BlockLoad<Real>> loads_, last_loads_;  ///< of blocks with a loaded surface
  std::vector<std::int32_t> load_of_;                ///< [evaluated blocks] place among loads_, or -1
  std::function<double(double)> profile_;
  double largest_load_ = 0;    ///< 1/m, force density for a pressure of 1
  bool load_moves_ = false;    ///< last_loads_ are of the moment before
  bool forces_known_ = false;  ///< of the present time, under known_pressure_
  double known_pressure_ = 0;
  bool first_kick_pending_ = true;
  WorkAccount account_;
  double load_speed_ = 0;  ///< m/s, what the load alone could have given to a particle
  std::int64_t initial_bonds_ = 0, intact_bonds_ = 0, bond_evaluations_ = 0, pending_broken_ = 0;
  bool damaged_ = false;
  Observation observation_;
  ObservedSums observed_{1};
  double ruptured_low_ = INFINITY, ruptured_high_ = -INFINITY;  ///< m, z
};

/// Where the evaluated particles are in the wall, by local number; null where no particle stands.
template <class Law, class Real>
std::vector<const WallFrame*> GeneralBody<Law, Real>::frames() const {
  std::vector<const WallFrame*> frames(width * partition_.evaluated_blocks(), nullptr);
  const ParticleSet& set = setup_->geometry->particles;
  if (set.frame.empty()) return frames;
  for (std::size_t b = 0; b < partition_.evaluated_blocks(); ++b) {
    const auto first = static_cast<std::size_t>(partition_.block(b)) * width;
    for (int lane = 0; lane < partition_.particles_in(partition_.block(b)); ++lane) {
      const auto i = static_cast<std::size_t>(lane);
      frames[b * width + i] = &set.frame[first + i];
    }
  }
  return frames;
}

/// Puts the loaded pieces of surface to their blocks.
template <class Law, class Real>
void GeneralBody<Law, Real>::place_load() {
  const ParticleSet& set = setup_->geometry->particles;
  const double h = spacing();
  loads_.clear();
  load_of_.assign(partition_.evaluated_blocks(), -1);
  std::map<std::int64_t, std::size_t> local;
  for (std::size_t b = 0; b < partition_.evaluated_blocks(); ++b) local[partition_.block(b)] = b;
  largest_load_ = 0;
  for (const SurfacePatch& patch : set.surface) {
    if (!patch.loaded) continue;
    const double area = std::hypot(patch.area[0], patch.area[1], patch.area[2]);
    largest_load_ = std::max(largest_load_, area / set.volume[patch.particle]);
    const auto found = local.find(static_cast<std::int64_t>(patch.particle / width));
    if (found == local.end()) continue;
    std::int32_t& place = load_of_[found->second];
    if (place < 0) {
      place = static_cast<std::int32_t>(loads_.size());
      loads_.emplace_back();
    }
    BlockLoad<Real>& load = loads_[static_cast<std::size_t>(place)];
    const std::size_t lane = patch.particle % width;
    if (load.area[0][lane] != 0 || load.area[1][lane] != 0 || load.area[2][lane] != 0)
      throw std::invalid_argument("a particle has more than one loaded piece of surface");
    const double share = profile_ ? profile_(set.position[2][patch.particle]) : 1;
    for (std::size_t k = 0; k < 3; ++k) {
      load.area[k][lane] += static_cast<Real>(share * patch.area[k] / (h * h));
      load.offset[k][lane] = static_cast<Real>(patch.offset[k] / h);
    }
    find_reach(found->second, lane);
  }
  last_loads_ = loads_;
  load_moves_ = false;
}

/// Finds how a loaded piece of surface moves with the bonds that its particle has left.
template <class Law, class Real>
void GeneralBody<Law, Real>::find_reach(std::size_t block, std::size_t lane) {
  BlockLoad<Real>& load = loads_[static_cast<std::size_t>(load_of_[block])];
  const Eigen::Vector3d offset(double{load.offset[0][lane]}, double{load.offset[1][lane]},
                               double{load.offset[2][lane]});
  const Eigen::Vector3d reach = family_.inverse_moment(block * width + lane) * offset;
  for (std::size_t k = 0; k < 3; ++k)
    load.reach[k][lane] = static_cast<Real>(reach[static_cast<Eigen::Index>(k)]);
}

/// Where a loaded piece of surface has moved to, in spacings.
template <class Law, class Real>
Vector3 GeneralBody<Law, Real>::surface_step(std::size_t block, std::size_t lane) const {
  const BlockLoad<Real>& load = loads_[static_cast<std::size_t>(load_of_[block])];
  const std::size_t i = block * width + lane;
  const Eigen::Vector3d reach(double{load.reach[0][lane]}, double{load.reach[1][lane]},
                              double{load.reach[2][lane]});
  Vector3 step{double{bond_u_[quad * i]}, double{bond_u_[quad * i + 1]}, double{bond_u_[quad * i + 2]}};
  for (std::size_t slot = family_.first_slot(block); slot < family_.first_slot(block + 1); ++slot) {
    if ((family_.words[slot] >> lane & 1U) == 0) continue;
    const auto j = family_.other_end(slot * width + lane);
    const double share = double{family_.weight[slot * width + lane]} * family_.bond(i, j).dot(reach);
    const Eigen::Vector3d eta = extension(i, j);
    for (std::size_t k = 0; k < 3; ++k) step[k] += share * eta[static_cast<Eigen::Index>(k)];
  }
  return step;
}

template <class Law, class Real>
void GeneralBody<Law, Real>::fill_bond_displacement() {
  for (std::size_t k = 0; k < 3; ++k) {
    for (std::size_t i = 0; i < particles(); ++i)
      bond_u_[quad * i + k] = static_cast<Real>(u_[k][i] / spacing());
  }
}

/// H of a particle from the bonds that are left, as the kernel has it.
template <class Law, class Real>
Tensor<double> GeneralBody<Law, Real>::gradient_of(std::size_t i) const {
  Eigen::Matrix3d slope, h = Eigen::Matrix3d::Zero();
  for (int k = 0; k < 9; ++k) slope(k / 3, k % 3) = double{family_.slope[static_cast<std::size_t>(k)][i]};
  const std::size_t block = i / width;
  for (std::size_t slot = family_.first_slot(block); slot < family_.first_slot(block + 1); ++slot) {
    if ((family_.words[slot] >> (i % width) & 1U) == 0) continue;
    const std::size_t bond = slot * width + i % width;
    const auto j = family_.other_end(bond);
    h += double{family_.weight[bond]} * extension(i, j) *
         (slope * family_.bond(i, j) + double{family_.volume[i]} * family_.multiplier_step(i, j)).transpose();
  }
  return {h(0, 0), h(0, 1), h(0, 2), h(1, 0), h(1, 1), h(1, 2), h(2, 0), h(2, 1), h(2, 2)};
}

/// H as last evaluated.
template <class Law, class Real>
Tensor<double> GeneralBody<Law, Real>::evaluated_gradient(std::size_t i) const {
  const std::array<std::vector<Real>, 9>& g = gradient_;
  return {double{g[0][i]}, double{g[1][i]}, double{g[2][i]}, double{g[3][i]}, double{g[4][i]},
          double{g[5][i]}, double{g[6][i]}, double{g[7][i]}, double{g[8][i]}};
}

template <class Law, class Real>
WallDeformation GeneralBody<Law, Real>::wall_deformation(std::size_t i) const {
  const WallFrame& frame = setup_->geometry->particles.frame[first_particle() + i];
  WallDeformation wall;
  wall.gradient = evaluated_gradient(i);
  const Deformation<double> f(wall.gradient);
  wall.stress = product(double{family_.strength[i]} * law_.shear_modulus, law_here_.stress(f, i));
  wall.hoop = frame.along_wall(0);
  wall.axial = {double{frame.axial[0]}, double{frame.axial[1]}, double{frame.axial[2]}};
  wall.fibre_stretch = law_here_.fibre_stretch(f, i);
  return wall;
}

/// Energy of an evaluated particle (J) whose gradient is `h`.
template <class Law, class Real>
double GeneralBody<Law, Real>::energy_of(std::size_t i, const Tensor<double>& h) const {
  const double stressed = double{family_.strength[i]} * double{family_.volume[i]};
  if (stressed == 0) return 0;
  Eigen::Matrix3d gradient;
  gradient << h.xx, h.xy, h.xz, h.yx, h.yy, h.yz, h.zx, h.zy, h.zz;
  const std::size_t block = i / width;
  double deviation = 0;
  for (std::size_t slot = family_.first_slot(block); slot < family_.first_slot(block + 1); ++slot) {
    if ((family_.words[slot] >> (i % width) & 1U) == 0) continue;
    const std::size_t bond = slot * width + i % width;
    const auto j = family_.other_end(bond);
    const Eigen::Vector3d xi = family_.bond(i, j);
    deviation +=
        double{family_.weight[bond]} * (extension(i, j) - gradient * xi).squaredNorm() / xi.squaredNorm();
  }
  const double penalty = penalty_factor * law_here_.template shear_modulus<double>(i) *
                         double{family_.inverse_weight[i]} * deviation;
  const double relative = stressed * (law_here_.energy(Deformation<double>(h), i) + penalty);
  return relative * unit_ * spacing();
}

/// Adds the work of the surface's pieces in `lanes` since the moment before to `events`.
template <class Law, class Real>
void GeneralBody<Law, Real>::add_load_work(std::size_t block, const BlockLoad<Real>& now, unsigned lanes,
                                           EvaluationEvents& events) {
  const BlockLoad<Real>& last = last_loads_[static_cast<std::size_t>(load_of_[block])];
  for (; lanes != 0; lanes &= lanes - 1) {
    const auto lane = static_cast<std::size_t>(std::countr_zero(lanes));
    double work = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      work += 0.5 * (double{now.force[k][lane]} + double{last.force[k][lane]}) *
              (double{now.step[k][lane]} - double{last.step[k][lane]});
    }
    events.work.add(work * unit_ * spacing());
  }
}

template <class Law, class Real>
void GeneralBody<Law, Real>::evaluate_share(std::size_t begin, std::size_t end,
                                            const KernelState<Real>& state, int thread,
                                            EvaluationEvents& events) {
  for (std::size_t block = begin; block < end; ++block) {
    const bool owned = block < partition_.owned_blocks();
    BlockLoad<Real>* const load =
        load_of_[block] < 0 ? nullptr : &loads_[static_cast<std::size_t>(load_of_[block])];
    unsigned moved = load_moves_ && owned && load != nullptr ? 0xffffU : 0;
    // Where bonds break the gradient jumps, and with it the place of the surface; no work is done by that.
    const auto before = [&](std::size_t, unsigned lanes) {
      if (!owned) return;
      for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
        const std::size_t lane = static_cast<std::size_t>(std::countr_zero(rest)), i = block * width + lane;
        events.released.add(energy_of(i, gradient_of(i)));
        if ((moved >> lane & 1U) == 0) continue;
        BlockLoad<Real> then = last_loads_[static_cast<std::size_t>(load_of_[block])];
        const Vector3 step = surface_step(block, lane);
        for (std::size_t k = 0; k < 3; ++k) then.step[k][lane] = static_cast<Real>(step[k]);
        add_load_work(block, then, 1U << lane, events);
      }
      moved &= ~lanes;
    };
    const auto after = [&](std::size_t, unsigned lanes) {
      for (unsigned rest = lanes; rest != 0; rest &= rest - 1) {
        const std::size_t lane = static_cast<std::size_t>(std::countr_zero(rest)), i = block * width + lane;
        if (load != nullptr) find_reach(block, lane);
        if (!owned) continue;
        events.released.add(-energy_of(i, gradient_of(i)));
        events.damaged = events.damaged || family_.damage[i] >= rupture_damage;
      }
    };
    const int broken =
        evaluate_block(law_here_, family_, state, block, load, scratch_[static_cast<std::size_t>(thread)],
                       force_.data(), own_force_, gradient_, before, after);
    if (!owned) continue;
    events.broken += broken;
    if (load == nullptr) continue;
    add_load_work(block, *load, moved, events);
    last_loads_[static_cast<std::size_t>(load_of_[block])] = *load;
  }
}

/// Forces at the present time.
template <class Law, class Real>
void GeneralBody<Law, Real>::evaluate(double pressure) {
  if (forces_known_ && pressure == known_pressure_) return;
  const std::array<Real*, 1> u{bond_u_.data()};
  halo_.start(u);
  halo_.finish(u);
  const KernelState<Real> state{bond_u_.data(), static_cast<Real>(t_of_stretch(setup_->critical_stretch)),
                                static_cast<Real>(pressure / law_.shear_modulus), setup_->follower_load};
  std::vector<EvaluationEvents> per_thread(static_cast<std::size_t>(threads_),
                                           EvaluationEvents(setup_->energy_scale));
  parallel::for_each_share(
      threads_, partition_.evaluated_blocks(), [&](int thread, std::size_t begin, std::size_t end) {
        evaluate_share(begin, end, state, thread, per_thread[static_cast<std::size_t>(thread)]);
      });
  parallel::for_each_share(threads_, partition_.owned_blocks(), [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; ++block) {
      alignas(64) Real sum[3][16];
      sum_forces(family_, block, force_.data(), own_force_, sum);
      const BlockLoad<Real>* const load =
          load_of_[block] < 0 ? nullptr : &loads_[static_cast<std::size_t>(load_of_[block])];
      const std::size_t past = std::min(width, particles() - block * width);
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t lane = 0; lane < past; ++lane) {
          const double force = double{sum[k][lane]} + (load != nullptr ? double{load->force[k][lane]} : 0.0);
          sum_[k][block * width + lane] = unit_ * force;
        }
      }
    }
  });
  for (const EvaluationEvents& events : per_thread) {
    account_.add_work(events.work);
    account_.add_released(events.released);
    pending_broken_ += events.broken;
    intact_bonds_ -= events.broken;
    damaged_ = damaged_ || events.damaged;
  }
  bond_evaluations_ += intact_bonds_;
  load_moves_ = true;
  forces_known_ = true;
  known_pressure_ = pressure;
}

template <class Law, class Real>
StepEvents GeneralBody<Law, Real>::advance(double pressure, double /*next_pressure*/) {
  evaluate(pressure);
  const double dt = setup_->time_step, kick = first_kick_pending_ ? 0.5 * dt : dt;
  load_speed_ += dt * std::abs(pressure) * largest_load_ / setup_->density;
  const double fastest = 2 * spacing() / dt + 4 * load_speed_;
  std::vector<int> too_fast(static_cast<std::size_t>(threads_), 0);
  parallel::for_each_share(threads_, particles(), [&](int thread, std::size_t begin, std::size_t end) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t i = begin; i < end; ++i) {
        if (is_held(i, k)) continue;
        double& v = v_[k][i];
        v += kick * sum_[k][i] / (setup_->density * volumes_[i]);
        u_[k][i] += dt * v;
        too_fast[static_cast<std::size_t>(thread)] += std::abs(v) < fastest ? 0 : 1;
        bond_u_[quad * i + k] = static_cast<Real>(u_[k][i] / spacing());
      }
    }
  });
  first_kick_pending_ = false;
  forces_known_ = false;
  return {.broken = std::exchange(pending_broken_, 0),
          .damaged = damaged_,
          .unstable = std::ranges::any_of(too_fast, [](int count) { return count > 0; })};
}

template <class Law, class Real>
const std::array<std::vector<double>, 3>& GeneralBody<Law, Real>::force_density(double pressure) {
  evaluate(pressure);
  for (std::size_t k = 0; k < 3; ++k) {
    observation_.force_density[k].resize(particles());
    for (std::size_t i = 0; i < particles(); ++i) observation_.force_density[k][i] = sum_[k][i] / volumes_[i];
  }
  return observation_.force_density;
}

template <class Law, class Real>
const Observation& GeneralBody<Law, Real>::observe(double pressure) {
  force_density(pressure);
  for (std::vector<double>& component : observation_.velocity) component.resize(particles());
  observation_.strain_energy_density.resize(particles());
  observation_.damage.resize(particles());
  const double kick = first_kick_pending_ ? 0 : 0.5 * setup_->time_step;
  std::vector<ObservedSums> sums(static_cast<std::size_t>(threads_), ObservedSums(setup_->energy_scale));
  std::vector<std::pair<double, double>> ruptured(sums.size(), {INFINITY, -INFINITY});
  parallel::for_each_share(threads_, particles(), [&](int thread, std::size_t begin, std::size_t end) {
    ObservedSums& sum = sums[static_cast<std::size_t>(thread)];
    auto& [low, high] = ruptured[static_cast<std::size_t>(thread)];
    for (std::size_t i = begin; i < end; ++i) {
      double speed2 = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        const double force = observation_.force_density[k][i];
        const double v = v_[k][i] + (is_held(i, k) ? 0.0 : kick * force / setup_->density);
        observation_.velocity[k][i] = v;
        speed2 += v * v;
      }
      const double energy = energy_of(i, evaluated_gradient(i));
      observation_.strain_energy_density[i] = energy / volumes_[i];
      observation_.damage[i] = family_.damage[i];
      sum.kinetic.add(0.5 * setup_->density * volumes_[i] * speed2);
      sum.strain.add(energy);
      sum.max_damage = std::max(sum.max_damage, family_.damage[i]);
      if (family_.damage[i] >= rupture_damage) {
        const double z = setup_->geometry->particles.position[2][first_particle() + i];
        low = std::min(low, z);
        high = std::max(high, z);
      }
    }
  });
  observed_ = sums.front();
  for (std::size_t t = 1; t < sums.size(); ++t) observed_.add(sums[t]);
  ruptured_low_ = INFINITY, ruptured_high_ = -INFINITY;
  for (const auto& [low, high] : ruptured) {
    ruptured_low_ = std::min(ruptured_low_, low);
    ruptured_high_ = std::max(ruptured_high_, high);
  }
  damaged_ = damaged_ || observed_.max_damage >= rupture_damage;
  return observation_;
}

template <class Law, class Real>
Totals GeneralBody<Law, Real>::totals() const {
  Totals totals;
  totals.kinetic = observed_.kinetic.value(comm_);
  totals.strain = observed_.strain.value(comm_);
  totals.fracture = account_.released(comm_);
  totals.external_work = account_.work(comm_);
  totals.lost = account_.lost();
  totals.max_displacement = max_displacement();
  totals.max_damage = comm_.all_reduce(observed_.max_damage, parallel::Reduce::max);
  totals.broken_bonds = comm_.all_reduce(initial_bonds_ - intact_bonds_, parallel::Reduce::sum) / 2;
  const double low = comm_.all_reduce(ruptured_low_, parallel::Reduce::min);
  const double high = comm_.all_reduce(ruptured_high_, parallel::Reduce::max);
  if (high >= low) totals.rupture_length = high - low + spacing();
  return totals;
}

template <class Law, class Real>
double GeneralBody<Law, Real>::max_displacement() const {
  double largest = 0;
  for (std::size_t i = 0; i < particles(); ++i)
    largest = std::max(largest, u_[0][i] * u_[0][i] + u_[1][i] * u_[1][i] + u_[2][i] * u_[2][i]);
  return std::sqrt(comm_.all_reduce(largest, parallel::Reduce::max));
}

template <class Law, class Real>
Body::Saved GeneralBody<Law, Real>::save() const {
  std::array<std::vector<double>, 6> surface;
  for (std::vector<double>& component : surface) component.assign(particles(), 0.0);
  for_each_loaded(*this, [&](const BlockLoad<Real>& load, std::size_t lane, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      surface[k][i] = load.force[k][lane];
      surface[3 + k][i] = load.step[k][lane];
    }
  });
  return {
      .displacement = u_,
      .leapfrog_velocity = v_,
      .words = {family_.words.begin(), family_.words.begin() + static_cast<std::ptrdiff_t>(owned_slots())},
      .first_kick_pending = first_kick_pending_,
      .external_work = account_.work_parts(comm_),
      .released_energy = account_.released_parts(comm_),
      .load_speed = load_speed_,
      .surface = std::move(surface)};
}

/// Sends the words of owned blocks to the ranks that evaluate them too.
template <class Law, class Real>
void GeneralBody<Law, Real>::share_words() {
  std::vector<float> words(family_.words.begin(), family_.words.end());  // 16 bits fit exactly
  parallel::HaloExchange<float> exchange(
      comm_,
      partition_.halo(BlockPartition::Layer::evaluated,
                      [&](std::size_t block) {
                        return parallel::Run{family_.first_slot(block), family_.slots(block)};
                      }),
      1);
  const std::array<float*, 1> field{words.data()};
  exchange.start(field);
  exchange.finish(field);
  for (std::size_t slot = owned_slots(); slot < words.size(); ++slot)
    family_.words[slot] = static_cast<std::uint16_t>(words[slot]);
}

template <class Law, class Real>
void GeneralBody<Law, Real>::restore(const Saved& saved) {
  u_ = saved.displacement;
  v_ = saved.leapfrog_velocity;
  first_kick_pending_ = saved.first_kick_pending;
  account_.restore(saved.external_work, saved.released_energy, comm_);
  load_speed_ = saved.load_speed;
  std::copy(saved.words.begin(), saved.words.end(), family_.words.begin());
  share_words();
  intact_bonds_ = 0;
  for (std::size_t slot = 0; slot < owned_slots(); ++slot)
    intact_bonds_ += std::popcount(family_.words[slot]);
  for (std::size_t block = 0; block < partition_.evaluated_blocks(); ++block) family_.update(block, 0xffff);
  place_load();
  for_each_loaded(*this, [&](BlockLoad<Real>& load, std::size_t lane, std::size_t i) {
    for (std::size_t k = 0; k < 3; ++k) {
      load.force[k][lane] = static_cast<Real>(saved.surface[k][i]);
      load.step[k][lane] = static_cast<Real>(saved.surface[3 + k][i]);
    }
  });
  fill_bond_displacement();
  forces_known_ = false;
  load_moves_ = !first_kick_pending_;
}

}  // namespace

std::unique_ptr<Body> make_body(std::shared_ptr<const GeneralSetup> setup, parallel::Communicator comm) {
  return std::visit(
      [&]<class Law>(const Law&) -> std::unique_ptr<Body> {
        if (setup->double_bonds) return std::make_unique<GeneralBody<Law, double>>(setup, comm);
        return std::make_unique<GeneralBody<Law, float>>(setup, comm);
      },
      setup->law);
}

}  // namespace rhexis::peridynamics
