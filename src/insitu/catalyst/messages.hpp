// SPDX-License-Identifier: BSD-3-Clause
/// VTK's and ParaView's errors and warnings, kept from the terminal while a script runs.
#pragma once

#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace rhexis::insitu {

/// While this lives, what VTK would print is given to `note` instead: at once where it is said on the thread
/// that made this, with `flush` where on another.
class Messages {
 public:
  using Note = std::function<void(bool is_error, const std::string& text)>;

  explicit Messages(Note note);
  ~Messages();
  Messages(const Messages&) = delete;
  Messages& operator=(const Messages&) = delete;

  void flush();
  void take(bool is_error, const std::string& text);

 private:
  struct Message {
    bool is_error;
    std::string text;
  };

  const Note note_;
  const std::thread::id own_thread_ = std::this_thread::get_id();
  std::mutex mutex_;
  std::vector<Message> of_other_threads_;
};

}  // namespace rhexis::insitu
