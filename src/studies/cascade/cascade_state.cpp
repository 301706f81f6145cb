// SPDX-License-Identifier: BSD-3-Clause
#include "studies/cascade/cascade_state.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <utility>

#include "output/json.hpp"
#include "studies/flow/network_record.hpp"
#include "studies/flow/network_tables.hpp"

namespace rhexis::studies {
namespace {

using output::or_null;
using Json = nlohmann::ordered_json;

template <class T>
std::optional<T> optional_at(const Json& json, const char* key) {
  const Json& value = json.at(key);
  return value.is_null() ? std::nullopt : std::optional<T>(value.get<T>());
}

network::VesselKind kind_of(const std::string& text) {
  using enum network::VesselKind;
  for (const network::VesselKind kind : {artery, vein, unknown})
    if (text == network::name_of(kind)) return kind;
  throw std::runtime_error("no kind of vessel: " + text);
}

hemodynamics::NetworkVessel vessel_of(const Json& json) {
  hemodynamics::NetworkVessel q;
  q.name = json.at("name").get<std::string>();
  q.vessel = json.at("vessel").get<std::int64_t>();
  q.kind = kind_of(json.at("kind").get<std::string>());
  q.generation = optional_at<int>(json, "generation").value_or(-1);
  q.radius = json.at("radius_m").get<double>();
  q.length = json.at("length_m").get<double>();
  q.wall_thickness = json.at("wall_thickness_m").get<double>();
  q.strength_factor = json.at("strength_factor").get<double>();
  q.flow = json.at("flow_m3_s").get<double>();
  q.pressure_from = json.at("pressure_from_Pa").get<double>();
  q.pressure_to = json.at("pressure_to_Pa").get<double>();
  q.start = optional_at<std::array<double, 3>>(json, "start_m");
  q.end = optional_at<std::array<double, 3>>(json, "end_m");
  return q;
}

CascadeEvent event_of(const Json& json) {
  return {.vessel = vessel_of(json),
          .risk = json.at("risk").get<double>(),
          .net_pressure = json.at("net_pressure_Pa").get<double>(),
          .ruptured = optional_at<bool>(json, "ruptured"),
          .time = optional_at<double>(json, "time_s"),
          .rupture_onset = optional_at<double>(json, "rupture_onset_s"),
          .opening = json.at("opening_m2").get<double>(),
          .inflow_before = json.at("inflow_before_m3_s").get<double>(),
          .inflow_after = optional_at<double>(json, "inflow_after_m3_s"),
          .leak = optional_at<double>(json, "leak_m3_s"),
          .next_vessel = optional_at<std::string>(json, "next_vessel"),
          .next_risk = optional_at<double>(json, "next_risk")};
}

Json to_json(const hemodynamics::VesselFailure& failure) {
  return {{"vessel", failure.vessel},
          {"occluded", failure.occluded},
          {"orifice_strength", failure.orifice.strength},
          {"outside_pressure_Pa", failure.orifice.outside_pressure}};
}

hemodynamics::VesselFailure failure_of(const Json& json) {
  return {json.at("vessel").get<std::uint32_t>(),
          json.at("occluded").get<bool>(),
          {json.at("orifice_strength").get<double>(), json.at("outside_pressure_Pa").get<double>()}};
}

CascadeState state_of(const Json& json) {
  CascadeState state;
  for (const Json& event : json.at("events")) state.events.push_back(event_of(event));
  for (const Json& failure : json.at("injuries")) state.failures.push_back(failure_of(failure));
  state.simulated = json.at("settled").get<std::vector<std::uint32_t>>();
  state.elapsed = json.at("elapsed_s").get<double>();
  state.steps_before = json.at("steps_before").get<std::int64_t>();
  if (state.elapsed < 0 || state.steps_before < 0 || state.simulated.size() != state.events.size())
    throw std::runtime_error("its numbers contradict each other");
  return state;
}

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

void save_cascade(const CascadeState& state, parallel::Communicator comm, output::CheckpointWriter& file) {
  Json json{{"events", Json::array()},
            {"injuries", Json::array()},
            {"settled", state.simulated},
            {"elapsed_s", state.elapsed},
            {"steps_before", state.steps_before}};
  for (std::size_t i = 0; i < state.events.size(); ++i)
    json["events"].push_back(to_json(state.events[i], i + 1));
  for (const hemodynamics::VesselFailure& failure : state.failures)
    json["injuries"].push_back(to_json(failure));
  file.write(cascade_name, comm.broadcast(json.dump()));
}

CascadeState read_cascade(output::CheckpointReader& file) {
  std::string text;
  file.read(cascade_name, text);
  try {
    return state_of(Json::parse(text));
  } catch (const std::exception& error) {  // the same on every rank
    file.refuse(std::string("its state of a cascade cannot be read: ") + error.what());
  }
}

}  // namespace rhexis::studies
