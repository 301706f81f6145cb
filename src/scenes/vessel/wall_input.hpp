// SPDX-License-Identifier: BSD-3-Clause
/// The wall of a vessel in an input: its keys, which scenes of one vessel, of a coupled one and of an
/// ensemble share, and the wall that they describe.
#pragma once

#include <optional>

#include "peridynamics/wall_memory.hpp"
#include "peridynamics/wall_model.hpp"
#include "scenes/scene.hpp"

namespace rhexis::scenes {

/// The keys of a vessel's wall, its load and its output.
ParameterList declare_wall(peridynamics::Parameters& vessel, output::Parameters& output);

/// Throws InputError for a field of output.fields that the law does not have.
void check_fields(const output::Parameters& output, const peridynamics::LawChoice& law);

/// What a run of one wall, dealt out among all ranks, asks of memory.
peridynamics::WallDemand demand_of(const output::Parameters& output, const runtime::PicturesPlan& pictures,
                                   const Reading& reading);

/// The wall of `vessel`, parameters as read, with warnings of what the input leaves without effect. Throws
/// InputError, also where memory does not suffice. Collective.
peridynamics::SharedWall make_wall(SceneInput& s, const peridynamics::Parameters& vessel,
                                   const peridynamics::WallDemand& demand,
                                   const runtime::PicturesPlan& pictures, const Reading& reading);

/// Where results are told by pressure, it should be one that walls have seen.
void warn_of_an_unfinished_ramp(SceneInput& s, const peridynamics::Parameters& vessel);

/// The risk (studies/screening/screening.hpp) of a wall without spots or scatter under its schedule's highest
/// pressure; none of a wall that stiffens.
std::optional<double> risk_of_load(const peridynamics::Parameters& vessel);

}  // namespace rhexis::scenes
