// SPDX-License-Identifier: BSD-3-Clause
/// What a reader of networks is told besides the name of the file.
#pragma once

#include <string>

#include "core/csv_table.hpp"
#include "network/lines/line_network.hpp"

namespace rhexis::network {

struct FileOptions {
  ToSi to_si = {};               ///< reads units
  std::string length_unit = {};  ///< of lengths whose unit the file does not tell; empty: it has to tell it
  double merge_tolerance = default_merge_tolerance;  ///< of centre lines, a fraction of the radius
  bool drops_self_loops = false;  ///< a vessel from a junction to itself is left out, and else refused
};

}  // namespace rhexis::network
