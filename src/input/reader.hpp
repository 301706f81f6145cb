// SPDX-License-Identifier: BSD-3-Clause
/// From a document to the typed configuration: every declared key filled, or one error that says what to
/// change.
///
/// The steps of a program, on the root rank:
///   const Document document = parse_document(read_text(file), file, overrides);
///   const Resolved resolved = read(document, parameters);        // fills the targets of the declarations
///   try { physics.validate(); } catch (const InputError& e) { throw located(e, resolved); }
///   record["input"] = to_json(resolved);
#pragma once

#include <nlohmann/json_fwd.hpp>
#include <string>
#include <variant>
#include <vector>

#include "core/error.hpp"
#include "core/parameter.hpp"
#include "input/document.hpp"

namespace rhexis::input {

/// What a key holds after reading, in SI; empty for "auto".
using SiValue = std::variant<std::monostate, bool, std::int64_t, double, std::string,
                             std::vector<std::string>, std::vector<double>, std::vector<CurvePoint>>;

struct ResolvedValue {
  std::string key;
  Value given;  ///< as in the file, on the command line, or in the declaration
  SiValue value;
  std::string unit;    ///< unit of `value`, as declared
  std::string origin;  ///< "file", "--set" or "default"
  std::string place;   ///< opens a message about it: `a.toml:12: vessel.length = "1 mm"`
};

/// The configuration as resolved: all declared keys, in the order of their declaration.
struct Resolved {
  std::string file;
  std::vector<ResolvedValue> values;
  std::vector<std::string> warnings;  ///< a warning for each key that was given and has no effect
};

/// Fills the target of every parameter from the document, or from its default. Repeated ones are resolved
/// table by table, as keys "section[1].name", ...
/// @throws InputError, complete with place, key and value, for the first of these: an unknown section; then,
/// in the
///         order of the file, an unknown key or a value that its key does not take; then a missing key.
Resolved read(const Document& document, const ParameterList& declared);

/// `error`, which the physics threw about values that do not fit together, with place and value in front.
InputError located(const InputError& error, const Resolved& resolved);

/// {"vessel": {"length": {"written": "20 mm", "value": 0.02, "unit": "m", "origin": "file"}}}; null for
/// "auto".
nlohmann::ordered_json to_json(const Resolved& resolved);

}  // namespace rhexis::input
