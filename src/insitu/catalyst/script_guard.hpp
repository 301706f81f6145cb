/// The Python side of the plugin: starts the interpreter and puts guard.py between ParaView and the scripts.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "insitu/catalyst/agreement.hpp"

namespace rhexis::insitu {

class ScriptGuard {
 public:
  /// `agreement` must outlive the interpreter's use of it, that is until `forget_scripts`.
  ScriptGuard(Agreement& agreement, const std::string& image_directory);

  /// The fields that a script declares, nothing where it declares none and so wants all. Throws RunError for
  /// a script that cannot be read or parsed; local to the rank.
  std::optional<std::vector<std::string>> declared_fields(const std::string& script) const;

  /// The first exception on this rank that ParaView swallowed since the last call, while `script` ran; empty
  /// if none.
  std::string take_noted(const std::string& script) const;

  /// Destroys what scripts hold; call before ParaView ends.
  void forget_scripts() const;
};

}  // namespace rhexis::insitu
