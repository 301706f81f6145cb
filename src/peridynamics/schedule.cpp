#include "peridynamics/schedule.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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

}  // namespace

double schedule_share(const Parameters& p, double time_s) {
  if (p.schedule == "step") return 1;
  const double share = std::clamp(time_s / *p.ramp_time, 0.0, 1.0);
  return p.schedule == "smooth_ramp" ? 0.5 * (1 - std::cos(std::numbers::pi * share)) : share;
}

double scheduled_pressure(const Parameters& p, double time_s) {
  if (p.schedule == "table") return interpolate(p.table, time_s);
  return p.pressure * schedule_share(p, time_s);
}

}  // namespace rhexis::peridynamics
