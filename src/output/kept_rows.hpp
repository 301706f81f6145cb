// SPDX-License-Identifier: BSD-3-Clause
/// Tables of an earlier run that a restart continues.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

namespace rhexis::output {

/// The header and those complete rows of the CSV file `path` whose first cell `keeps` accepts; a last row
/// without a line break, which a crash cut short, is left out. The header alone where there is no file.
/// Throws InputError that names file, line and what is wrong, if the first line is not `header`, a row has
/// another number of cells, a cell is neither empty nor a finite number, or first cells do not increase.
/// Local to the calling rank.
std::string kept_rows(const std::filesystem::path& path, const std::string& header,
                      const std::function<bool(double first_cell)>& keeps);

}  // namespace rhexis::output
