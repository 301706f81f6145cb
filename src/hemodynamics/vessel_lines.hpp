// SPDX-License-Identifier: BSD-3-Clause
/// The vessels of a network as lines with fields, for files and pictures; a vessel of several pieces is as
/// many lines.
///
/// Points: `pressure` (Pa, relative to atmosphere). Lines: `flow` (m3/s, along the line), `radius` (m),
/// `generation` (-1: unknown), `kind` (0 artery, 1 vein, 2 unknown), `wall_shear_stress` (Pa), `hoop_strain`
/// (at the lumen, under the mean of both ends' pressures; network/wall.hpp), `haematocrit`, `vessel` (id or
/// number).
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "hemodynamics/hydrostatic.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "hemodynamics/steady/tree/tree_flow.hpp"
#include "hemodynamics/viscosity.hpp"
#include "network/graph.hpp"
#include "network/tree/tree_selection.hpp"
#include "network/wall_variation.hpp"

namespace rhexis::hemodynamics {

/// What turns pressures and radii into strain and shear.
struct VesselMechanics {
  network::Wall artery_wall, vein_wall;
  network::WallVariation variation;
  bool numbered_by_id = false;  ///< a graph's vessels have the ids of a tree
  std::span<const std::int64_t> numbers =
      {};  ///< numbers of a graph's vessels in the whole graph, if it is a part of one
  double young_modulus = 1, poisson_ratio = 0.25;
  Viscosity viscosity;
  Hydrostatic hydrostatic;
};

class VesselLines : public LineSource {
 public:
  /// Empty: a rank that shows nothing.
  VesselLines() = default;

  /// Places of a tree with their flow, artery and vein each.
  static VesselLines of_tree(const TreeFlow& flow, std::span<const network::SelectedPlace> places,
                             std::span<const PlaceFlow> flows, const VesselMechanics& mechanics);
  /// The vessels of a graph that are listed. `haematocrit` [V] or empty.
  static VesselLines of_graph(const network::Graph& graph, const GraphFlow& flow,
                              std::span<const std::uint32_t> vessels, std::span<const double> haematocrit,
                              const VesselMechanics& mechanics);

  /// A new moment; the first is step 0 at 0 s, without annotations.
  void moment(long step, double time_s, std::vector<Annotation> annotations) {
    step_ = step;
    time_s_ = time_s;
    annotations_ = std::move(annotations);
  }
  std::size_t count() const { return connectivity_.size() / 2; }

  long step() const override { return step_; }
  double time_s() const override { return time_s_; }
  FieldView positions() override;
  std::span<const std::int64_t> connectivity() override { return connectivity_; }
  std::span<const FieldInfo> fields() const override;
  FieldView field(std::string_view name) override;
  std::vector<Annotation> annotations() const override { return annotations_; }

 private:
  /// One vessel before it is added.
  struct Vessel {
    std::int64_t from, to;  ///< points
    double flow, radius, length, wall_thickness, generation, haematocrit, number;
    network::VesselKind kind;
  };
  std::int64_t add_point(const network::Point& position, double pressure);
  void add(const Vessel& vessel, const VesselMechanics& mechanics);
  void add_pieces(const Vessel& vessel, const network::Graph& graph, std::size_t number,
                  const VesselMechanics& mechanics);

  long step_ = 0;
  double time_s_ = 0;
  std::array<std::vector<double>, 3> position_;
  std::vector<double> pressure_;
  std::vector<std::int64_t> connectivity_;
  std::map<std::string, std::vector<double>, std::less<>> line_values_;
  std::vector<Annotation> annotations_;
};

/// How a vessel's wall differs from its rule.
network::WallFactors wall_factors(const network::Graph& graph, std::size_t vessel,
                                  const VesselMechanics& mechanics);
/// Wall thickness of a vessel (m): its own where the graph has it, else by the rule for its kind; times its
/// factor.
double wall_thickness(const network::Graph& graph, std::size_t vessel, const VesselMechanics& mechanics);
/// The same where the lumen's radius (m) is not the mean.
double wall_thickness_at(const network::Graph& graph, std::size_t vessel, double radius,
                         const VesselMechanics& mechanics);

}  // namespace rhexis::hemodynamics
