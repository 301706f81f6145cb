// SPDX-License-Identifier: BSD-3-Clause
/// What is wrong with a file, collected, so that a user sees all of it at once and not one fault a run.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "core/error.hpp"

namespace rhexis {

/// Several things are wrong with an input: each on a line of the message.
struct InputErrors : InputError {
  InputErrors(const std::string& message, std::vector<std::string> faults)
      : InputError(message), each(std::move(faults)) {}
  std::vector<std::string> each;
};

class Faults {
 public:
  /// Faults that are told in full; of those beyond only the number is told.
  static constexpr std::size_t most_told = 20;

  /// `fault`: one line with file, line, value and what is allowed.
  void add(std::string fault) {
    if (told_.size() < most_told) told_.push_back(std::move(fault));
    ++count_;
  }

  /// Does `action`, and collects the InputError that it throws; whether there was none.
  template <class Action>
  bool collect(const Action& action) {
    try {
      action();
      return true;
    } catch (const InputErrors& errors) {
      for (const std::string& fault : errors.each) add(fault);
      return false;
    } catch (const InputError& error) {
      add(error.what());
      return false;
    }
  }

  std::size_t count() const { return count_; }

  /// Throws an InputError with all that was collected, if there is any: a single fault as it is, several on a
  /// line each.
  void raise() const {
    if (count_ == 0) return;
    if (count_ == 1) throw InputError(told_.front());
    std::string all = std::to_string(count_) + " faults:";
    for (const std::string& fault : told_) all += "\n  " + fault;
    if (count_ > told_.size()) all += "\n  and " + std::to_string(count_ - told_.size()) + " more";
    throw InputErrors(all, told_);
  }

 private:
  std::vector<std::string> told_;
  std::size_t count_ = 0;
};

}  // namespace rhexis
