// SPDX-License-Identifier: BSD-3-Clause
// What tests of networks from files share: units, a folder to write files to, and reading them as a run does.
#pragma once

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "network/files/network_file.hpp"
#include "network/names.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::network {

/// Converts units; in the program this is UDUNITS.
inline double to_si(std::string_view quantity, std::string_view unit) {
  static const std::map<std::string, std::pair<double, std::string>, std::less<>> units{
      {"1 um", {1e-6, "m"}},
      {"1 nm", {1e-9, "m"}},
      {"1 mm", {1e-3, "m"}},
      {"1 cm", {1e-2, "m"}},
      {"1 m", {1, "m"}},
      {"1 \xc2\xb5m", {1e-6, "m"}},
      {"1 \xce\xbcm", {1e-6, "m"}},
      {"1 mmHg", {133.322, "Pa"}},
      {"1 Pa", {1, "Pa"}},
      {"1 m3/s", {1, "m3/s"}},
      {"1 mL/min", {1e-6 / 60, "m3/s"}},
      {"1 Pa s/m3", {1, "Pa s/m3"}}};
  const auto found = units.find(quantity);
  if (found == units.end() || found->second.second != unit)
    throw InputError("not a unit of " + std::string(unit));
  return found->second.first;
}

class NetworkCase : public testing::Test {
 protected:
  std::filesystem::path write(const std::string& name, const std::string& text) {
    const auto path = folder_.path() / name;
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }

  /// The network of `files`, names with texts, as a run reads it.
  BoundedGraph network(const std::vector<std::pair<std::string, std::string>>& files,
                       Parameters parameters = {}) {
    for (const auto& [name, text] : files) parameters.files.push_back(write(name, text).string());
    return read_network(parameters, to_si);
  }

  /// `read` throws InputError with all `fragments`; of its message the folder's name is left out.
  template <class Read>
  void refused(const Read& read, const std::vector<std::string>& fragments, const std::string& key = "") {
    try {
      read();
      ADD_FAILURE() << "accepted; expected: " << fragments.front();
    } catch (const InputError& error) {
      for (const std::string& fragment : fragments) {
        EXPECT_NE(std::string(error.what()).find(fragment), std::string::npos)
            << error.what() << "\nlacks " << fragment;
      }
      if (!key.empty()) {
        EXPECT_EQ(error.key, key) << error.what();
      }
    }
  }

  /// All notes and warnings, one a line.
  static std::string notes_of(const BoundedGraph& network) {
    std::string all;
    for (const auto* sentences : {&network.notes, &network.warnings})
      for (const std::string& sentence : *sentences) all += sentence + "\n";
    return all;
  }

  test::TemporaryDirectory folder_;
};

}  // namespace rhexis::network
