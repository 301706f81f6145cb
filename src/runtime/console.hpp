// SPDX-License-Identifier: BSD-3-Clause
/// What a run says at the terminal: header, progress, summary. Only the root rank speaks.
#pragma once

#include <string>

namespace rhexis::runtime {

class Console {
 public:
  Console(bool is_root, bool quiet);
  ~Console();

  /// A line of its own; a progress bar below it is drawn anew.
  void line(const std::string& text);
  /// "  label       text".
  void item(const std::string& label, const std::string& text);
  void warning(const std::string& text);
  /// What the user must know to go on: a line, or an error message where the rest is not to be said.
  void important(const std::string& text);

  /// A bar with rate and time left where stdout is a terminal; else a line at every tenth of the way.
  /// `what` is counted.
  void progress(long step, long steps, const std::string& state, const std::string& what = "step");

 private:
  void clear_bar();

  bool is_root_, speaks_, terminal_;
  bool bar_shown_ = false;
  long first_step_ = -1, last_tenth_ = -1;
  double start_ = 0, last_drawn_ = 0;
};

}  // namespace rhexis::runtime
