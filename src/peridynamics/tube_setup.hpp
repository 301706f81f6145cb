// SPDX-License-Identifier: BSD-3-Clause
/// A straight tube for the general engine.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "peridynamics/engine/body_setup.hpp"
#include "peridynamics/engine/general_setup.hpp"
#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// A tube's particles in the engine's order, and where each of them stands in its lattice: column * rows +
/// row.
struct GeneralTube {
  std::shared_ptr<const GeneralSetup> setup;
  std::vector<std::int64_t> lattice_number;
};

/// The law by gradient of resolved parameters.
GradientLaw gradient_law(const Parameters& p);

/// The tube of resolved parameters whose lattice, ends, precision and time step are those of `tube`.
GeneralTube make_general_tube(const Parameters& p, const BodySetup& tube);

/// The same tube, as short as tells what a long one does, for measures of its discretisation: plane strain
/// between sliding ends, in double precision.
GeneralTube make_short_tube(const Parameters& p, BodySetup tube);

}  // namespace rhexis::peridynamics
