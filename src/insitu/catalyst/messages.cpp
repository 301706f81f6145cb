#include "insitu/catalyst/messages.hpp"

#include <vtkLogger.h>

namespace rhexis::insitu {
namespace {

constexpr const char* name = "rhexis";

void on_message(void* messages, const vtkLogger::Message& message) {
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
