/// One Catalyst V2 script: when it wants to run, which fields it needs, running it.
#pragma once

#include <vtkCPPythonScriptV2Helper.h>
#include <vtkNew.h>
#include <vtkPolyData.h>

#include <optional>
#include <string>
#include <vector>

namespace rhexis::insitu {

/// The names under which scripts find the particles: the channel's, and that of the file which the solver
/// saves, so that a script exported from a ParaView session on this file runs unchanged.
inline constexpr const char* channel_names[] = {"particles", "particles.xdmf"};

class CatalystScript {
 public:
  CatalystScript(std::string path, std::optional<std::vector<std::string>> fields);

  const std::string& path() const { return path_; }

  /// The fields declared by the script; nothing means all.
  const std::optional<std::vector<std::string>>& fields() const { return fields_; }

  /// Collective, as the script may decide by code of its own. A script not started yet wants any step.
  bool wants(long step, double time_s);

  /// Starts the script if this is its first time and lets it make its extracts. Failures are left with the
  /// guard.
  void run(vtkPolyData* grid, long step, double time_s);

  void finish();

 private:
  bool start(vtkPolyData* grid, long step, double time_s);

  std::string path_;
  std::optional<std::vector<std::string>> fields_;
  vtkNew<vtkCPPythonScriptV2Helper> helper_;
  bool started_ = false;
};

}  // namespace rhexis::insitu
