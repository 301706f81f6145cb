#include "insitu/catalyst/catalyst_script.hpp"

#include <vtkCPDataDescription.h>
#include <vtkCPInputDataDescription.h>
#include <vtkCallbackCommand.h>
#include <vtkCollection.h>
#include <vtkSMProxy.h>
#include <vtkSMProxyManager.h>
#include <vtkSMSessionProxyManager.h>

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

/// ParaView's producers warn when they get data twice for the same time, as they do at a script's start and
/// again at its first run. An object whose warnings somebody observes does not print them.
void silence_producers() {
  vtkNew<vtkCallbackCommand> ignore;
  auto* proxies = vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager();
  for (const char* name : channel_names) {
    vtkNew<vtkCollection> producers;
    proxies->GetProxies("sources", name, producers);
    for (int i = 0; i < producers->GetNumberOfItems(); ++i) {
      auto* proxy = vtkSMProxy::SafeDownCast(producers->GetItemAsObject(i));
      auto* producer = vtkObject::SafeDownCast(proxy->GetClientSideObject());
      if (producer->HasObserver(vtkCommand::WarningEvent) == 0)
        producer->AddObserver(vtkCommand::WarningEvent, ignore);
    }
  }
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
  auto description = describe(grid, step, time_s);
  if (!helper_->Import(description) || !helper_->CatalystInitialize(description)) return false;
  started_ = true;
  silence_producers();
  return wants(step, time_s);
}

void CatalystScript::finish() {
  if (started_) helper_->CatalystFinalize();
}

}  // namespace rhexis::insitu
