// SPDX-License-Identifier: BSD-3-Clause
/// What the program and its plugin librhexis_vtp.so say to each other: plain arrays, no VTK.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace rhexis::network::vtp {

struct Array {
  std::string name;
  int components = 1;
  bool integer = false;        ///< written as 32-bit integers
  std::vector<double> values;  ///< [points or lines][components]
};

/// The lines of a PolyData: line l joins the points connectivity[offsets[l]] .. [offsets[l + 1] - 1].
struct Lines {
  std::vector<double> coordinates;         ///< [points][3]
  std::vector<std::int64_t> offsets{0};    ///< [lines + 1]
  std::vector<std::int64_t> connectivity;  ///< checked by nobody yet
  std::int64_t first_cell = 0;             ///< the file's number of line 0: vertices are counted before it
  std::vector<Array> point_arrays;         ///< all numeric ones, as the file has them
  std::vector<Array> cell_arrays;          ///< the cell arrays of the lines only
  std::vector<std::string> point_names;    ///< [points], or empty: their numbers
  std::vector<std::string> line_names;     ///< [lines], or empty: the file's numbers

  std::size_t points() const { return coordinates.size() / 3; }
  std::size_t lines() const { return offsets.size() - 1; }
};

enum class Format : std::uint8_t { xml, legacy };

/// What went wrong is put into `problem`, which is empty before. They print nothing and throw nothing.
using Read = void(const std::string& path, Format format, Lines& lines, std::string& problem);
using Write = void(const std::string& path, const Lines& lines, std::string& problem);
inline constexpr const char* library = "librhexis_vtp.so";
inline constexpr const char* read_symbol = "rhexis_vtp_read";
inline constexpr const char* write_symbol = "rhexis_vtp_write";

}  // namespace rhexis::network::vtp
