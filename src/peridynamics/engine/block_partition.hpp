// SPDX-License-Identifier: BSD-3-Clause
/// Which particles of any body are on a rank: whole blocks of 16 in the body's order.
///
/// A rank owns a run of blocks. It knows two more layers of them: those with a partner of an own particle,
/// whose forces it evaluates once more, and those with a partner of these, of which it needs the displacement
/// only.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "core/id_ranges.hpp"
#include "parallel/communicator.hpp"
#include "parallel/halo.hpp"
#include "parallel/partition.hpp"
#include "peridynamics/bonds/neighbours.hpp"

namespace rhexis::peridynamics {

using parallel::block_rows;

class BlockPartition {
 public:
  BlockPartition(const Neighbours& neighbours, parallel::Communicator comm);

  std::int64_t particles() const { return particles_; }  ///< of the whole body
  std::int64_t first_block() const { return start_[static_cast<std::size_t>(rank_)]; }
  /// Owned blocks come first, then those evaluated too, then those whose displacement is known.
  std::size_t owned_blocks() const { return owned_; }
  std::size_t evaluated_blocks() const { return evaluated_; }
  std::size_t known_blocks() const { return blocks_.size(); }
  /// Owned particles; they are the first of the local ones.
  std::size_t owned_particles() const;
  /// The number of a local block in the whole body.
  std::int64_t block(std::size_t local) const { return blocks_[local]; }
  /// Local number of a particle of the whole body that is known here.
  std::int32_t local(std::int32_t particle) const {
    return local_block_[static_cast<std::size_t>(particle / block_rows)] *
               static_cast<std::int32_t>(block_rows) +
           static_cast<std::int32_t>(particle % block_rows);
  }
  /// Particles in a block of the whole body: 16, fewer in the last.
  int particles_in(std::int64_t block) const;
  IdRanges ids() const;
  /// What ranks exchange of their blocks: of all known ones, or only of those that are evaluated. `run` tells
  /// where the values of a local block lie.
  enum class Layer { known, evaluated };
  std::vector<parallel::HaloMessage> halo(Layer layer,
                                          const std::function<parallel::Run(std::size_t block)>& run) const;

 private:
  std::int64_t particles_;
  int rank_;
  std::vector<std::int64_t> start_;  ///< [ranks + 1] blocks
  std::size_t owned_ = 0, evaluated_ = 0;
  std::vector<std::int64_t> blocks_;       ///< local to whole
  std::vector<std::int32_t> local_block_;  ///< whole to local, -1 where unknown here
  /// [ranks] owned blocks, ascending, that another rank knows, and that it evaluates.
  std::vector<std::vector<std::size_t>> known_by_, evaluated_by_;
};

}  // namespace rhexis::peridynamics
