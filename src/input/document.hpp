// SPDX-License-Identifier: BSD-3-Clause
/// An input file and the `--set key=value` of the command line, read into one flat list of keys and values.
/// No TOML type leaves document.cpp.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace rhexis::input {

struct Value;
using List = std::vector<Value>;

/// A value as the user wrote it, before units and checks. A curve is a list of lists.
struct Value {
  std::variant<bool, std::int64_t, double, std::string, List> content;
};

/// `value` as TOML writes it.
std::string written(const Value& value);

struct Entry {
  std::string key;  ///< "section.name", "section[2].name" below the second [[section]], or what the user
                    ///< wrote instead of that
  Value value;
  int line = 0;  ///< from 1; 0 where the entry comes from --set
  int column = 0;
  std::string argument;  ///< the argument of --set, as typed

  bool from_file() const { return line > 0; }
};

struct Section {
  std::string name;
  int line = 0;
  int table = 0;  ///< from 1 where written [[name]], which may be repeated; 0 for [name]
};

struct Document {
  std::string file;               ///< as the user named it
  std::vector<Section> sections;  ///< in the order of the file
  std::vector<Entry> entries;     ///< in the order of the file, then those that only --set gives

  /// Where `entry` stands and what it says, to open a message with: `a.toml:12: vessel.length = "1 mm"`.
  std::string place(const Entry& entry) const;
};

/// The text of an input file. To be called on one rank.
/// @throws InputError where it is missing, unreadable, a folder, or far too large to be an input file.
std::string read_text(const std::filesystem::path& file);

/// Memory that parsing a text of so many characters takes, bytes; measured on a table of a million points.
inline double parsing_bytes(std::size_t characters) {
  return 20.0 * static_cast<double>(characters);
}

/// The document of a file's text; each override is a "key=value", and the last one of a key holds. The value
/// is TOML where it is valid TOML, else plain text, so that quotes are not needed: "time.step=500 ns".
/// @throws InputError with file, line and column where the text is not valid TOML, or is deeper than
/// section.name.
Document parse_document(std::string_view text, std::string file, std::span<const std::string> overrides = {});

/// One value: TOML where `text` is valid TOML, else `text` itself.
/// @throws InputError where it opens a list, a table or a quoted text that is not valid.
Value parse_value(std::string_view text);

}  // namespace rhexis::input
