// SPDX-License-Identifier: BSD-3-Clause
/// Exact reduction of a network of conductances: whatever series, parallel and dead-end rules can remove is
/// removed, in O(vessels), and later put back. Trees and series-parallel networks (an arterial tree joined
/// leaf to leaf to its venous mirror) vanish completely.
///
/// Vessels carry q = g (p_tail - p_head), g in m3/(s Pa); an injection i (m3/s) flows into a junction.
///
///   dead end   j - a        a gets i.                 Back: q(j->a) = i,  p_j = p_a + i/g
///   series     a - j - b    g = g1 g2/(g1+g2);        Back: q(a->j) = q - i g1/(g1+g2),  q(j->b) = q(a->j) +
///   i,
///                           a gets i g1/(g1+g2),            p_j = (g1 p_a + g2 p_b + i)/(g1+g2)
///                           b gets i g2/(g1+g2).
///   parallel   a = b        g = g1 + g2.              Back: q splits as g1 : g2.
///
/// Nothing is subtracted on the way in, so conductances keep full relative precision whatever their contrast;
/// on the way back flows are passed on and split, never formed from pressure differences, so a dead end
/// without injection carries exactly nothing.
///
/// Memory, in bytes: 32 a vessel, 20 a junction and 8 a parallel vessel, with injections, conductances and
/// results. What is removed leaves room for what must be remembered:
///  - the sign of a conductance says that its vessel is gone;
///  - a removed series vessel's slot of `flow` keeps the conductance that its survivor had;
///  - a removed junction's list of vessels keeps the survivor and the removed vessel;
///  - lists of junctions that are left are corrected only when they are read (`next_vessel`).
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace rhexis::hemodynamics {

class Reduction {
 public:
  static constexpr std::uint32_t none = 0xffffffff;

  /// Vessels [V] from `tail` to `head`, no vessel from a junction to itself; `injection` [J]; junctions with
  /// `kept` stay. All is consumed. V and J are below 2^31.
  Reduction(std::vector<std::uint32_t> tail, std::vector<std::uint32_t> head, std::vector<double> conductance,
            std::vector<double> injection, std::vector<bool> kept);

  /// Removes what can be removed.
  void reduce();

  /// A junction that lost all its vessels without any kept junction in reach: its pressure is not defined.
  /// `none` where there is none.
  std::uint32_t floating_junction() const { return floating_; }

  /// After `reduce`: vessels that are left, in ascending order.
  std::vector<std::uint32_t> vessels_left() const;
  std::uint32_t tail(std::uint32_t vessel) const { return tail_[vessel]; }
  std::uint32_t head(std::uint32_t vessel) const { return head_[vessel]; }
  double conductance(std::uint32_t vessel) const { return conductance_[vessel]; }
  bool kept(std::uint32_t junction) const { return kept_[junction]; }
  /// The inflow at a junction that is left, with what removed ones passed on to it.
  double injection(std::uint32_t junction) const { return value_[junction]; }

  /// Before `restore`: results at what is left.
  void set_pressure(std::uint32_t junction, double pressure) { value_[junction] = pressure; }
  void set_flow(std::uint32_t vessel, double flow) { flow_[vessel] = flow; }

  /// Puts everything back, last removed first. Pressures at all junctions that had vessels, flows everywhere.
  void restore();
  std::vector<double> take_pressure() { return std::move(value_); }
  std::vector<double> take_flow() { return std::move(flow_); }

 private:
  void list_vessels();
  void settle(std::uint32_t junction);
  void visit(std::uint32_t junction);
  void merge_parallel_at(std::uint32_t junction);
  void merge_parallel_at_hubs();
  void merge_if_parallel(std::uint32_t vessel);
  void merge(std::uint32_t survivor, std::uint32_t removed);
  void remove_dead_end(std::uint32_t junction);
  void remove_series(std::uint32_t junction);
  void loses_vessel(std::uint32_t junction);
  std::uint32_t next_vessel(std::uint32_t junction, std::uint32_t listed) const;
  std::uint32_t clean(std::uint32_t junction);
  void restore_junction(std::uint32_t junction);
  void restore_parallel(std::uint32_t survivor, std::uint32_t removed, bool same_direction);

  std::uint32_t other(std::uint32_t vessel, std::uint32_t junction) const {
    return tail_[vessel] == junction ? head_[vessel] : tail_[vessel];
  }
  void move_end(std::uint32_t vessel, std::uint32_t old_end, std::uint32_t new_end) {
    (tail_[vessel] == old_end ? tail_ : head_)[vessel] = new_end;
  }
  bool is_gone(std::uint32_t vessel) const { return conductance_[vessel] < 0; }

  std::vector<std::uint32_t> tail_, head_;  // [V]
  std::vector<double> conductance_, flow_;  // [V]
  std::vector<double> value_;               // [J] injection, then pressure
  std::vector<bool> kept_;                  // [J]
  std::vector<std::uint32_t> first_;        // [J+1] where a junction's list starts in vessels_
  std::vector<std::uint32_t> vessels_;      // [2V] lists; one that got shorter ends with `none`
  std::vector<std::uint32_t> degree_;       // [J] vessels that are left; 0: isolated or removed
  std::vector<std::uint32_t> removals_;     // junction, or pair of vessels with `parallel_mark` on the second
  std::vector<std::uint32_t> pending_;      // junctions to visit
  std::uint32_t longest_visited_ = 0;       // degree up to which a junction is looked at
  std::uint32_t floating_ = none;
};

}  // namespace rhexis::hemodynamics
