// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/engine/block_partition.hpp"

#include <algorithm>
#include <string>

#include "core/error.hpp"

namespace rhexis::peridynamics {
namespace {

std::size_t index(std::int64_t block) {
  return static_cast<std::size_t>(block);
}

/// Blocks with a partner of a particle of `of` that are not marked in `known`; marks them. Ascending.
std::vector<std::int64_t> next_layer(const Neighbours& neighbours, const std::vector<std::int64_t>& of,
                                     std::vector<std::int32_t>& known) {
  std::vector<std::int64_t> layer;
  for (const std::int64_t block : of) {
    const std::size_t past = std::min(neighbours.size(), index((block + 1) * block_rows));
    for (std::size_t i = index(block * block_rows); i < past; ++i) {
      for (const std::int32_t j : neighbours.of(i)) {
        std::int32_t& mark = known[index(j / block_rows)];
        if (mark >= 0) continue;
        mark = 0;
        layer.push_back(j / block_rows);
      }
    }
  }
  std::sort(layer.begin(), layer.end());
  return layer;
}

/// The blocks that a rank with the run [first, past) knows: its own, evaluated ones, others.
struct Layers {
  std::vector<std::int64_t> blocks;
  std::size_t evaluated;
};

Layers layers_of(const Neighbours& neighbours, std::int64_t blocks, std::int64_t first, std::int64_t past) {
  std::vector<std::int32_t> known(index(blocks), -1);
  Layers layers;
  for (std::int64_t b = first; b < past; ++b) {
    layers.blocks.push_back(b);
    known[index(b)] = 0;
  }
  const std::vector<std::int64_t> near = next_layer(neighbours, layers.blocks, known);
  layers.blocks.insert(layers.blocks.end(), near.begin(), near.end());
  layers.evaluated = layers.blocks.size();
  const std::vector<std::int64_t> far = next_layer(neighbours, near, known);
  layers.blocks.insert(layers.blocks.end(), far.begin(), far.end());
  return layers;
}

}  // namespace

BlockPartition::BlockPartition(const Neighbours& neighbours, parallel::Communicator comm)
    : particles_(static_cast<std::int64_t>(neighbours.size())), rank_(comm.rank()) {
  const std::int64_t blocks = (particles_ + block_rows - 1) / block_rows, ranks = comm.size();
  if (ranks > blocks)
    throw RunError(std::to_string(ranks) + " ranks are too many for " + std::to_string(particles_) +
                   " particles; take at most " + std::to_string(blocks));
  for (std::int64_t r = 0; r <= ranks; ++r) start_.push_back(blocks * r / ranks);
  local_block_.assign(index(blocks), -1);
  known_by_.resize(index(ranks));
  evaluated_by_.resize(index(ranks));
  for (int r = 0; r < static_cast<int>(ranks); ++r) {
    // Whom others know is found from their families, which are the same on every rank.
    const Layers layers = layers_of(neighbours, blocks, start_[index(r)], start_[index(r) + 1]);
    if (r == rank_) {
      blocks_ = layers.blocks;
      owned_ = index(start_[index(r) + 1] - start_[index(r)]);
      evaluated_ = layers.evaluated;
      for (std::size_t b = 0; b < blocks_.size(); ++b)
        local_block_[index(blocks_[b])] = static_cast<std::int32_t>(b);
      continue;
    }
    for (std::size_t i = 0; i < layers.blocks.size(); ++i) {
      const std::int64_t b = layers.blocks[i];
      if (b < first_block() || b >= start_[index(rank_) + 1]) continue;
      known_by_[index(r)].push_back(index(b - first_block()));
      if (i < layers.evaluated) evaluated_by_[index(r)].push_back(index(b - first_block()));
    }
    std::sort(known_by_[index(r)].begin(), known_by_[index(r)].end());
  }
}

int BlockPartition::particles_in(std::int64_t block) const {
  return static_cast<int>(std::min(block_rows, particles_ - block * block_rows));
}

std::size_t BlockPartition::owned_particles() const {
  const std::int64_t past = std::min(particles_, start_[index(rank_) + 1] * block_rows);
  return index(past - first_block() * block_rows);
}

IdRanges BlockPartition::ids() const {
  IdRanges ids{.global_count = particles_};
  ids.add({first_block() * block_rows, static_cast<std::int64_t>(owned_particles())});
  return ids;
}

std::vector<parallel::HaloMessage> BlockPartition::halo(
    Layer layer, const std::function<parallel::Run(std::size_t block)>& run) const {
  const bool all = layer == Layer::known;
  std::vector<parallel::HaloMessage> messages;
  for (std::size_t r = 0; r + 1 < start_.size(); ++r) {
    parallel::HaloMessage message;
    message.rank = static_cast<int>(r);
    for (const std::size_t b : all ? known_by_[r] : evaluated_by_[r]) message.send.push_back(run(b));
    std::vector<std::int64_t> from;
    for (std::size_t b = owned_; b < (all ? blocks_.size() : evaluated_); ++b) {
      if (blocks_[b] >= start_[r] && blocks_[b] < start_[r + 1]) from.push_back(blocks_[b]);
    }
    std::sort(from.begin(), from.end());
    for (const std::int64_t b : from) message.receive.push_back(run(index(local_block_[index(b)])));
    if (!message.send.empty() || !message.receive.empty()) messages.push_back(std::move(message));
  }
  return messages;
}

}  // namespace rhexis::peridynamics
