// SPDX-License-Identifier: BSD-3-Clause
/// Two kinds of failure a user can meet; a broken invariant inside the program is an assert, not one of
/// these.
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>

namespace rhexis {

/// The user's input is wrong: exit status 2, nothing written. `key` names the input key at fault (empty where
/// none is); the door in `input/` adds file, line and value to the message.
struct InputError : std::runtime_error {
  explicit InputError(const std::string& message, std::string at_key = {})
      : std::runtime_error(message), key(std::move(at_key)) {}
  std::string key;
};

/// The run failed (unstable, disk full, a script that raised): exit status 3, what was saved stays readable.
struct RunError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// Does `check`; an InputError that it throws becomes one of `key`.
template <class Check>
void check_key(const char* key, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(error.what(), key);
  }
}

/// What to tell of a failure.
inline std::string reason_of(const std::exception& error) {
  return dynamic_cast<const std::bad_alloc*>(&error) != nullptr ? "out of memory" : error.what();
}

}  // namespace rhexis
