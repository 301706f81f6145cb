// SPDX-License-Identifier: BSD-3-Clause
#include "studies/cascade/cascade_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>
#include <utility>

#include "output/json.hpp"
#include "studies/flow/network_record.hpp"
#include "studies/flow/network_tables.hpp"

namespace rhexis::studies {
namespace {

using output::or_null;
using Json = nlohmann::ordered_json;

}  // namespace

void CascadeState::record(CascadeEvent event, const std::optional<hemodynamics::VesselFailure>& failure,
                          double seconds, std::int64_t steps) {
  simulated.push_back(static_cast<std::uint32_t>(event.vessel.vessel));
  if (failure) failures.push_back(*failure);
  elapsed += seconds;
  steps_before += steps;
  events.push_back(std::move(event));
}

nlohmann::ordered_json to_json(const CascadeEvent& e, std::size_t number) {
  Json json{{"event", number}, {"time_s", or_null(e.time)}, {"risk", e.risk}};
  json.update(to_json(e.vessel));
  json.update({{"net_pressure_Pa", e.net_pressure},
               {"ruptured", or_null(e.ruptured)},
               {"rupture_onset_s", or_null(e.rupture_onset)},
               {"opening_m2", e.opening},
               {"inflow_before_m3_s", e.inflow_before},
               {"inflow_after_m3_s", or_null(e.inflow_after)},
               {"leak_m3_s", or_null(e.leak)},
               {"next_vessel", or_null(e.next_vessel)},
               {"next_risk", or_null(e.next_risk)}});
  return json;
}

std::string cascade_table(const std::vector<CascadeEvent>& events) {
  constexpr std::array columns = {"event",
                                  "time_s",
                                  "name",
                                  "kind",
                                  "generation",
                                  "risk",
                                  "ruptured",
                                  "rupture_onset_s",
                                  "net_pressure_Pa",
                                  "opening_m2",
                                  "leak_m3_s",
                                  "inflow_before_m3_s",
                                  "inflow_after_m3_s",
                                  "next_vessel",
                                  "next_risk"};
  std::string table = fmt::format("{}\n", fmt::join(columns, ","));
  for (std::size_t i = 0; i < events.size(); ++i) {
    const Json event = to_json(events[i], i + 1);
    std::vector<std::string> row;
    for (const char* column : columns) {
      const Json& value = event[column];
      row.push_back(value.is_null()     ? ""
                    : value.is_string() ? quoted(value.get<std::string>())
                                        : value.dump());
    }
    table += fmt::format("{}\n", fmt::join(row, ","));
  }
  return table;
}

}  // namespace rhexis::studies
