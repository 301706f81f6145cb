/// How a failure on one rank becomes a failure on all.
#pragma once

#include <string>

#include "parallel/communicator.hpp"

namespace rhexis::insitu {

class Agreement {
 public:
  explicit Agreement(parallel::Communicator communicator);

  /// Collective: the first non-empty text in rank order, with the rank's number where there are several; kept
  /// as `failure()` if it is the first. Should this rank have failed and the others not come here within the
  /// limit (they wait for this rank inside ParaView), prints the text and ends the program with status 3.
  std::string agree(const std::string& text);

  const std::string& failure() const { return failure_; }

 private:
  void await_others(const std::string& text) const;

  parallel::Communicator communicator_;
  double limit_s_ = 60;
  std::string failure_;
};

}  // namespace rhexis::insitu
