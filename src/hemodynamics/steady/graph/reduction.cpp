// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/steady/graph/reduction.hpp"

#include <algorithm>
#include <utility>

#include "parallel/large_array.hpp"

namespace rhexis::hemodynamics {
namespace {

// On the second entry of a pair in removals_: a parallel vessel. On the first: both run the same way.
constexpr std::uint32_t mark = 0x80000000;

// Lists no longer than this are compared pair by pair; longer ones wait for merge_parallel_at_hubs.
constexpr std::uint32_t short_list = 16;

// Removing parallel vessels between hubs can make room for more; beyond this many rounds the rest is left to
// the solver of what is left.
constexpr int max_hub_rounds = 32;

}  // namespace

Reduction::Reduction(std::vector<std::uint32_t> tail, std::vector<std::uint32_t> head,
                     std::vector<double> conductance, std::vector<double> injection, std::vector<bool> kept)
    : tail_(std::move(tail)),
      head_(std::move(head)),
      conductance_(std::move(conductance)),
      flow_(parallel::large_array<double>(conductance_.size())),
      value_(std::move(injection)),
      kept_(std::move(kept)) {}

void Reduction::list_vessels() {
  const std::size_t junctions = value_.size();
  first_ = parallel::large_array<std::uint32_t>(junctions + 1);
  for (const auto* ends : {&tail_, &head_}) {
    for (const std::uint32_t j : *ends) ++first_[j];
  }
  degree_ = parallel::large_array<std::uint32_t>(junctions);
  std::uint32_t past = 0;
  for (std::size_t j = 0; j < junctions; ++j) {
    degree_[j] = first_[j];
    past += first_[j];
    first_[j] = past;
  }
  first_[junctions] = past;
  vessels_ = parallel::large_array<std::uint32_t>(2 * tail_.size());
  for (std::size_t v = tail_.size(); v-- > 0;) {
    vessels_[--first_[head_[v]]] = static_cast<std::uint32_t>(v);
    vessels_[--first_[tail_[v]]] = static_cast<std::uint32_t>(v);
  }
}

void Reduction::reduce() {
  list_vessels();
  parallel::reserve_large(removals_,
                          2 * tail_.size());  // never more; pages that are not written cost nothing
  // First what needs no search for parallel vessels: on trees that is all, and a quarter of the time is
  // saved.
  for (const std::uint32_t longest : {2u, short_list}) {
    longest_visited_ = longest;
    for (std::uint32_t j = 0; j < degree_.size(); ++j) settle(j);
  }
  for (int round = 0; round < max_hub_rounds; ++round) {
    const std::size_t before = removals_.size();
    merge_parallel_at_hubs();
    if (removals_.size() == before) break;
  }
  degree_ = {};
  pending_ = {};
}

/// Visits a junction and whatever becomes removable by that.
void Reduction::settle(std::uint32_t junction) {
  visit(junction);
  while (!pending_.empty()) {
    const std::uint32_t next = pending_.back();
    pending_.pop_back();
    visit(next);
  }
}

void Reduction::visit(std::uint32_t junction) {
  if (degree_[junction] == 0 || degree_[junction] > longest_visited_) return;
  merge_parallel_at(junction);
  if (kept_[junction]) return;
  if (degree_[junction] == 1) {
    remove_dead_end(junction);
  } else if (degree_[junction] == 2) {
    remove_series(junction);
  }
}

/// The vessel that `listed`, an entry of the junction's list, stands for now; `none` if it is gone.
std::uint32_t Reduction::next_vessel(std::uint32_t junction, std::uint32_t listed) const {
  while (is_gone(listed)) {
    if (tail_[listed] == head_[listed]) return none;  // removed as parallel
    const std::uint32_t survivor = vessels_[first_[other(listed, junction)]];
    if (survivor == listed) return none;  // removed as dead end
    listed = survivor;
  }
  return listed;
}

/// Brings the junction's list up to date; returns where it ends.
std::uint32_t Reduction::clean(std::uint32_t junction) {
  std::uint32_t out = first_[junction];
  const std::uint32_t past = first_[junction + 1];
  for (std::uint32_t in = out; in < past && vessels_[in] != none; ++in) {
    const std::uint32_t vessel = next_vessel(junction, vessels_[in]);
    if (vessel != none) vessels_[out++] = vessel;
  }
  if (out < past) vessels_[out] = none;
  return out;
}

void Reduction::loses_vessel(std::uint32_t junction) {
  if (--degree_[junction] <= 2) pending_.push_back(junction);
  if (degree_[junction] == 0 && !kept_[junction]) floating_ = junction;
}

/// Where two vessels join the same junctions, one takes over both.
void Reduction::merge(std::uint32_t survivor, std::uint32_t removed) {
  const bool same_direction = tail_[survivor] == tail_[removed];
  const std::uint32_t a = tail_[removed], b = head_[removed];
  flow_[removed] = conductance_[survivor];
  conductance_[survivor] += conductance_[removed];
  conductance_[removed] = -conductance_[removed];
  head_[removed] = a;
  removals_.push_back(same_direction ? survivor | mark : survivor);
  removals_.push_back(removed | mark);
  loses_vessel(a);
  loses_vessel(b);
}

void Reduction::merge_parallel_at(std::uint32_t junction) {
  const std::uint32_t first = first_[junction];
  std::uint32_t past = clean(junction);
  for (std::uint32_t i = first; i < past; ++i) {
    const std::uint32_t neighbour = other(vessels_[i], junction);
    for (std::uint32_t k = i + 1; k < past;) {
      if (other(vessels_[k], junction) != neighbour) {
        ++k;
        continue;
      }
      merge(vessels_[i], vessels_[k]);
      vessels_[k] = vessels_[--past];
      vessels_[past] = none;
    }
  }
}

/// The same for long lists: the vessel last seen towards each neighbour is looked up, not searched.
void Reduction::merge_parallel_at_hubs() {
  std::vector<std::uint32_t> seen;
  for (std::uint32_t j = 0; j < degree_.size(); ++j) {
    if (degree_[j] <= short_list) continue;
    if (seen.empty()) seen.assign(degree_.size(), none);
    const std::uint32_t past = clean(j);
    for (std::uint32_t i = first_[j]; i < past; ++i) {
      std::uint32_t& vessel = seen[other(vessels_[i], j)];
      if (vessel == none) {
        vessel = vessels_[i];
      } else {
        merge(vessel, vessels_[i]);
      }
    }
    const std::uint32_t still_past = clean(j);
    for (std::uint32_t i = first_[j]; i < still_past; ++i) seen[other(vessels_[i], j)] = none;
    settle(j);
  }
}

/// A vessel that has just come between two junctions joins one that is there already.
void Reduction::merge_if_parallel(std::uint32_t vessel) {
  std::uint32_t a = tail_[vessel], b = head_[vessel];
  if (degree_[a] > degree_[b]) std::swap(a, b);
  if (degree_[a] > short_list) return;
  const std::uint32_t past = clean(a);
  for (std::uint32_t i = first_[a]; i < past; ++i) {
    if (vessels_[i] == vessel || other(vessels_[i], a) != b) continue;
    merge(vessels_[i], vessel);
    return;
  }
}

/// `junction`'s list has just been cleaned.
void Reduction::remove_dead_end(std::uint32_t junction) {
  const std::uint32_t vessel = vessels_[first_[junction]];
  const std::uint32_t neighbour = other(vessel, junction);
  value_[neighbour] += value_[junction];
  conductance_[vessel] = -conductance_[vessel];
  degree_[junction] = 0;
  removals_.push_back(junction);
  loses_vessel(neighbour);
}

/// `junction`'s list has just been cleaned.
void Reduction::remove_series(std::uint32_t junction) {
  const std::uint32_t survivor = vessels_[first_[junction]], removed = vessels_[first_[junction] + 1];
  const std::uint32_t a = other(survivor, junction), b = other(removed, junction);
  const double g1 = conductance_[survivor], g2 = conductance_[removed];
  // As shares of one, so that no product leaves the range of doubles.
  const double share1 = g1 / (g1 + g2), share2 = g2 / (g1 + g2);
  value_[a] += share1 * value_[junction];
  value_[b] += share2 * value_[junction];
  flow_[removed] = g1;
  conductance_[survivor] = g1 < g2 ? g1 * share2 : g2 * share1;
  conductance_[removed] = -g2;
  move_end(survivor, junction, b);
  degree_[junction] = 0;
  removals_.push_back(junction);
  merge_if_parallel(survivor);
}

std::vector<std::uint32_t> Reduction::vessels_left() const {
  std::vector<std::uint32_t> left;
  for (std::uint32_t v = 0; v < conductance_.size(); ++v) {
    if (!is_gone(v)) left.push_back(v);
  }
  return left;
}

void Reduction::restore() {
  while (!removals_.empty()) {
    const std::uint32_t last = removals_.back();
    removals_.pop_back();
    if ((last & mark) == 0) {
      restore_junction(last);
    } else {
      const std::uint32_t survivor = removals_.back();
      removals_.pop_back();
      restore_parallel(survivor & ~mark, last & ~mark, (survivor & mark) != 0);
    }
  }
}

void Reduction::restore_parallel(std::uint32_t survivor, std::uint32_t removed, bool same_direction) {
  const double g1 = flow_[removed], g2 = -conductance_[removed];
  const double through = flow_[survivor];
  tail_[removed] = same_direction ? tail_[survivor] : head_[survivor];
  head_[removed] = same_direction ? head_[survivor] : tail_[survivor];
  conductance_[survivor] = g1;
  conductance_[removed] = g2;
  flow_[survivor] = through * (g1 / (g1 + g2));
  flow_[removed] = (same_direction ? through : -through) * (g2 / (g1 + g2));
}

void Reduction::restore_junction(std::uint32_t junction) {
  const double injection = value_[junction];
  const std::uint32_t first = first_[junction], survivor = vessels_[first];
  if (is_gone(survivor)) {  // the only vessel of a dead end
    const double g = conductance_[survivor] = -conductance_[survivor];
    flow_[survivor] = tail_[survivor] == junction || injection == 0 ? injection : -injection;
    value_[junction] = value_[other(survivor, junction)] + injection / g;
    return;
  }
  const std::uint32_t removed = vessels_[first + 1];
  const std::uint32_t b = other(removed, junction), a = other(survivor, b);
  const double g1 = flow_[removed], g2 = -conductance_[removed];
  const double share1 = g1 / (g1 + g2), share2 = g2 / (g1 + g2);
  const bool leaves_a = tail_[survivor] == a;
  const double into = (leaves_a ? flow_[survivor] : -flow_[survivor]) - share1 * injection;
  const double out = into + injection;
  move_end(survivor, b, junction);
  conductance_[survivor] = g1;
  conductance_[removed] = g2;
  flow_[survivor] = leaves_a ? into : -into;
  flow_[removed] = tail_[removed] == junction ? out : -out;
  value_[junction] = share1 * value_[a] + share2 * value_[b] + injection / (g1 + g2);
}

}  // namespace rhexis::hemodynamics
