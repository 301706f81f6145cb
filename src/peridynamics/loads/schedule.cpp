// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/loads/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "core/error.hpp"
#include "core/format.hpp"

namespace rhexis::peridynamics {
namespace {

double interpolate(const std::vector<CurvePoint>& table, double time) {
  const auto after = std::upper_bound(table.begin(), table.end(), time,
                                      [](double t, const CurvePoint& point) { return t < point.first; });
  if (after == table.begin()) return table.front().second;
  if (after == table.end()) return table.back().second;
  const auto before = after - 1;
  const double share = (time - before->first) / (after->first - before->first);
  return before->second + share * (after->second - before->second);
}

/// First time at which the table has `pressure`, rising or falling; empty where it never has.
std::optional<double> time_in(const std::vector<CurvePoint>& table, double pressure) {
  if (table.front().second == pressure) return table.front().first;
  for (std::size_t i = 1; i < table.size(); ++i) {
    const auto [time, before] = table[i - 1];
    const auto [end, after] = table[i];
    if (std::min(before, after) <= pressure && pressure <= std::max(before, after))
      return time + (pressure - before) / (after - before) * (end - time);
  }
  return {};
}

}  // namespace

double schedule_share(const Parameters& p, double time_s) {
  if (p.schedule == Schedule::step) return 1;
  const double share = std::clamp((p.schedule_start + time_s) / p.ramp_time.value_or(p.end_time), 0.0, 1.0);
  return p.schedule == Schedule::smooth_ramp ? 0.5 * (1 - std::cos(std::numbers::pi * share)) : share;
}

double scheduled_pressure(const Parameters& p, double time_s) {
  if (p.schedule == Schedule::table) {
    const double time = p.schedule_start + time_s;
    return interpolate(p.table, p.repeat ? std::fmod(time, p.table.back().first) : time);
  }
  return p.pressure * schedule_share(p, time_s);
}

double highest_pressure(const Parameters& p) {
  if (p.schedule != Schedule::table) return p.pressure;
  return std::ranges::max(p.table, {}, &CurvePoint::second).second;
}

std::string describe_schedule(const Parameters& p) {
  if (p.schedule != Schedule::table) return std::string(name_of(p.schedule));
  return "table of " + std::to_string(p.table.size()) + " points to " + quantity(p.table.back().first, "s") +
         (p.repeat ? ", repeated" : "");
}

std::string describe_direction(const Parameters& p) {
  return std::string("on the ") + (p.direction == LoadDirection::dead ? "undeformed" : "deformed") +
         " lumen (" + std::string(name_of(p.direction)) + ")";
}

double time_of_pressure(const Parameters& p, double pressure) {
  const InputError never("the schedule never reaches this pressure", "start.equilibrium_pressure");
  if (p.schedule == Schedule::table) {
    const std::optional<double> time = time_in(p.table, pressure);
    if (!time) throw never;
    return *time;
  }
  if (pressure > p.pressure) throw never;
  if (p.schedule == Schedule::step) return 0;
  const double share = pressure / p.pressure;
  return *p.ramp_time *
         (p.schedule == Schedule::smooth_ramp ? std::acos(1 - 2 * share) / std::numbers::pi : share);
}

}  // namespace rhexis::peridynamics
