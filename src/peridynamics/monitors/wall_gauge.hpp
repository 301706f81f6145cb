// SPDX-License-Identifier: BSD-3-Clause
/// How far a wall has opened and how wide its lumen is, whatever the shape of the wall: who loads a wall or
/// watches it asks here, and each kind of body has a gauge of its own.
#pragma once

#include <memory>

#include "parallel/communicator.hpp"
#include "peridynamics/wall_model.hpp"

namespace rhexis::peridynamics {

/// Measures a body as it is now. All calls are collective and give the same for any ranks.
class WallGauge {
 public:
  virtual ~WallGauge() = default;
  /// Area of the holes through the wall, m2.
  virtual double open_area() const = 0;
  /// Resistance of the deformed lumen to flow by Eq. (9), over that of the undeformed one.
  virtual double resistance_factor() const = 0;
  /// The largest share by which the lumen's surface has grown anywhere along the vessel.
  virtual double largest_lumen_stretch() const = 0;
};

/// The gauge for a tube (opening.hpp), the only kind there is. `wall` and `body` must live on. Collective.
std::unique_ptr<WallGauge> make_gauge(const WallModel& wall, const Body& body, parallel::Communicator comm);

}  // namespace rhexis::peridynamics
