// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/tree/tree_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr int most_top = 12, most_middle = 11, usual_bottom = 11;
constexpr std::size_t subtrees_between_pauses = 32;

}  // namespace

std::vector<network::BoundaryCondition> conditions_of(const TreeBoundary& b, std::uint32_t inlet,
                                                      std::uint32_t outlet) {
  using Kind = network::BoundaryCondition::Kind;
  const auto at = [](std::uint32_t junction, std::optional<double> pressure, double flow) {
    return pressure ? network::BoundaryCondition{junction, Kind::pressure, *pressure, 0}
                    : network::BoundaryCondition{junction, Kind::flow, flow, 0};
  };
  return {at(inlet, b.inlet_pressure, b.flow.value_or(0)),
          at(outlet, b.outlet_pressure, -b.flow.value_or(0))};
}

TreeFlow::TreeFlow(const network::TreePair& tree, const Viscosity& viscosity, const TreeBoundary& boundary,
                   parallel::Communicator comm, bool one_by_one)
    : tree_(tree),
      boundary_(boundary),
      law_(tree_, viscosity),
      comm_(comm),
      alike_(tree.rules().repeats() && !one_by_one) {
  const int pressures = boundary.inlet_pressure.has_value() + boundary.outlet_pressure.has_value();
  if (pressures + boundary.flow.has_value() != 2 || pressures == 0) {
    throw InputError("a tree needs two of inlet pressure, outlet pressure and inlet flow");
  }
  const int k = tree.generations();
  if (alike_) {
    rise_alike();
  } else {
    bottom_depth_ = std::min(k, std::max(usual_bottom, k - most_top - most_middle));
    top_depth_ = std::min(k - bottom_depth_, most_top);
    middle_depth_ = k - bottom_depth_ - top_depth_;
    const auto rank = static_cast<std::size_t>(comm.rank()), ranks = static_cast<std::size_t>(comm.size());
    first_branch_ = branches() * rank / ranks;
    past_branch_ = branches() * (rank + 1) / ranks;
    rise_branches();
  }
  const double inlet = boundary.inlet_pressure.value_or(0), outlet = boundary.outlet_pressure.value_or(0);
  root_.flow = boundary.flow ? *boundary.flow : (inlet - outlet) / resistance_;
  root_.artery_pressure = boundary.inlet_pressure ? inlet : outlet + root_.flow * resistance_;
  root_.vein_pressure = boundary.outlet_pressure ? outlet : inlet - root_.flow * resistance_;
  if (!alike_) top_->fall(root_);
}

double TreeFlow::bytes(int generations, int ranks) {
  constexpr double subtrees_and_tables = 40e6;  // of a rank; measured
  const double bottoms = std::ldexp(1.0, std::max(0, generations - usual_bottom));
  return ranks * subtrees_and_tables + bottoms * sizeof(double);
}

/// One vessel a generation, from the last upwards.
void TreeFlow::rise_alike() {
  const int k = tree_.generations();
  alike_below_.resize(static_cast<std::size_t>(k));
  Subtree vessel(law_, 1, true);
  for (int g = k - 1; g >= 0; --g) {
    const auto at = static_cast<std::size_t>(g);
    vessel.grow(std::uint64_t{1} << g, std::ldexp(1.0, -g));
    alike_below_[at] = vessel.artery_resistance(1) + vessel.vein_resistance(1) +
                       (g == k - 1 ? 0.0 : alike_below_[at + 1] / 2);
  }
  resistance_ = alike_below_[0];
}

/// Calls work(thread, middle, bottom, branch) for this rank's branches, by all threads, each with subtrees of
/// its own.
template <class Work>
void TreeFlow::for_each_branch(const Work& work) const {
  const int threads = parallel::thread_count();
  std::vector<std::unique_ptr<Subtree>> middle, bottom;
  for (int t = 0; t < threads; ++t) {
    middle.push_back(std::make_unique<Subtree>(law_, middle_depth_, true));
    bottom.push_back(std::make_unique<Subtree>(law_, bottom_depth_, false));
  }
  parallel::for_each_task(threads, past_branch_ - first_branch_, [&](int thread, std::size_t i) {
    const auto t = static_cast<std::size_t>(thread);
    work(thread, *middle[t], *bottom[t], first_branch_ + i);
  });
}

void TreeFlow::rise_branches() {
  top_ = std::make_unique<Subtree>(law_, top_depth_, true);
  top_->grow(1, 1.0);
  bottom_resistance_.resize((past_branch_ - first_branch_) << middle_depth_);
  std::vector<double> resistance(branches(), 0.0);
  for_each_branch([&](int, Subtree& middle, Subtree& bottom, std::size_t branch) {
    resistance[branch] = rise_branch(middle, bottom, branch);
  });
  comm_.all_reduce(resistance,
                   parallel::Reduce::sum);  // exact: every branch has one owner, the others add zero
  std::copy(resistance.begin(), resistance.end(), top_->daughter_resistances());
  resistance_ = top_->rise();
}

double TreeFlow::rise_branch(Subtree& middle, Subtree& bottom, std::size_t branch) {
  const SubtreeState start = branch_state(branch);
  middle.grow(start.place, start.capacity);
  const std::size_t count = std::size_t{1} << middle_depth_;
  double* resistance = bottom_resistance_.data() + (branch - first_branch_) * count;
  for (std::size_t i = 0; i < count; ++i) {
    const SubtreeState below = middle.daughter(i);
    bottom.grow(below.place, below.capacity);
    resistance[i] = bottom.rise();
  }
  std::copy_n(resistance, count, middle.daughter_resistances());
  return middle.rise();
}

/// Resistances of a branch's middle generations, from those of its bottom subtrees.
void TreeFlow::grow_middle(Subtree& middle, std::size_t branch) const {
  const SubtreeState start = branch_state(branch);
  middle.grow(start.place, start.capacity);
  const std::size_t count = std::size_t{1} << middle_depth_;
  std::copy_n(bottom_resistance_.data() + (branch - first_branch_) * count, count,
              middle.daughter_resistances());
  middle.rise();
  middle.fall(start);
}

void TreeFlow::sweep_branch(Subtree& middle, Subtree& bottom, std::size_t branch,
                            VesselConsumer& consumer) const {
  grow_middle(middle, branch);
  for (int l = 0; l < middle_depth_; ++l) consumer.consume(middle.block(l, true));
  for (std::size_t i = 0; i < std::size_t{1} << middle_depth_; ++i) {
    const SubtreeState state = middle.daughter(i);
    bottom.grow(state.place, state.capacity);
    bottom.rise();
    bottom.fall(state);
    for (int l = 0; l < bottom_depth_; ++l) consumer.consume(bottom.block(l, true));
    if (i % subtrees_between_pauses == subtrees_between_pauses - 1) consumer.pause();
  }
  consumer.pause();
}

void TreeFlow::sweep(const std::function<VesselConsumer&(int thread)>& consumer_of) const {
  if (alike_) {
    if (comm_.is_root()) sweep_alike(consumer_of(0));
    return;
  }
  if (comm_.is_root()) {
    for (int l = 0; l < top_depth_; ++l) consumer_of(0).consume(top_->block(l, true));
    consumer_of(0).pause();
  }
  for_each_branch([&](int thread, Subtree& middle, Subtree& bottom, std::size_t branch) {
    sweep_branch(middle, bottom, branch, consumer_of(thread));
  });
}

void TreeFlow::sweep_alike(VesselConsumer& consumer) const {
  Subtree vessel(law_, 1, true);
  SubtreeState state = root_;
  for (int g = 0; g < tree_.generations(); ++g) {
    state.place = std::uint64_t{1} << g;
    state.capacity = std::ldexp(1.0, -g);
    vessel.grow(state.place, state.capacity);
    vessel.daughter_resistances()[0] = vessel.daughter_resistances()[1] = 1;
    vessel.rise();
    vessel.fall(state);
    VesselBlock block = vessel.block(0, true);
    block.multiplicity = std::ldexp(1.0, g);
    consumer.consume(block);
    state = vessel.daughter(0);
  }
  consumer.pause();
}

/// Finds single places; keeps the subtrees that it grew last.
class TreeFlow::Reader {
 public:
  explicit Reader(const TreeFlow& flow)
      : flow_(flow),
        middle_(flow.law_, flow.middle_depth_, true),
        bottom_(flow.law_, flow.bottom_depth_, false) {}

  struct Found {
    const Subtree* subtree = nullptr;  ///< null on ranks that do not have the place
    std::size_t n = 0;                 ///< local place in it
  };

  Found find(std::uint64_t place) {
    const int generation = network::TreePair::generation_of(place);
    const int middle_generation = flow_.top_depth_,
              bottom_generation = middle_generation + flow_.middle_depth_;
    if (generation < middle_generation) return flow_.comm_.is_root() ? within(*flow_.top_, place) : Found{};
    const auto branch =
        static_cast<std::size_t>((place >> (generation - middle_generation)) - flow_.branches());
    if (!flow_.owns(branch)) return {};
    if (!grown_ || branch != branch_) {
      flow_.grow_middle(middle_, branch);
      grown_ = true;
      branch_ = branch;
      bottom_place_ = 0;
    }
    if (generation < bottom_generation) return within(middle_, place);
    const std::uint64_t bottom_place = place >> (generation - bottom_generation);
    if (bottom_place != bottom_place_) {
      const SubtreeState state =
          middle_.daughter(static_cast<std::size_t>(bottom_place - (middle_.place() << middle_.depth())));
      bottom_.grow(state.place, state.capacity);
      bottom_.rise();
      bottom_.fall(state);
      bottom_place_ = bottom_place;
    }
    return within(bottom_, place);
  }

 private:
  static Found within(const Subtree& subtree, std::uint64_t place) {
    const int l = network::TreePair::generation_of(place) - network::TreePair::generation_of(subtree.place());
    return {&subtree, static_cast<std::size_t>(place - (subtree.place() << l) + (std::uint64_t{1} << l))};
  }

  const TreeFlow& flow_;
  Subtree middle_, bottom_;
  bool grown_ = false;
  std::size_t branch_ = 0;
  std::uint64_t bottom_place_ = 0;
};

std::vector<PlaceFlow> TreeFlow::at(const std::vector<std::uint64_t>& places) const {
  if (alike_) return at_alike(places);
  std::vector<double> values(5 * places.size(), 0.0);
  Reader reader(*this);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (const auto found = reader.find(places[i]); found.subtree) {
      found.subtree->state_of(found.n, values.data() + 5 * i);
    }
  }
  comm_.all_reduce(values, parallel::Reduce::sum);  // exact: every place has one owner
  std::vector<PlaceFlow> flows;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double* v = values.data() + 5 * i;
    flows.push_back({v[0], v[1], v[2], v[3], v[4]});
  }
  return flows;
}

std::vector<PlaceFlow> TreeFlow::at_alike(const std::vector<std::uint64_t>& places) const {
  struct Keeper : VesselConsumer {
    std::vector<PlaceFlow> generations;
    void consume(const VesselBlock& b) override {
      generations.push_back({*b.flow, *b.artery_near, *b.artery_far, *b.vein_near, *b.vein_far});
    }
  } keeper;
  sweep_alike(keeper);
  std::vector<PlaceFlow> flows;
  for (const std::uint64_t place : places) {
    flows.push_back(keeper.generations[static_cast<std::size_t>(network::TreePair::generation_of(place))]);
  }
  return flows;
}

VesselFlow TreeFlow::query(std::uint64_t id) const {
  if (id >= tree_.vessels()) tree_.vessel(id);  // throws
  const PlaceFlow p = at({network::TreePair::place_of(id)}).front();
  if (network::TreePair::kind_of(id) == network::VesselKind::artery)
    return {p.flow, p.artery_near, p.artery_far};
  return {p.flow, p.vein_far, p.vein_near};
}

TreeFlow::Path TreeFlow::path_to(std::uint64_t place) const {
  const auto length = static_cast<std::size_t>(network::TreePair::generation_of(place)) + 1;
  const bool last_generation = static_cast<int>(length) == tree_.generations();
  std::vector<double> artery(length, 0.0), vein(length, 0.0), beside(length, 0.0);
  if (alike_) {
    Subtree vessel(law_, 1, true);
    for (std::size_t g = 0; g < length; ++g) {
      vessel.grow(std::uint64_t{1} << g, std::ldexp(1.0, -static_cast<int>(g)));
      artery[g] = vessel.artery_resistance(1);
      vein[g] = vessel.vein_resistance(1);
      if (g + 1 < alike_below_.size()) beside[g] = alike_below_[g + 1] / (g + 1 < length ? 1 : 2);
    }
  } else {
    Reader reader(*this);
    for (std::size_t g = 0; g < length; ++g) {
      const auto [subtree, n] = reader.find(place >> (length - 1 - g));
      if (!subtree) continue;
      artery[g] = subtree->artery_resistance(n);
      vein[g] = subtree->vein_resistance(n);
    }
    for (std::size_t g = 0; g + 1 < length; ++g) {
      const std::uint64_t sister = (place >> (length - 2 - g)) ^ 1;
      if (const auto found = reader.find(sister); found.subtree) beside[g] = found.subtree->below(found.n);
    }
    for (std::uint64_t daughter = 2 * place; !last_generation && daughter < 2 * place + 2; ++daughter) {
      // Two in parallel: conductances add.
      if (const auto found = reader.find(daughter); found.subtree)
        beside[length - 1] += 1 / found.subtree->below(found.n);
    }
    for (auto* values : {&artery, &vein, &beside}) comm_.all_reduce(*values, parallel::Reduce::sum);
    if (!last_generation) beside[length - 1] = 1 / beside[length - 1];
  }
  Path path{std::move(artery), std::move(vein), std::move(beside), 0};
  path.below = path.beside.back();
  path.beside.pop_back();
  return path;
}

}  // namespace rhexis::hemodynamics
