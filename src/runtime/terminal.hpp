// SPDX-License-Identifier: BSD-3-Clause
/// The terminal, which must never cost a run: text that cannot be written is lost, and that is noticed.
#pragma once

#include <string>
#include <string_view>

namespace rhexis::runtime {

/// Opens what the caller has closed of stdin, stdout and stderr, so that no file of results takes their
/// place: stdout so that writing to it fails. Before anything else opens a file.
void open_missing_streams();

/// Writes to stdout now.
void print_out(std::string_view text);
/// Writes to stderr.
void print_error(std::string_view text);

/// Why something written to stdout is lost; empty where nothing is.
std::string output_failure();

}  // namespace rhexis::runtime
