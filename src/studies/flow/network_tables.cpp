// SPDX-License-Identifier: BSD-3-Clause
#include "studies/flow/network_tables.hpp"

#include <fmt/format.h>

#include <iterator>
#include <limits>

namespace rhexis::studies {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr const char* kinds[2] = {"artery", "vein"};

}  // namespace

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\n") == std::string::npos) return text;
  std::string result = "\"";
  for (const char c : text) result += c == '"' ? std::string("\"\"") : std::string(1, c);
  return result + '"';
}

std::string generation_table(const hemodynamics::TreeStatistics& s) {
  std::string table = "generation,kind,vessels,mean_length_m,volume_m3,surface_m2";
  for (const char* name : {"radius_m", "flow_m3_s", "pressure_Pa", "hoop_stress_Pa"}) {
    table += fmt::format(",mean_{0},least_{0},most_{0}", name);
  }
  table += '\n';
  for (const auto& g : s.generations) {
    for (std::size_t kind = 0; kind < 2; ++kind) {
      table += fmt::format("{},{},{:.0f},{},{},{}", g.generation, kinds[kind], g.vessels, g.mean_length,
                           g.volume[kind], g.surface[kind]);
      for (const hemodynamics::Spread& q : {g.radius[kind], g.flow, g.pressure[kind], g.hoop_stress[kind]}) {
        table += fmt::format(",{},{},{}", q.mean, q.least, q.most);
      }
      table += '\n';
    }
  }
  return table;
}

std::string histogram_table(const hemodynamics::TreeStatistics& s) {
  std::string table = "generation,kind,quantity,from,to,vessels\n";
  const auto add = [&](const auto& g, const char* kind, const char* quantity, const hemodynamics::Bins& bins,
                       double least, const std::vector<std::uint64_t>& counts) {
    for (std::size_t b = 0; b < counts.size(); ++b) {
      if (counts[b] == 0) continue;
      // The last bin of a geometric histogram holds all below.
      const double from = bins.geometric && b + 1 == counts.size() ? least : bins.lower_edge(b);
      fmt::format_to(std::back_inserter(table), "{},{},{},{},{},{}\n", g.generation, kind, quantity, from,
                     bins.upper_edge(b), counts[b]);
    }
  };
  for (const auto& g : s.generations) {
    add(g, "both", "flow_m3_s", s.flow_bins, 0, g.flow_counts);
    for (std::size_t kind = 0; kind < 2; ++kind) {
      add(g, kinds[kind], "pressure_Pa", s.pressure_bins, -infinity, g.pressure_counts[kind]);
      add(g, kinds[kind], "hoop_stress_Pa", s.stress_bins, -infinity, g.stress_counts[kind]);
    }
  }
  return table;
}

std::string screening_table(const screening::ScreenedNetwork& s) {
  std::string table =
      "rank,vessel,id,kind,generation,alike,risk,radius_m,wall_thickness_m,strength_factor,pressure_from_Pa,"
      "pressure_to_Pa,wall\n";
  for (std::size_t i = 0; i < s.at_risk.size(); ++i) {
    const screening::RankedVessel& ranked = s.screening.top[i];
    const hemodynamics::NetworkVessel& q = s.at_risk[i];
    fmt::format_to(std::back_inserter(table), "{},{},{},{},{},{:.0f},{},{},{},{},{},{},{}\n", i + 1,
                   quoted(q.name), q.vessel, network::name_of(q.kind), q.generation, ranked.alike,
                   ranked.risk, q.radius, q.wall_thickness, q.strength_factor, q.pressure_from, q.pressure_to,
                   q.wall_is_given ? "given" : "assumed");
  }
  return table;
}

std::string risk_table(const screening::Screening& s) {
  std::string table = "generation,kind,from,to,vessels\n";
  for (std::size_t g = 0; g < s.generations.size(); ++g) {
    for (std::size_t kind = 0; kind < 2; ++kind) {
      const auto& counts = s.generations[g].counts[kind];
      for (std::size_t b = counts.size(); b-- > 0;) {
        if (counts[b] == 0) continue;
        // The outermost bins hold all beyond.
        const double from = b + 1 == counts.size() ? 0 : s.bins.lower_edge(b);
        const std::string to = b == 0 ? "inf" : fmt::format("{}", s.bins.upper_edge(b));
        fmt::format_to(std::back_inserter(table), "{},{},{},{},{}\n", static_cast<long>(g) - 1,
                       g == 0 ? "vessel" : kinds[kind], from, to, counts[b]);
      }
    }
  }
  return table;
}

std::string vessel_table(const std::vector<hemodynamics::VesselTableRow>& rows) {
  std::string table =
      "vessel,from,to,radius_m,length_m,haematocrit,flow_m3_s,pressure_from_Pa,pressure_to_Pa\n";
  for (const hemodynamics::VesselTableRow& r : rows) {
    fmt::format_to(std::back_inserter(table), "{},{},{},{},{},{},{},{},{}\n", quoted(r.name), quoted(r.from),
                   quoted(r.to), r.radius, r.length, r.haematocrit, r.flow, r.pressure_from, r.pressure_to);
  }
  return table;
}

}  // namespace rhexis::studies
