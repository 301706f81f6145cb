/// The Python side of the plugin: starts the interpreter and puts guard.py between ParaView and the scripts.
#pragma once

#include <string>

#include "insitu/catalyst/agreement.hpp"
#include "insitu/catalyst/channel.hpp"

namespace rhexis::insitu {

class ScriptGuard {
 public:
  /// `agreement` must outlive the interpreter's use of it, that is until `forget_scripts`.
  ScriptGuard(Agreement& agreement, const std::string& image_directory);

  /// What a script declares that it wants of each channel. Throws RunError for a script that cannot be read
  /// or parsed; local to the rank.
  PerChannel<Wish> wishes(const std::string& script) const;

  /// The first exception on this rank that ParaView swallowed since the last call, while `script` ran; empty
  /// if none.
  std::string take_noted(const std::string& script) const;

  /// Destroys what scripts hold; call before ParaView ends.
  void forget_scripts() const;
};

}  // namespace rhexis::insitu
