#include "insitu/catalyst/catalyst_script.hpp"

#include <vtkCPDataDescription.h>
#include <vtkCPInputDataDescription.h>

#include <cmath>
#include <limits>

namespace rhexis::insitu {
namespace {

vtkSmartPointer<vtkCPDataDescription> describe(vtkPolyData* grid, long step, double time_s) {
  auto description = vtkSmartPointer<vtkCPDataDescription>::New();
  for (const char* name : channel_names) {
    description->AddInput(name);
    description->GetInputDescriptionByName(name)->SetGrid(grid);
  }
  description->SetTimeData(time_s, static_cast<vtkIdType>(step));
  return description;
}

}  // namespace

CatalystScript::CatalystScript(std::string path, std::optional<std::vector<std::string>> fields)
    : path_(std::move(path)), fields_(std::move(fields)) {
  helper_->PrepareFromScript(path_);
}

bool CatalystScript::wants(long step, double time_s) {
  if (!started_) return true;
  auto description = describe(nullptr, step, time_s);
  return helper_->RequestDataDescription(description) && description->GetIfAnyGridNecessary();
}

void CatalystScript::run(vtkPolyData* grid, long step, double time_s) {
  if (!started_ && !start(grid, step, time_s)) return;
  helper_->CatalystExecute(describe(grid, step, time_s));
}

bool CatalystScript::start(vtkPolyData* grid, long step, double time_s) {
  // ParaView warns when it gets data twice for the same time, as start and first run would do.
  const double just_before = std::nextafter(time_s, -std::numeric_limits<double>::infinity());
  auto description = describe(grid, step, just_before);
  if (!helper_->Import(description) || !helper_->CatalystInitialize(description)) return false;
  started_ = true;
  return wants(step, time_s);
}

void CatalystScript::finish() {
  if (started_) helper_->CatalystFinalize();
}

}  // namespace rhexis::insitu
