// SPDX-License-Identifier: BSD-3-Clause
/// What the scenes' `resolve` share: what the user gave, warnings, files that the input names.
#pragma once

#include <string>
#include <vector>

#include "core/error.hpp"
#include "parallel/communicator.hpp"
#include "scenes/configuration.hpp"

namespace rhexis::scenes {

/// An InputError that `check` throws is one of `key`.
template <class Check>
void check_key(const char* key, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(error.what(), key);
  }
}

/// The key's value where the user gave one, else null.
const input::ResolvedValue* given(const Configuration& c, const std::string& key);

/// Warns of a key that was given and `where` this is so does nothing; for conditions that the declarations of
/// keys cannot state.
void warn_of_no_effect(Configuration& c, const std::string& key, const std::string& where);

/// Replaces files named in the input by their absolute paths. They are looked for from the working folder
/// first (what is typed at the terminal), then from the input file's folder (what an input file says of its
/// neighbours); by the root rank, for ranks may see other files. Throws InputError with `key`. Collective.
void find_files(std::vector<std::string>& files, const std::string& key, const std::string& what,
                const std::string& input_file, parallel::Communicator comm);

/// Appends `part` to `all`.
void append(ParameterList& all, const ParameterList& part);

}  // namespace rhexis::scenes
