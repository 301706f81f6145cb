// SPDX-License-Identifier: BSD-3-Clause
#include "output/manifest.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <sstream>

#include "core/error.hpp"
#include "core/text_file.hpp"

namespace rhexis::output {
namespace {

constexpr std::string_view first_line = "rhexis results 1";

bool is_token(std::string_view text) {
  return text.size() == 16 && text.find_first_not_of("0123456789abcdef") == std::string_view::npos;
}

/// Puts the entry into the manifest and says what is wrong with it.
std::string take(std::string_view line, Manifest& manifest) {
  const std::size_t space = line.find(' ');
  const std::string_view kind = line.substr(0, space);
  const std::string name(space == std::string_view::npos ? "" : line.substr(space + 1));
  if (kind == "run") {
    manifest.tokens.push_back(name);
    return is_token(name) ? "" : "not a run's 16 hexadecimal digits";
  }
  if (kind != "file" && kind != "folder") return "an entry is 'run', 'file' or 'folder', and a name";
  (kind == "file" ? manifest.files : manifest.folders).insert(name);
  return fault_of_name(name);
}

}  // namespace

std::string manifest_line(std::string_view kind, std::string_view name) {
  return fmt::format("{} {}\n", kind, name);
}

std::string Manifest::text() const {
  std::string text = fmt::format("{}\n", first_line);
  for (const std::string& token : tokens) text += manifest_line("run", token);
  for (const std::string& name : folders) text += manifest_line("folder", name);
  for (const std::string& name : files) text += manifest_line("file", name);
  return text;
}

std::string fault_of_name(std::string_view name) {
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < ' ' || c == '\x7f'; };
  if (std::ranges::any_of(name, is_control)) return "a name has no control characters";
  if (name.empty() || name.starts_with('/')) return "a name is relative to the results folder";
  std::istringstream parts{std::string(name)};
  for (std::string part; std::getline(parts, part, '/');) {
    if (part.empty() || part == "." || part == "..") return "a name has no empty part, no '.' and no '..'";
  }
  return name.ends_with('/') ? "a name does not end in '/'" : "";
}

Manifest read_manifest(const std::filesystem::path& directory) {
  namespace fs = std::filesystem;
  const fs::path path = directory / Manifest::file_name;
  std::error_code error;
  const fs::file_status status = fs::symlink_status(path, error);
  if (status.type() == fs::file_type::not_found) return {};
  if (!fs::is_regular_file(status))
    throw InputError(path.string() + ": not a list of results by Rhexis: it is not a regular file");
  std::istringstream file(whole_file(path));
  std::string line;
  if (!std::getline(file, line) || line != first_line) {
    throw InputError(fmt::format("{}: not a list of results by Rhexis: its first line should be '{}'",
                                 path.string(), first_line));
  }
  Manifest manifest;
  for (int number = 2; std::getline(file, line) && !file.eof(); ++number) {
    const std::string fault = take(line, manifest);
    if (!fault.empty()) throw InputError(fmt::format("{}:{}: '{}': {}", path.string(), number, line, fault));
  }
  return manifest;
}

}  // namespace rhexis::output
