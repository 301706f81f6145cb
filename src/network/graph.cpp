// SPDX-License-Identifier: BSD-3-Clause
#include "network/graph.hpp"

namespace rhexis::network {

std::string Graph::name_of_junction(std::size_t j) const {
  return junction_name.empty() ? std::to_string(j) : junction_name[j];
}

std::string Graph::name_of_vessel(std::size_t v) const {
  return vessel_name.empty() ? std::to_string(v) : vessel_name[v];
}

}  // namespace rhexis::network
