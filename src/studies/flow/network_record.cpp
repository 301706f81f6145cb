// SPDX-License-Identifier: BSD-3-Clause
#include "studies/flow/network_record.hpp"

#include <optional>

#include "output/json.hpp"

namespace rhexis::studies {
namespace {

using output::or_null;
using Json = nlohmann::ordered_json;

Json screening_record(const screening::ScreenedNetwork& screened) {
  Json list = Json::array();
  for (std::size_t i = 0; i < screened.at_risk.size(); ++i) {
    const screening::RankedVessel& ranked = screened.screening.top[i];
    list.push_back({{"risk", ranked.risk}, {"alike", ranked.alike}});
    list.back().update(to_json(screened.at_risk[i]));
  }
  return {{"vessels", screened.screening.vessels},
          {"above_limit", screened.screening.above},
          {"top", std::move(list)}};
}

Json range_record(const network::MeasureRange& range) {
  return {range.least, range.largest};
}

Json survey_record(const network::NetworkSurvey& s) {
  return {{"parts", s.parts},
          {"loops", s.loops},
          {"conditions", s.conditions},
          {"ends", s.ends},
          {"ends_without_condition", s.open_ends.count},
          {"junctions_without_vessels", s.isolated.count},
          {"parts_without_flow", s.parts_with_one_opening.count},
          {"vessels_without_flow", s.without_flow()},
          {"assumed_walls", s.assumed_walls.count},
          {"radius_m", range_record(s.radius)},
          {"length_m", range_record(s.length)},
          {"notes", s.notes}};
}

}  // namespace

Json to_json(const hemodynamics::NetworkVessel& v) {
  Json json{{"name", v.name},
            {"vessel", v.vessel},
            {"kind", network::name_of(v.kind)},
            {"generation", nullptr},
            {"radius_m", v.radius},
            {"length_m", v.length},
            {"wall_thickness_m", v.wall_thickness},
            {"strength_factor", v.strength_factor},
            {"flow_m3_s", v.flow},
            {"pressure_from_Pa", v.pressure_from},
            {"pressure_to_Pa", v.pressure_to}};
  json["start_m"] = json["end_m"] = nullptr;
  if (v.generation >= 0) json["generation"] = v.generation;
  if (v.start) json["start_m"] = *v.start;
  if (v.end) json["end_m"] = *v.end;
  return json;
}

Json network_record(const SolvedNetwork* network) {
  Json json = Json::object();
  for (const char* name : {"vessels", "junctions", "inflow_m3_s", "max_imbalance", "volume_m3", "surface_m2",
                           "highest_reynolds", "highest_pressure_Pa", "lowest_pressure_Pa", "solver",
                           "iterations", "queries", "screening", "survey"})
    json[name] = nullptr;
  if (network == nullptr) return json;
  const hemodynamics::NetworkFlow& flow = network->flow();
  json["vessels"] = flow.vessels;
  json["junctions"] = flow.junctions;
  json["inflow_m3_s"] = flow.inflow;
  json["max_imbalance"] = or_null(flow.max_imbalance);
  json["volume_m3"] = or_null(flow.volume);
  json["surface_m2"] = or_null(flow.surface);
  json["highest_reynolds"] = flow.highest_reynolds;
  json["highest_pressure_Pa"] = flow.highest_pressure;
  json["lowest_pressure_Pa"] = flow.lowest_pressure;
  json["solver"] = flow.solver;
  json["iterations"] = or_null(flow.iterations);
  json["queries"] = Json::array();
  for (const hemodynamics::NetworkVessel& v : network->solution.queries)
    json["queries"].push_back(to_json(v));
  if (network->screened) json["screening"] = screening_record(*network->screened);
  if (network->solution.survey) json["survey"] = survey_record(*network->solution.survey);
  return json;
}

}  // namespace rhexis::studies
