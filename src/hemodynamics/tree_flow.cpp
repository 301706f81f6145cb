#include "hemodynamics/tree_flow.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"
#include "parallel/threads.hpp"

namespace rhexis::hemodynamics {
namespace {

constexpr int most_top = 12, most_middle = 11, usual_bottom = 11;

}  // namespace

TreeFlow::TreeFlow(const network::TreePair& tree, const Viscosity& viscosity, const TreeBoundary& boundary,
                   parallel::Communicator comm)
    : tree_(tree), law_(tree, viscosity), comm_(comm), alike_(tree.rules().repeats()) {
  const int pressures = boundary.inlet_pressure.has_value() + boundary.outlet_pressure.has_value();
  if (pressures + boundary.flow.has_value() != 2 || pressures == 0) {
    throw InputError("a tree needs two of inlet pressure, outlet pressure and inlet flow");
  }
  const int k = tree.generations();
  if (alike_) {
    // One subtree of one vessel a generation, from the last upwards.
    alike_below_.resize(static_cast<std::size_t>(k));
    Subtree vessel(law_, 1, true);
    for (int g = k - 1; g >= 0; --g) {
      vessel.grow(std::uint64_t{1} << g, std::ldexp(1.0, -g));
      const bool last = g == k - 1;
      alike_below_[static_cast<std::size_t>(g)] =
          vessel.artery_resistance(1) + vessel.vein_resistance(1) +
          (last ? 0.0 : alike_below_[static_cast<std::size_t>(g) + 1] / 2);
    }
    resistance_ = alike_below_[0];
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

void TreeFlow::rise_branches() {
  top_ = std::make_unique<Subtree>(law_, top_depth_, true);
  top_->grow(1, 1.0);
  bottom_resistance_.resize((past_branch_ - first_branch_) << middle_depth_);
  std::vector<double> resistance(branches(), 0.0);
  const int threads = parallel::thread_count();
  std::vector<std::unique_ptr<Subtree>> middle, bottom;
  for (int t = 0; t < threads; ++t) {
    middle.push_back(std::make_unique<Subtree>(law_, middle_depth_, true));
    bottom.push_back(std::make_unique<Subtree>(law_, bottom_depth_, false));
  }
  parallel::for_each_task(threads, past_branch_ - first_branch_, [&](int thread, std::size_t i) {
    const auto t = static_cast<std::size_t>(thread);
    resistance[first_branch_ + i] = rise_branch(*middle[t], *bottom[t], first_branch_ + i);
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
  }
}

void TreeFlow::sweep(const std::function<VesselConsumer&(int thread)>& consumer_of) const {
  if (alike_) {
    if (comm_.is_root()) sweep_alike(consumer_of(0));
    return;
  }
  if (comm_.is_root()) {
    for (int l = 0; l < top_depth_; ++l) consumer_of(0).consume(top_->block(l, true));
  }
  const int threads = parallel::thread_count();
  std::vector<std::unique_ptr<Subtree>> middle, bottom;
  for (int t = 0; t < threads; ++t) {
    middle.push_back(std::make_unique<Subtree>(law_, middle_depth_, true));
    bottom.push_back(std::make_unique<Subtree>(law_, bottom_depth_, false));
  }
  parallel::for_each_task(threads, past_branch_ - first_branch_, [&](int thread, std::size_t i) {
    const auto t = static_cast<std::size_t>(thread);
    sweep_branch(*middle[t], *bottom[t], first_branch_ + i, consumer_of(thread));
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
}

/// Calls visit(subtree, local place) for the vessels on the way from the root to `place`, on the rank that
/// knows them: the first for the top, the branch's owner below.
template <class Visit>
void TreeFlow::visit(std::uint64_t place, const Visit& visit) const {
  const int generation = network::TreePair::generation_of(place);
  const auto visit_within = [&](const Subtree& subtree, int first_generation, int depth) {
    for (int l = 0; l < depth && first_generation + l <= generation; ++l) {
      const std::uint64_t ancestor = place >> (generation - first_generation - l);
      visit(subtree, static_cast<std::size_t>(ancestor - (subtree.place() << l) + (std::uint64_t{1} << l)));
    }
  };
  if (comm_.is_root()) visit_within(*top_, 0, top_depth_);
  if (generation < top_depth_) return;
  const auto branch = static_cast<std::size_t>((place >> (generation - top_depth_)) - branches());
  if (!owns(branch)) return;
  Subtree middle(law_, middle_depth_, true);
  grow_middle(middle, branch);
  visit_within(middle, top_depth_, middle_depth_);
  const int bottom_generation = top_depth_ + middle_depth_;
  if (generation < bottom_generation) return;
  Subtree bottom(law_, bottom_depth_, false);
  const std::uint64_t bottom_place = place >> (generation - bottom_generation);
  const SubtreeState state = middle.daughter(bottom_place - (middle.place() << middle_depth_));
  bottom.grow(state.place, state.capacity);
  bottom.rise();
  bottom.fall(state);
  visit_within(bottom, bottom_generation, bottom_depth_);
}

VesselFlow TreeFlow::query(std::uint64_t id) const {
  if (id >= tree_.vessels()) tree_.vessel(id);  // throws
  if (alike_) return query_alike(id);
  const std::uint64_t place = network::TreePair::place_of(id);
  double values[5] = {};  // flow, pressures
  visit(place, [&](const Subtree& subtree, std::size_t n) {
    if (subtree.global_place(n) == place) subtree.state_of(n, values);
  });
  comm_.all_reduce(values, parallel::Reduce::sum);
  if (network::TreePair::kind_of(id) == network::VesselKind::artery) return {values[0], values[1], values[2]};
  return {values[0], values[4], values[3]};
}

VesselFlow TreeFlow::query_alike(std::uint64_t id) const {
  struct Finder : VesselConsumer {
    std::uint64_t id = 0;
    VesselFlow found;
    void consume(const VesselBlock& b) override {
      if (b.generation != network::TreePair::generation_of(network::TreePair::place_of(id))) return;
      const bool artery = network::TreePair::kind_of(id) == network::VesselKind::artery;
      found = artery ? VesselFlow{*b.flow, *b.artery_near, *b.artery_far}
                     : VesselFlow{*b.flow, *b.vein_far, *b.vein_near};
    }
  } finder;
  finder.id = id;
  sweep_alike(finder);
  return finder.found;
}

TreeFlow::Path TreeFlow::path_to(std::uint64_t place) const {
  const auto length = static_cast<std::size_t>(network::TreePair::generation_of(place)) + 1;
  std::vector<double> values(3 * length + 1, 0.0);  // artery, vein, the other daughter's; below the last
  const auto note = [&](std::size_t g, double artery, double vein, double beside) {
    values[3 * g] = artery;
    values[3 * g + 1] = vein;
    values[3 * g + 2] = beside;
  };
  if (alike_) {
    Subtree vessel(law_, 1, true);
    for (std::size_t g = 0; g < length; ++g) {
      vessel.grow(std::uint64_t{1} << g, std::ldexp(1.0, -static_cast<int>(g)));
      note(g, vessel.artery_resistance(1), vessel.vein_resistance(1),
           g + 1 < alike_below_.size() ? alike_below_[g + 1] : 0);
    }
    if (length < alike_below_.size()) values[3 * length] = alike_below_[length] / 2;
  } else {
    visit(place, [&](const Subtree& subtree, std::size_t n) {
      const auto g = static_cast<std::size_t>(network::TreePair::generation_of(subtree.global_place(n)));
      const bool last = g + 1 == length;
      const bool leaf = static_cast<int>(g) + 1 == tree_.generations();
      double beside = 0;
      if (!last) {
        const std::uint64_t next = place >> (length - 2 - g);
        beside = subtree.below(2 * n + (next % 2 == 0 ? 1 : 0));
      } else if (!leaf) {
        const double one = subtree.below(2 * n), two = subtree.below(2 * n + 1);
        values[3 * length] = one * two / (one + two);
      }
      note(g, subtree.artery_resistance(n), subtree.vein_resistance(n), beside);
    });
    comm_.all_reduce(values, parallel::Reduce::sum);
  }
  Path path;
  for (std::size_t g = 0; g < length; ++g) {
    path.artery.push_back(values[3 * g]);
    path.vein.push_back(values[3 * g + 1]);
    if (g + 1 < length) path.beside.push_back(values[3 * g + 2]);
  }
  path.below = values[3 * length];
  return path;
}

}  // namespace rhexis::hemodynamics
