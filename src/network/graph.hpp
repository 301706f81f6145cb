// SPDX-License-Identifier: BSD-3-Clause
/// A vascular network as an explicit graph: junctions joined by vessels (Sec. 3.3). Any degree, loops,
/// several components, dead ends and isolated junctions are allowed.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace rhexis::network {

using Point = std::array<double, 3>;

/// m; a radius, length or wall beyond these is in the wrong unit. The smallest is less than an atom.
constexpr double smallest_measure = 1e-12, largest_measure = 100;

/// The highest discharge haematocrit, as a fraction, that blood may enter with.
constexpr double highest_haematocrit = 0.95;

enum class VesselKind : std::uint8_t { artery = 0, vein = 1, unknown = 2 };

/// "artery", "vein", or "vessel" where that is unknown.
inline const char* name_of(VesselKind kind) {
  return kind == VesselKind::artery ? "artery" : kind == VesselKind::vein ? "vein" : "vessel";
}

/// A stretch of a vessel that has one radius, in m. `start` is where it begins.
struct VesselPiece {
  double radius = 0, length = 0;
  Point start{};
};

/// Arrays over J junctions and V vessels; those marked optional are empty where nobody knows their values.
struct Graph {
  std::size_t junctions = 0;    ///< J
  std::vector<double> x, y, z;  ///< [J] position, m; optional
  std::vector<std::uint32_t> from,
      to;  ///< [V] junctions that a vessel joins; blood flowing from -> to counts as positive
  std::vector<double> radius, length;      ///< [V] of the lumen, m; of radii that vary along it, the mean
  std::vector<double> wall_thickness;      ///< [V] m; optional: the wall rule gives it
  std::vector<VesselKind> kind;            ///< [V] optional
  std::vector<std::int8_t> generation;     ///< [V] optional
  std::vector<std::string> junction_name;  ///< [J] as in the user's file; optional: the index is the name
  std::vector<std::string> vessel_name;    ///< [V] as in the user's file; optional: the index is the name
  std::vector<std::string> junction_label,
      vessel_label;  ///< [J], [V] further names, empty where there is none; optional
  /// Pieces of vessels that have several, from `from` to `to`: vessel v's begin at first_piece[v] and end
  /// before first_piece[v + 1] in `piece`. Both are optional: no vessel has any.
  std::vector<std::uint32_t> first_piece;  ///< [V + 1]
  std::vector<VesselPiece> piece;

  std::size_t vessels() const { return from.size(); }
  /// Whether the thickness of a vessel's wall is given; else the wall rule assumes it.
  bool knows_wall(std::size_t v) const { return !wall_thickness.empty() && wall_thickness[v] > 0; }
  /// The number of vessels of which it is.
  std::size_t known_walls() const;
  /// None where the vessel is one stretch of one radius.
  std::span<const VesselPiece> pieces(std::size_t v) const {
    if (first_piece.empty()) return {};
    return {piece.begin() + first_piece[v], piece.begin() + first_piece[v + 1]};
  }
  /// Gives the first vessel that has none yet its pieces.
  void add_pieces(std::span<const VesselPiece> of_vessel);
  /// Calls `use(radius, length)` for every piece of a vessel, or once for the whole of it.
  template <class Use>
  void for_each_piece(std::size_t v, const Use& use) const {
    if (pieces(v).empty()) use(radius[v], length[v]);
    for (const VesselPiece& p : pieces(v)) use(p.radius, p.length);
  }
  /// The radius of a vessel at one of its ends, m.
  double radius_at(std::size_t v, std::uint32_t junction) const {
    if (pieces(v).empty()) return radius[v];
    return junction == from[v] ? pieces(v).front().radius : pieces(v).back().radius;
  }
  std::string name_of_junction(std::size_t j) const;
  std::string name_of_vessel(std::size_t v) const;
};

/// What is known at a junction. A pressure may lie behind a resistance (a peripheral bed that is not
/// modelled): flow into it is (p_junction - value) / resistance.
struct BoundaryCondition {
  enum class Kind : std::uint8_t { pressure, flow };
  std::uint32_t junction = 0;
  Kind kind = Kind::pressure;
  double value = 0;       ///< pressure relative to atmosphere, Pa; or flow into the network, m3/s
  double resistance = 0;  ///< Pa s/m3, of a pressure condition; 0: the pressure is the junction's own
  std::optional<double> haematocrit = {};  ///< of blood that enters here, a fraction; none: the input's
};

/// A network and what its file says of its boundary.
struct BoundedGraph {
  Graph graph;
  std::vector<BoundaryCondition> conditions;
  /// Junctions of which the file tells only whether blood flows in or out there, which settles no flow.
  std::vector<std::uint32_t> directed_ends = {};
  std::vector<std::string> notes = {};     ///< sentences for the user: what was ignored, merged or assumed
  std::vector<std::string> warnings = {};  ///< sentences for the user: what is probably not meant
  std::string file = {};                   ///< that the vessels are from
  std::vector<std::uint32_t> vessel_line = {};  ///< [V] of `file`, from 1; optional: it has no lines

  /// "vessels.csv:12: vessel 7", to open a message.
  std::string place_of_vessel(std::size_t v) const;
};

}  // namespace rhexis::network
