// SPDX-License-Identifier: BSD-3-Clause
/// manifest.txt: which files of a results folder runs made.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace rhexis::output {

/// The file's first line, `rhexis results 1`, is followed by one line for each entry: `run <token>` of a run
/// that made temporary files (temporary_file.hpp), `file <name>`, and `folder <name>` below the results
/// folder that a run made. Names are relative to the results folder. A line is written before what it names.
struct Manifest {
  static constexpr const char* file_name = "manifest.txt";

  std::vector<std::string> tokens;
  std::set<std::string> files, folders;

  std::string text() const;
};

std::string manifest_line(std::string_view kind, std::string_view name);

/// Says what is wrong with a name relative to a results folder; empty where it is well formed: it does not
/// leave the folder ('..', an absolute path) and has no control characters.
std::string fault_of_name(std::string_view name);

/// Reads `directory`/manifest.txt; empty where there is none. A last line without an end, which a crash cut
/// short, counts as not there: what it announced was not made. Throws InputError, naming file and line, for
/// anything else that is not a manifest, a link among it.
Manifest read_manifest(const std::filesystem::path& directory);

}  // namespace rhexis::output
