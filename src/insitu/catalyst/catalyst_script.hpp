/// One Catalyst V2 script: when it wants to run, which fields it needs, running it.
#pragma once

#include <vtkCPDataDescription.h>
#include <vtkCPPythonScriptV2Helper.h>
#include <vtkNew.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <string>

#include "insitu/catalyst/channel.hpp"

namespace rhexis::insitu {

/// What a script may be lent at a step; null: the run has none of it.
using Grids = PerChannel<vtkPolyData*>;

class CatalystScript {
 public:
  CatalystScript(std::string path, PerChannel<Wish> wishes);

  const std::string& path() const { return path_; }

  const PerChannel<Wish>& wishes() const { return wishes_; }

  /// Collective, as the script may decide by code of its own. A script not started yet wants any step.
  bool wants(long step, double time_s);

  /// Starts the script if this is its first time and lets it make its extracts. Failures are left with the
  /// guard.
  void run(const Grids& grids, long step, double time_s);

  void finish();

 private:
  bool start(const Grids& grids, long step, double time_s);
  vtkSmartPointer<vtkCPDataDescription> describe(const Grids& grids, long step, double time_s) const;

  std::string path_;
  PerChannel<Wish> wishes_;
  PerChannel<bool> lent_{};  ///< what the script knows since its start
  vtkNew<vtkCPPythonScriptV2Helper> helper_;
  bool started_ = false;
};

}  // namespace rhexis::insitu
