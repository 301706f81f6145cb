/// ColumnBody: its bonds, the copies that bonds read, and restarts.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
void ColumnBody<Law, Real>::make_bonds() {
  const PointLayout& layout = domain_.layout();
  const auto& first = setup_.families->first;
  bonds_.reserve(
      static_cast<std::size_t>(first[static_cast<std::size_t>(layout.first_column + layout.column_count)] -
                               first[static_cast<std::size_t>(layout.first_column)]));
  first_bond_.push_back(0);
  for (std::int64_t c = 0; c < layout.column_count; ++c) {
    const auto column = static_cast<std::size_t>(layout.first_column + c);
    for (std::int64_t b = setup_.families->first[column]; b < setup_.families->first[column + 1]; ++b) {
      const Bond& bond = setup_.families->bonds[b];
      const double own_volume = relative_volume(column);
      const double volume = relative_volume(static_cast<std::size_t>(bond.other));
      const auto offset = static_cast<std::int64_t>(domain_.padded(domain_.slot(bond.other))) +
                          bond.row_offset -
                          static_cast<std::int64_t>(domain_.padded(static_cast<std::size_t>(c)));
      const double inverse_length2 = 1 / (bond.length * bond.length);
      BondConstants<Real> constants{.inverse_length2 = Real(inverse_length2),
                                    .weight = Real(bond.weight * (own_volume * volume) / bond.length),
                                    .volume = Real(volume),
                                    .energy_weight = Real(bond.weight * (own_volume * volume) * bond.length),
                                    .offset = static_cast<std::int32_t>(offset)};
      for (int k = 0; k < 3; ++k) {
        constants.xi[k] = Real(bond.xi[k]);
        constants.twice_xi[k] = Real(2 * bond.xi[k] * inverse_length2);
      }
      bonds_.push_back(constants);
    }
    first_bond_.push_back(static_cast<std::int64_t>(bonds_.size()));
  }
  family_volume_.resize(static_cast<std::size_t>(layout.local_count()));
  intact_.resize(bonds_.size() * static_cast<std::size_t>(domain_.blocks()));
  changed_.resize(static_cast<std::size_t>(layout.column_count * domain_.blocks()), 1);
  fracture_energy_.resize(changed_.size());
  for (std::int32_t slot = 0; slot < layout.column_count; ++slot) {
    for (std::int32_t block = 0; block < domain_.blocks(); ++block) {
      const Unit unit{slot, block};
      for (std::size_t b = 0; b < bonds_of(unit).size(); ++b) {
        const std::uint16_t word = born(unit, b);
        intact_[first_word(unit) + b] = word;
        intact_directed_ += std::popcount(word);
        for (unsigned rows = word; rows != 0; rows &= rows - 1)
          family_volume_[particle(unit) + static_cast<std::size_t>(std::countr_zero(rows))] +=
              double{bonds_of(unit)[b].volume};
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

/// Heights (m) of all rows that are here, halo included, and the first one's place relative to the first
/// owned.
template <class Law, class Real>
std::pair<std::int64_t, std::vector<double>> ColumnBody<Law, Real>::padded_heights() const {
  const PointLayout& l = domain_.layout();
  const std::int64_t reach = setup_.families->reach;
  const std::int64_t below = periodic_ ? reach : std::min(reach, l.first_row);
  const std::int64_t past = l.row_count + reach;
  const std::int64_t above = periodic_ ? past : std::min(past, l.rows - l.first_row);
  std::vector<double> z;
  for (std::int64_t row = -below; row < above; ++row)
    z.push_back(setup_.lattice.height((l.first_row + row + l.rows) % l.rows));
  return {-below, std::move(z)};
}

/// Halo included: what a place is like is no secret of its owner.
template <class Law, class Real>
void ColumnBody<Law, Real>::make_local_properties() {
  if (setup_.heterogeneity.uniform()) return;
  half_stretch_.resize(domain_.padded_size());
  half_stiffness_.resize(domain_.padded_size());
  const auto heights = padded_heights();
  const CrossSection& section = setup_.lattice.section;
  const auto columns = domain_.columns();
  parallel::for_each_share(threads_, columns.size(), [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t slot = begin; slot < end; ++slot) {
      const auto c = static_cast<std::size_t>(columns[slot]);
      const auto factors = setup_.heterogeneity.along(section.x[c], section.y[c], heights.second);
      const std::size_t first = domain_.padded(slot) + static_cast<std::size_t>(heights.first);
      for (std::size_t i = 0; i < factors.size(); ++i) {
        half_stretch_[first + i] =
            static_cast<Real>(0.5 * setup_.critical_stretch * factors[i].critical_stretch);
        half_stiffness_[first + i] = static_cast<Real>(0.5 * factors[i].stiffness);
      }
    }
  });
}

template <class Law, class Real>
void ColumnBody<Law, Real>::make_thin_spots() {
  const ThinSpots& thin = setup_.thin_spots;
  if (thin.none()) return;
  absent_.resize(domain_.padded_size());
  const CrossSection& section = setup_.lattice.section;
  const auto columns = domain_.columns();
  const auto heights = padded_heights();
  for (std::size_t slot = 0; slot < columns.size(); ++slot) {
    const auto c = static_cast<std::size_t>(columns[slot]);
    char* absent = absent_.data() + domain_.padded(slot) + heights.first;
    for (const double z : heights.second) *absent++ = thin.present(section.x[c], section.y[c], z) ? 0 : 1;
  }
  const PointLayout& l = domain_.layout();
  for (std::int64_t c = 0; c < l.column_count; ++c) {
    for (std::int64_t r = 0; r < l.row_count; ++r) {
      const auto x = reference_position(c, r);
      load_share_.push_back(thin.load_share(x[0], x[1], x[2]));
    }
  }
  largest_load_ *= comm_.all_reduce(*std::ranges::max_element(load_share_), parallel::Reduce::max);
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
  const auto& first = setup_.families->first;
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
  Saved saved{.displacement = u_,
              .leapfrog_velocity = v_,
              .words = {},
              .first_kick_pending = first_kick_pending_,
              .external_work = work_.parts(comm_),
              .load_speed = load_speed_,
              .frame = frame_,
              .wrapped = per_period_ > 0,
              .frame_phase = steps_ % frame_interval};
  if constexpr (Law::state_based) saved.released_energy = state_->released.parts(comm_);
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
  work_ = restored(saved.external_work);
  if constexpr (Law::state_based) state_->released = restored(saved.released_energy);
  load_speed_ = saved.load_speed;
  frame_ = saved.frame;
  per_period_ = saved.wrapped ? 1 / wrap_period : 0;
  steps_ = saved.frame_phase;
  forces_known_ = false;
  for (Part<Real>& part : parts_) part.beyond_known = false;
  std::ranges::fill(changed_, char{1});
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
