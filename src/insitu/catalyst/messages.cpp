// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/messages.hpp"

#include <vtkLogger.h>

#include <filesystem>

namespace rhexis::insitu {
namespace {

constexpr const char* name = "rhexis";

/// Whether a message is about the connection to a ParaView that watches: it may leave at any time.
bool is_of_connection(const vtkLogger::Message& message) {
  const std::string file = std::filesystem::path(message.filename).filename().string();
  for (const char* part :
       {"vtkSocket", "vtkClientSocket", "vtkServerSocket", "vtkLiveInsituLink", "vtkTCPNetwork"})
    if (file.starts_with(part)) return true;
  return false;
}

void on_message(void* messages, const vtkLogger::Message& message) {
  if (is_of_connection(message)) return;
  static_cast<Messages*>(messages)->take(message.verbosity <= vtkLogger::VERBOSITY_ERROR, message.message);
}

}  // namespace

Messages::Messages(Note note) : note_(std::move(note)) {
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  vtkLogger::AddCallback(name, &on_message, this, vtkLogger::VERBOSITY_WARNING);
}

Messages::~Messages() {
  vtkLogger::RemoveCallback(name);
  vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_WARNING);
}

void Messages::take(bool is_error, const std::string& text) {
  if (std::this_thread::get_id() == own_thread_) {
    note_(is_error, text);
  } else {
    const std::lock_guard lock(mutex_);
    of_other_threads_.push_back({is_error, text});
  }
}

void Messages::flush() {
  std::vector<Message> messages;
  {
    const std::lock_guard lock(mutex_);
    messages.swap(of_other_threads_);
  }
  for (const Message& message : messages) note_(message.is_error, message.text);
}

}  // namespace rhexis::insitu
