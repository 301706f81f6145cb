// SPDX-License-Identifier: BSD-3-Clause
/// One Catalyst V2 script: when it wants to run, which fields it needs, running it.
#pragma once

#include <vtkCPDataDescription.h>
#include <vtkCPPythonScriptV2Helper.h>
#include <vtkNew.h>
#include <vtkSmartPointer.h>

#include <memory>
#include <string>
#include <vector>

#include "insitu/catalyst/channel.hpp"
#include "insitu/catalyst/channel_grid.hpp"
#include "insitu/pipeline.hpp"

namespace rhexis::insitu {

class CatalystScript {
 public:
  CatalystScript(std::string path, std::vector<Wish> wishes);

  const std::string& path() const { return path_; }

  /// Collective, as the script may decide by code of its own. A script not started yet wants any step.
  bool wants(long step, double time_s);

  /// Copies what the script asks for, for the next `run`; `clear` lets go of it.
  void fill(long step, double time_s, const Channels& channels);
  void clear();

  /// Starts the script if this is its first time and lets it make its extracts. Failures are left with the
  /// guard.
  void run(long step, double time_s);

  void finish();

 private:
  bool start(long step, double time_s);
  vtkSmartPointer<vtkCPDataDescription> describe(long step, double time_s) const;

  std::string path_;
  /// A channel that the script asks for.
  struct Input {
    Wish wish;
    ChannelGrid grid = {};
    vtkPolyData* filled = nullptr;  ///< null: the run has none of it
    bool known = false;             ///< to the script, since its start
  };
  std::vector<std::unique_ptr<Input>> inputs_;
  vtkNew<vtkCPPythonScriptV2Helper> helper_;
  bool started_ = false;
};

}  // namespace rhexis::insitu
