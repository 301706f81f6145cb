#include "app/interrupt.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <string_view>

#include "output/temporary_file.hpp"

namespace rhexis::app {
namespace {

volatile std::sig_atomic_t interrupt_requested = 0;

extern "C" void note_interrupt(int signal) {
  interrupt_requested = 1;
  std::signal(signal, SIG_DFL);
}

/// Made beforehand, because a handler may neither allocate nor format.
struct {
  std::string file, temporary, text;
} last_words;

void write_all(int file, std::string_view text) {
  while (!text.empty()) {
    const ssize_t written = write(file, text.data(), text.size());
    if (written <= 0) return;
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

extern "C" void say_last_words(int) {
  const int file = open(last_words.temporary.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
  if (file >= 0) {
    write_all(file, last_words.text);
    close(file);
    rename(last_words.temporary.c_str(), last_words.file.c_str());
  }
  write_all(STDERR_FILENO, "rhexis: interrupted\n");
  _exit(130);
}

void catch_signals(void (*handler)(int)) {
  std::signal(SIGINT, handler);
  std::signal(SIGTERM, handler);
}

}  // namespace

LastWords::LastWords(const std::filesystem::path& file, std::string text) {
  last_words = {file.string(), output::temporary_name_beside(file).string(), std::move(text)};
  catch_signals(say_last_words);
}

LastWords::~LastWords() {
  catch_signals(SIG_DFL);
}

InterruptGuard::InterruptGuard() {
  interrupt_requested = 0;
  catch_signals(note_interrupt);
}

InterruptGuard::~InterruptGuard() {
  catch_signals(SIG_DFL);
}

bool InterruptGuard::requested() {
  return interrupt_requested != 0;
}

}  // namespace rhexis::app
