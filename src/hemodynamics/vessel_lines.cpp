// SPDX-License-Identifier: BSD-3-Clause
#include "hemodynamics/vessel_lines.hpp"

#include <cmath>
#include <stdexcept>
#include <unordered_map>

#include "hemodynamics/poiseuille.hpp"

namespace rhexis::hemodynamics {
namespace {

using network::VesselKind;

constexpr std::array all_fields = {
    FieldInfo{"pressure", "Pa", 1, Centring::point},
    FieldInfo{"flow", "m3/s", 1, Centring::cell},
    FieldInfo{"radius", "m", 1, Centring::cell},
    FieldInfo{"length", "m", 1, Centring::cell},
    FieldInfo{"generation", "1", 1, Centring::cell},
    FieldInfo{"kind", "1", 1, Centring::cell},
    FieldInfo{"wall_shear_stress", "Pa", 1, Centring::cell},
    FieldInfo{"hoop_strain", "1", 1, Centring::cell},
    FieldInfo{"haematocrit", "1", 1, Centring::cell},
    FieldInfo{"vessel", "1", 1, Centring::cell},
};

const FieldInfo& info_of(std::string_view name) {
  for (const FieldInfo& info : all_fields) {
    if (info.name == name) return info;
  }
  throw std::out_of_range("a network has no field " + std::string(name));
}

const network::Wall& wall_of(const VesselMechanics& mechanics, VesselKind kind) {
  return kind == VesselKind::vein ? mechanics.vein_wall : mechanics.artery_wall;
}

}  // namespace

network::WallFactors wall_factors(const network::Graph& graph, std::size_t vessel,
                                  const VesselMechanics& mechanics) {
  const VesselKind kind = graph.kind.empty() ? VesselKind::unknown : graph.kind[vessel];
  const std::uint64_t number =
      mechanics.numbers.empty() ? vessel : static_cast<std::uint64_t>(mechanics.numbers[vessel]);
  return mechanics.variation.of(kind,
                                mechanics.numbered_by_id ? network::TreePair::place_of(number) : number);
}

double wall_thickness(const network::Graph& graph, std::size_t vessel, const VesselMechanics& mechanics) {
  return wall_thickness_at(graph, vessel, graph.radius[vessel], mechanics);
}

double wall_thickness_at(const network::Graph& graph, std::size_t vessel, double radius,
                         const VesselMechanics& mechanics) {
  const double factor = wall_factors(graph, vessel, mechanics).thickness;
  if (graph.knows_wall(vessel)) return factor * graph.wall_thickness[vessel];
  const VesselKind kind = graph.kind.empty() ? VesselKind::unknown : graph.kind[vessel];
  return factor * radius * wall_of(mechanics, kind).relative_thickness(radius);
}

std::int64_t VesselLines::add_point(const network::Point& position, double pressure) {
  for (std::size_t i = 0; i < 3; ++i) position_[i].push_back(position[i]);
  pressure_.push_back(pressure);
  return static_cast<std::int64_t>(pressure_.size()) - 1;
}

void VesselLines::add(const Vessel& v, const VesselMechanics& mechanics) {
  connectivity_.push_back(v.from);
  connectivity_.push_back(v.to);
  const double pressure =
      0.5 * (pressure_[static_cast<std::size_t>(v.from)] + pressure_[static_cast<std::size_t>(v.to)]);
  const double viscosity = apparent_viscosity(mechanics.viscosity, v.radius, v.haematocrit);
  line_values_["flow"].push_back(v.flow);
  line_values_["radius"].push_back(v.radius);
  line_values_["length"].push_back(v.length);
  line_values_["generation"].push_back(v.generation);
  line_values_["kind"].push_back(static_cast<double>(v.kind));
  line_values_["wall_shear_stress"].push_back(wall_shear_stress(v.radius, viscosity, std::abs(v.flow)));
  line_values_["hoop_strain"].push_back(network::lumen_hoop_strain(
      pressure, v.wall_thickness / v.radius, mechanics.young_modulus, mechanics.poisson_ratio));
  line_values_["haematocrit"].push_back(v.haematocrit);
  line_values_["vessel"].push_back(v.number);
}

/// A line for each piece of a vessel. Without the weight of blood, the pressure falls with the resistance.
void VesselLines::add_pieces(const Vessel& vessel, const network::Graph& graph, std::size_t number,
                             const VesselMechanics& mechanics) {
  const std::span<const network::VesselPiece> pieces = graph.pieces(number);
  const auto weight_at = [&](const network::Point& x) {
    return mechanics.hydrostatic.pressure(x[0], x[1], x[2]);
  };
  const auto place_of = [&](std::int64_t point) {
    const auto p = static_cast<std::size_t>(point);
    return network::Point{position_[0][p], position_[1][p], position_[2][p]};
  };
  const auto driving = [&](std::int64_t point) {
    return pressure_[static_cast<std::size_t>(point)] - weight_at(place_of(point));
  };
  const auto resistance_of = [&](const network::VesselPiece& p) {
    return poiseuille_resistance(p.radius, p.length,
                                 apparent_viscosity(mechanics.viscosity, p.radius, vessel.haematocrit));
  };
  double whole = 0, passed = 0;
  for (const network::VesselPiece& p : pieces) whole += resistance_of(p);
  const double first = driving(vessel.from), last = driving(vessel.to);
  Vessel piece = vessel;
  for (std::size_t i = 0; i < pieces.size(); ++i) {
    passed += resistance_of(pieces[i]);
    piece.from = i == 0 ? vessel.from : piece.to;
    piece.to = vessel.to;
    if (i + 1 < pieces.size()) {
      const network::Point& x = pieces[i + 1].start;
      piece.to = add_point(x, std::lerp(first, last, passed / whole) + weight_at(x));
    }
    piece.radius = pieces[i].radius;
    piece.length = pieces[i].length;
    piece.wall_thickness = wall_thickness_at(graph, number, piece.radius, mechanics);
    add(piece, mechanics);
  }
}

VesselLines VesselLines::of_tree(const TreeFlow& flow, std::span<const network::SelectedPlace> places,
                                 std::span<const PlaceFlow> flows, const VesselMechanics& mechanics) {
  using network::TreePair;
  VesselLines lines;
  const TreePair& tree = flow.tree();
  const auto weight = [&](const network::Point& p) {
    return mechanics.hydrostatic.pressure(p[0], p[1], p[2]);
  };
  struct FarPoints {
    std::int64_t artery, vein;
  };
  std::unordered_map<std::uint64_t, FarPoints> far;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::uint64_t place = places[i].place;
    const network::Point& near = places[i].near;
    const network::TreePair::Place& at = places[i].at;
    const PlaceFlow& f = flows[i];
    const network::Point mirrored_end = TreePair::mirrored(at.end), mirrored_near = TreePair::mirrored(near);
    const bool last = 2 * place > tree.places();
    FarPoints ends{};
    ends.artery = lines.add_point(at.end, f.artery_far + weight(at.end));
    ends.vein = last ? ends.artery : lines.add_point(mirrored_end, f.vein_far + weight(mirrored_end));
    far[place] = ends;
    const auto parent = far.find(place / 2);
    const FarPoints starts =
        parent != far.end() ? parent->second
                            : FarPoints{lines.add_point(near, f.artery_near + weight(near)),
                                        lines.add_point(mirrored_near, f.vein_near + weight(mirrored_near))};
    const int generation = TreePair::generation_of(place);
    const double radius = tree.radius_of(at.capacity);
    const double length = tree.rules().length(generation, radius) * tree.length_factor(place);
    const auto vessel = [&](VesselKind kind) {
      const double r = kind == VesselKind::artery ? radius : radius * tree.rules().vein_radius_ratio;
      return Vessel{.from = kind == VesselKind::artery ? starts.artery : ends.vein,
                    .to = kind == VesselKind::artery ? ends.artery : starts.vein,
                    .flow = f.flow,
                    .radius = r,
                    .length = length,
                    .wall_thickness = r * wall_of(mechanics, kind).relative_thickness(r) *
                                      mechanics.variation.of(kind, place).thickness,
                    .generation = static_cast<double>(generation),
                    .haematocrit = mechanics.viscosity.haematocrit,
                    .number = static_cast<double>(TreePair::id_of(place, kind)),
                    .kind = kind};
    };
    lines.add(vessel(VesselKind::artery), mechanics);
    lines.add(vessel(VesselKind::vein), mechanics);
  }
  return lines;
}

VesselLines VesselLines::of_graph(const network::Graph& graph, const GraphFlow& flow,
                                  std::span<const std::uint32_t> vessels, std::span<const double> haematocrit,
                                  const VesselMechanics& mechanics) {
  VesselLines lines;
  std::unordered_map<std::uint32_t, std::int64_t> points;
  const auto point = [&](std::uint32_t j) {
    const auto [found, isnew] = points.try_emplace(j, 0);
    if (isnew) found->second = lines.add_point({graph.x[j], graph.y[j], graph.z[j]}, flow.pressure[j]);
    return found->second;
  };
  for (const std::uint32_t v : vessels) {
    const std::int64_t from = point(graph.from[v]), to = point(graph.to[v]);
    const Vessel vessel{.from = from,
                        .to = to,
                        .flow = flow.flow[v],
                        .radius = graph.radius[v],
                        .length = graph.length[v],
                        .wall_thickness = wall_thickness(graph, v, mechanics),
                        .generation = graph.generation.empty() ? -1.0 : graph.generation[v],
                        .haematocrit = haematocrit.empty() ? mechanics.viscosity.haematocrit : haematocrit[v],
                        .number = static_cast<double>(mechanics.numbers.empty() ? v : mechanics.numbers[v]),
                        .kind = graph.kind.empty() ? VesselKind::unknown : graph.kind[v]};
    if (graph.pieces(v).empty())
      lines.add(vessel, mechanics);
    else
      lines.add_pieces(vessel, graph, v, mechanics);
  }
  return lines;
}

FieldView VesselLines::positions() {
  return {{"position", "m", 3, Centring::point},
          {position_[0].data(), position_[1].data(), position_[2].data()},
          pressure_.size()};
}

std::span<const FieldInfo> VesselLines::fields() const {
  return all_fields;
}

FieldView VesselLines::field(std::string_view name) {
  const FieldInfo& info = info_of(name);
  if (info.centring == Centring::point) return {info, {pressure_.data()}, pressure_.size()};
  const std::vector<double>& values = line_values_[std::string(name)];
  return {info, {values.data()}, values.size()};
}

}  // namespace rhexis::hemodynamics
