/// ColumnBody: its bonds, the copies that bonds read, and restarts.
#pragma once

#include "peridynamics/column_body.hpp"

namespace rhexis::peridynamics {

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
  born_directed_ = intact_directed_;
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
/// every partition takes the same; has them wrapped once fragments are so far apart that no frame serves all.
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
    if (per_period_ == 0 && extremes[3 + k] - middle > wrap_distance * setup_.lattice.spacing) {
      per_period_ = 1 / wrap_period;
      moved = true;
    }
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
          out[r] = in_frame(in[r], frame_[k]);
        }
      }
    }
  }
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
  Saved saved{
      u_, v_, {}, first_kick_pending_, 0, load_speed_, frame_, per_period_ > 0, steps_ % frame_interval};
  saved.external_work = external_work();
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
  load_speed_ = saved.load_speed;
  frame_ = saved.frame;
  per_period_ = saved.wrapped ? 1 / wrap_period : 0;
  steps_ = saved.frame_phase;
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

}  // namespace rhexis::peridynamics
