// SPDX-License-Identifier: BSD-3-Clause
#include "network/graph.hpp"

#include <algorithm>

namespace rhexis::network {

std::size_t Graph::known_walls() const {
  return static_cast<std::size_t>(std::ranges::count_if(wall_thickness, [](double h) { return h > 0; }));
}

void Graph::add_pieces(std::span<const VesselPiece> of_vessel) {
  if (first_piece.empty()) first_piece.push_back(0);
  piece.insert(piece.end(), of_vessel.begin(), of_vessel.end());
  first_piece.push_back(static_cast<std::uint32_t>(piece.size()));
}

std::string Graph::name_of_junction(std::size_t j) const {
  return junction_name.empty() ? std::to_string(j) : junction_name[j];
}

std::string Graph::name_of_vessel(std::size_t v) const {
  return vessel_name.empty() ? std::to_string(v) : vessel_name[v];
}

std::string BoundedGraph::place_of_vessel(std::size_t v) const {
  std::string place = file;
  if (!vessel_line.empty()) place.append(":").append(std::to_string(vessel_line[v]));
  return place.append(": vessel ").append(graph.name_of_vessel(v));
}

}  // namespace rhexis::network
