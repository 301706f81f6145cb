// SPDX-License-Identifier: BSD-3-Clause
/// The Python side of the plugin: guard.py, which stands between ParaView and the scripts.
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "insitu/catalyst/agreement.hpp"
#include "insitu/catalyst/messages.hpp"
#include "insitu/catalyst/process_state.hpp"

namespace rhexis::insitu {

class ScriptGuard {
 public:
  /// `agreement` must outlive the interpreter's use of it, that is until `forget_scripts`. `live` is the
  /// host:port of a listening ParaView, or empty.
  ScriptGuard(Agreement& agreement, const std::string& image_directory, const std::string& live);

  /// Has the script `path` do `work`, within the time limit, and sees to it that the process is as before.
  /// Collective; what went wrong on any rank is afterwards agreement.failure().
  void call(const std::string& path, const std::function<void()>& work);

  /// Destroys what scripts hold; call before ParaView ends.
  void forget_scripts() const;

 private:
  Agreement& agreement_;
};

}  // namespace rhexis::insitu
