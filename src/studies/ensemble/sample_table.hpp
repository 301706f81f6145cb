// SPDX-License-Identifier: BSD-3-Clause
/// samples.csv as text: a row per sample; numbers are the shortest decimals that read back as the same
/// double.
#pragma once

#include <string>
#include <vector>

#include "studies/ensemble/sample.hpp"

namespace rhexis::ensemble {

extern const char* const sample_header;  ///< with its line break

std::string row(const Sample& sample);

/// The samples of a table's `text`; a last line without a line break, which a crash cut short, is left out.
/// Throws InputError that names `file` and line.
std::vector<Sample> read_samples(const std::string& text, const std::string& file);

}  // namespace rhexis::ensemble
