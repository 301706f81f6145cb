// SPDX-License-Identifier: BSD-3-Clause
/// What a file holds, read with HDF5's serial C API, as any other program would.
#pragma once

#include <hdf5.h>
#include <sys/stat.h>

#include <filesystem>
#include <string>
#include <vector>

#include "synthetic_source.hpp"

namespace rhexis::test {

/// A data set as doubles, empty if the file cannot be opened or has no such data set.
inline std::vector<double> stored(const std::filesystem::path& path, const std::string& dataset) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t set = file < 0 ? -1 : H5Dopen2(file, dataset.c_str(), H5P_DEFAULT);
  std::vector<double> values;
  if (set >= 0) {
    const hid_t space = H5Dget_space(set);
    values.resize(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
    if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0) values.clear();
    H5Sclose(space);
    H5Dclose(set);
  }
  if (file >= 0) H5Fclose(file);
  return values;
}

inline std::string stored_text(const std::filesystem::path& path, const std::string& object,
                               const std::string& name) {
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  const hid_t attribute = H5Aopen_by_name(file, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT);
  const hid_t type = H5Aget_type(attribute);
  std::string text(H5Tget_size(type), '\0');
  H5Aread(attribute, type, text.data());
  H5Tclose(type);
  H5Aclose(attribute);
  H5Fclose(file);
  return text.c_str();
}

inline std::vector<double> expected(const std::string& field, int components, std::int64_t points,
                                    long step) {
  std::vector<double> values;
  for (std::int64_t id = 0; id < points; ++id) {
    for (int c = 0; c < components; ++c) values.push_back(test::expected_value(field, c, id, step));
  }
  return values;
}

inline std::int64_t bytes_on_disk(const std::filesystem::path& path) {
  struct stat status {};
  stat(path.c_str(), &status);
  return std::int64_t{status.st_blocks} * 512;
}

}  // namespace rhexis::test
