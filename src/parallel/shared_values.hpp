// SPDX-License-Identifier: BSD-3-Clause
/// Values at points that several ranks hold, each with an index of its own; one of the ranks owns the point.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// Points shared with one other rank; both ranks list them in the same order.
struct SharedLink {
  int rank = 0;
  std::vector<std::uint32_t> owned;     ///< indices of points that this rank owns and the other one has too
  std::vector<std::uint32_t> borrowed;  ///< places of points that the other rank owns and this rank has too
};

class SharedValues {
 public:
  /// Links by ascending rank, so that sums are formed in the same order every time.
  SharedValues(Communicator comm, std::vector<SharedLink> links);

  /// Collective among linked ranks: the owner's value goes to all who have the point.
  void copy_from_owner(std::span<double> values);
  /// Collective among linked ranks: the others' values are added to the owner's.
  void add_to_owner(std::span<double> values);

  Communicator communicator() const { return comm_; }
  const std::vector<SharedLink>& links() const { return links_; }

 private:
  void exchange(std::span<const double> values, bool from_owner);

  Communicator comm_;
  std::vector<SharedLink> links_;
  std::vector<std::vector<double>> outgoing_, incoming_;
};

}  // namespace rhexis::parallel
