// SPDX-License-Identifier: BSD-3-Clause
#include "network/files/network_file.hpp"

#include <algorithm>
#include <string_view>

#include "core/error.hpp"
#include "core/text_file.hpp"
#include "network/files/vtp_network.hpp"

namespace rhexis::network {
namespace {

struct FormatOfFiles {
  std::string_view extension;
  std::size_t files;
  NetworkFormat format;
};

constexpr FormatOfFiles formats[] = {
    {".csv", 2, NetworkFormat::csv}, {".json", 1, NetworkFormat::json}, {".vtp", 1, NetworkFormat::vtp}};

/// ".csv" of "J.CSV".
std::string extension_of(const std::string& file) {
  std::string extension = std::filesystem::path(file).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return extension;
}

}  // namespace

std::string read_network_text(const std::filesystem::path& file) {
  std::string text = whole_file(file);
  if (text.find_first_not_of(" \t\r\n") == std::string::npos)
    throw InputError(file.string() + ": the file is empty");
  if (text.find('\0') != std::string::npos) throw InputError(file.string() + ": not a text file");
  return text;
}

NetworkFormat format_of(const std::vector<std::string>& files) {
  for (const FormatOfFiles& known : formats) {
    const auto is_of_format = [&](const std::string& file) { return extension_of(file) == known.extension; };
    if (files.size() == known.files && std::ranges::all_of(files, is_of_format)) return known.format;
  }
  throw InputError("name one .json or .vtp file, or two .csv files: first junctions, then vessels");
}

bool lacks_length_unit(NetworkFormat format) {
  return format == NetworkFormat::vtp;
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
