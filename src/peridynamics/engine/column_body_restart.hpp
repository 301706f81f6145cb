// SPDX-License-Identifier: BSD-3-Clause
/// ColumnBody: what a restart needs.
#pragma once

#include "peridynamics/engine/column_body.hpp"

namespace rhexis::peridynamics {

template <class Law, class Real>
Body::Saved ColumnBody<Law, Real>::save() const {
  Saved saved{.displacement = u_,
              .leapfrog_velocity = v_,
              .words = bonds_.save(),
              .first_kick_pending = first_kick_pending_,
              .external_work = work_.work_parts(comm_),
              .load_speed = load_speed_,
              .frame = displacement_.frame().origin(),
              .wrapped = displacement_.frame().wrapped(),
              .frame_phase = steps_ % frame_interval};
  if constexpr (Law::state_based) saved.released_energy = work_.released_parts(comm_);
  return saved;
}

template <class Law, class Real>
void ColumnBody<Law, Real>::restore(const Saved& saved) {
  u_ = saved.displacement;
  v_ = saved.leapfrog_velocity;
  first_kick_pending_ = saved.first_kick_pending;
  work_.restore(saved.external_work, saved.released_energy, comm_);
  load_speed_ = saved.load_speed;
  steps_ = saved.frame_phase;
  forces_known_ = false;
  bonds_.restore(saved.words);
  forces_->forget_words_beyond();
  displacement_.restore_frame(saved.frame, saved.wrapped);
  displacement_.fill(u_);
}

}  // namespace rhexis::peridynamics
