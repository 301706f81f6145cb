// SPDX-License-Identifier: BSD-3-Clause
/// A network as it was read and repaired, in SI with its conditions: a file that can be read again. Pieces of
/// vessels (of centre lines) become vessels of their own.
#pragma once

#include <filesystem>
#include <string>

#include "network/graph.hpp"

namespace rhexis::network {

/// The network with a vessel for each piece: "7.2" is the third of vessel 7, which begins at junction "7.2".
/// It is the network itself where no vessel has pieces.
BoundedGraph with_vessels_for_pieces(const BoundedGraph& network);

/// A JSON file (see network_file.hpp) that holds all of the network; to read it gives the same network.
std::string json_of(const BoundedGraph& network);

/// Throws InputError, naming `path`, where a VTP file cannot hold the network: without coordinates, with
/// the wall thickness of some vessels alone, or with resistances at its ends.
void check_fits_vtp(const BoundedGraph& network, const std::filesystem::path& path);

/// The network in metres as a VTP file (see vtp_network.hpp). Names are not in it. Throws RunError.
void write_vtp_network(const std::filesystem::path& path, const BoundedGraph& network);

}  // namespace rhexis::network
