// SPDX-License-Identifier: BSD-3-Clause
/// Input keys of the sections blood and flow.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/parameter.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "hemodynamics/viscosity.hpp"

namespace rhexis::hemodynamics {

struct Parameters {
  Viscosity viscosity{.law = ViscosityLaw::in_vivo};
  double density = 1060;  ///< kg/m3
  GraphSolverOptions graph_solver;
  bool phase_separation = false;
  double phase_tolerance = 1e-8;
  std::int64_t phase_iterations = 200;
  std::optional<double> inlet_pressure, outlet_pressure;  ///< Pa
  std::optional<double> inlet_flow;                       ///< m3/s
  std::vector<double> acceleration;                       ///< m/s2, none or three components
};

ParameterList declare(Parameters& p);

/// The keys of section network that choose the solver of a graph's flow.
ParameterList declare(GraphSolverOptions& options);

/// Throws InputError for values that do not fit together.
void check(const Parameters& p);

/// The two conditions of a tree; throws InputError where they are not two.
TreeBoundary tree_boundary(const Parameters& p);

}  // namespace rhexis::hemodynamics
