// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdlib>

#include "core/format.hpp"
#include "core/printable.hpp"
#include "core/stopwatch.hpp"
#include "runtime/terminal.hpp"

namespace rhexis::runtime {
namespace {

/// In bytes: what a warning quotes may be as long as a file.
constexpr std::size_t longest_warning = 4000;

}  // namespace

Console::Console(bool is_root, bool quiet)
    : is_root_(is_root),
      speaks_(is_root && !quiet),
      // mpirun gives the first rank a terminal of its own even where the output goes to a file.
      terminal_(isatty(STDOUT_FILENO) != 0 && std::getenv("OMPI_COMM_WORLD_SIZE") == nullptr) {}

Console::~Console() {
  clear_bar();
}

void Console::line(const std::string& text) {
  if (!speaks_) return;
  clear_bar();
  print_out(printable(text) + '\n');
}

void Console::item(const std::string& label, const std::string& text) {
  line(fmt::format("  {:<12}{}", label, text));
}

void Console::warning(const std::string& text) {
  if (!speaks_) return;
  clear_bar();
  print_error(fmt::format("rhexis: warning: {}\n", printable(text, longest_warning)));
}

void Console::important(const std::string& text) {
  line(text);
  if (is_root_ && !speaks_) print_error(printable(text) + '\n');
}

void Console::progress(long step, long steps, const std::string& state, const std::string& what) {
  if (!speaks_) return;
  const double now = seconds_now();
  if (first_step_ < 0) {
    first_step_ = step;
    start_ = last_drawn_ = now;
    last_tenth_ = step * 10 / steps;
    return;
  }
  const double elapsed = now - start_;
  const double rate = static_cast<double>(step - first_step_) / elapsed;
  const double left = static_cast<double>(steps - step) / rate;
  const auto text = [&] {
    return fmt::format("{} {}/{}  {}  {} {}s/s, {} left", what, step, steps, state,
                       fmt::format("{:.{}f}", rate, rate < 10 ? 1 : 0), what, duration(left));
  };
  if (terminal_) {
    if (now - last_drawn_ < 0.2 && step < steps) return;
    last_drawn_ = now;
    constexpr long width = 24;
    const long full = width * step / steps;
    print_out(fmt::format("\r\033[K  [{}{}] {:3d} %  {}", std::string(full, '#'),
                          std::string(width - full, '.'), 100 * step / steps, text()));
    bar_shown_ = true;
  } else if (step * 10 / steps > last_tenth_) {
    last_tenth_ = step * 10 / steps;
    line(fmt::format("  {:3d} %  {}", 100 * step / steps, text()));
  }
}

void Console::clear_bar() {
  if (!bar_shown_) return;
  print_out("\r\033[K");
  bar_shown_ = false;
}

}  // namespace rhexis::runtime
