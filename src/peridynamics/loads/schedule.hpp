// SPDX-License-Identifier: BSD-3-Clause
/// Course of the net pressure in time, before venting.
#pragma once

#include "peridynamics/parameters.hpp"

namespace rhexis::peridynamics {

/// Share of load.pressure that acts at a time, by any schedule but a table.
double schedule_share(const Parameters& p, double time_s);

/// P_net(t), Pa, by `load.schedule` of resolved parameters:
///   step         P
///   ramp         P t/T for t < T, then P
///   smooth_ramp  P (1 - cos(pi t/T))/2 for t < T, then P
///   table        linear between points; constant outside, or with load.repeat a function of the time within
///                a period, the table's last time
/// with t counted from schedule_start.
double scheduled_pressure(const Parameters& p, double time_s);

/// The most that the schedule ever has, Pa; of a table, of all its points.
double highest_pressure(const Parameters& p);

/// "ramp", "table of 4 points to 800 ms, repeated".
std::string describe_schedule(const Parameters& p);

/// "on the deformed lumen (follower)".
std::string describe_direction(const Parameters& p);

/// When, in s, the schedule first has `pressure` (Pa; 0 for "step"). Throws InputError where it never has.
double time_of_pressure(const Parameters& p, double pressure);

}  // namespace rhexis::peridynamics
