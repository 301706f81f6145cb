// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_file.hpp"

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "network/files/vtp_network.hpp"

namespace rhexis::network {

std::string read_network_text(const std::filesystem::path& file) {
  std::string text = whole_file(file);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(file.string() + ": the file is empty");
  if (text.find('\0') != std::string::npos) throw InputError(file.string() + ": not a text file");
  return text;
}

NetworkFormat format_of(const std::vector<std::string>& files) {
  const auto extension = [&](std::size_t i) { return std::filesystem::path(files[i]).extension().string(); };
  if (files.size() == 2 && extension(0) == ".csv" && extension(1) == ".csv") return NetworkFormat::csv;
  if (files.size() == 1 && extension(0) == ".json") return NetworkFormat::json;
  if (files.size() == 1 && extension(0) == ".vtp") return NetworkFormat::vtp;
  throw InputError("name one .json or .vtp file, or two .csv files: first junctions, then vessels");
}

BoundedGraph read_network(const Parameters& parameters, const ToSi& to_si) {
  const std::vector<std::string>& files = parameters.files;
  switch (format_of(files)) {
    case NetworkFormat::csv:
      return read_csv_network(files[0], files[1], to_si);
    case NetworkFormat::json:
      return read_json_network(files[0], to_si);
    case NetworkFormat::vtp:
      break;
  }
  return read_vtp_network(files[0], to_si("1 " + parameters.file_length_unit, "m"));
}

}  // namespace rhexis::network
