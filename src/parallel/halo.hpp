// SPDX-License-Identifier: BSD-3-Clause
/// Exchange of values that several ranks need, in two halves so that work fits in between.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "parallel/communicator.hpp"

namespace rhexis::parallel {

/// A contiguous run of values in each of a field's component arrays.
struct Run {
  std::size_t offset = 0, count = 0;
};

/// What goes to and comes from one rank; both sides list runs in the same order.
struct HaloMessage {
  int rank = 0;
  std::vector<Run> send, receive;
};

/// What an exchange cost so far, on this rank.
struct Traffic {
  double seconds = 0;      ///< packing, sending, waiting, unpacking
  std::int64_t bytes = 0;  ///< sent to other ranks

  Traffic operator+(const Traffic& other) const { return {seconds + other.seconds, bytes + other.bytes}; }
};

/// Real is float or double. A message to the own rank (periodic ends) is a copy.
template <class Real>
class HaloExchange {
 public:
  /// An exchange of fields that have `components` arrays each.
  HaloExchange(Communicator comm, std::vector<HaloMessage> messages, std::size_t components);

  /// Packs and sends the runs of `field`; they may be read but not written until `finish`.
  void start(std::span<Real* const> field);
  /// Waits and writes what came into the halo of `field`.
  void finish(std::span<Real* const> field);

  const Traffic& traffic() const { return traffic_; }

 private:
  Communicator comm_;
  std::vector<HaloMessage> messages_;
  std::vector<std::vector<Real>> outgoing_, incoming_;
  std::vector<MPI_Request> requests_;
  Traffic traffic_;
};

}  // namespace rhexis::parallel
