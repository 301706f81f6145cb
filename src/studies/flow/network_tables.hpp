// SPDX-License-Identifier: BSD-3-Clause
/// Tables of a network's results, as CSV.
#pragma once

#include <string>
#include <vector>

#include "hemodynamics/steady/flow_solver.hpp"
#include "studies/screening/network_screening.hpp"

namespace rhexis::studies {

/// A name as a CSV field.
std::string quoted(const std::string& text);

/// A row for each generation and kind: count, radius, length, volume, surface; mean, least and most of
/// pressure, flow and hoop stress. SI units, named in the header.
std::string generation_table(const hemodynamics::TreeStatistics& s);

/// A row for each bin that is not empty: generation, kind, quantity, edges, vessels.
std::string histogram_table(const hemodynamics::TreeStatistics& s);

/// The table of the vessels at highest risk, as CSV.
std::string screening_table(const screening::ScreenedNetwork& screened);
/// How many vessels of every generation have what risk.
std::string risk_table(const screening::Screening& screening);

/// A row for each vessel of an explicit network.
std::string vessel_table(const std::vector<hemodynamics::VesselTableRow>& rows);

}  // namespace rhexis::studies
