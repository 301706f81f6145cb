#include "insitu/catalyst/catalyst_script.hpp"

#include <vtkCPInputDataDescription.h>
#include <vtkCallbackCommand.h>
#include <vtkCollection.h>
#include <vtkSMProxy.h>
#include <vtkSMProxyManager.h>
#include <vtkSMSessionProxyManager.h>

namespace rhexis::insitu {
namespace {

/// ParaView's producers warn when they get data twice for the same time, as they do at a script's start and
/// again at its first run. An object whose warnings somebody observes does not print them.
void silence_producers_of(const char* name) {
  vtkNew<vtkCallbackCommand> ignore;
  vtkNew<vtkCollection> producers;
  vtkSMProxyManager::GetProxyManager()->GetActiveSessionProxyManager()->GetProxies("sources", name,
                                                                                   producers);
  for (int i = 0; i < producers->GetNumberOfItems(); ++i) {
    auto* proxy = vtkSMProxy::SafeDownCast(producers->GetItemAsObject(i));
    auto* producer = vtkObject::SafeDownCast(proxy->GetClientSideObject());
    if (producer->HasObserver(vtkCommand::WarningEvent) == 0)
      producer->AddObserver(vtkCommand::WarningEvent, ignore);
  }
}

}  // namespace

CatalystScript::CatalystScript(std::string path, PerChannel<Wish> wishes)
    : path_(std::move(path)), wishes_(std::move(wishes)) {
  helper_->PrepareFromScript(path_);
}

vtkSmartPointer<vtkCPDataDescription> CatalystScript::describe(const Grids& grids, long step,
                                                               double time_s) const {
  auto description = vtkSmartPointer<vtkCPDataDescription>::New();
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    if (!lent_[channel]) continue;
    for (const char* name : channel_names[channel]) {
      description->AddInput(name);
      description->GetInputDescriptionByName(name)->SetGrid(grids[channel]);
    }
  }
  description->SetTimeData(time_s, static_cast<vtkIdType>(step));
  return description;
}

bool CatalystScript::wants(long step, double time_s) {
  if (!started_) return true;
  auto description = describe({}, step, time_s);
  return helper_->RequestDataDescription(description) && description->GetIfAnyGridNecessary();
}

void CatalystScript::run(const Grids& grids, long step, double time_s) {
  if (!started_ && !start(grids, step, time_s)) return;
  helper_->CatalystExecute(describe(grids, step, time_s));
}

bool CatalystScript::start(const Grids& grids, long step, double time_s) {
  for (std::size_t channel = 0; channel < channel_count; ++channel)
    lent_[channel] = wishes_[channel].wanted && grids[channel] != nullptr;
  auto description = describe(grids, step, time_s);
  if (!helper_->Import(description) || !helper_->CatalystInitialize(description)) return false;
  started_ = true;
  for (const auto& names : channel_names) {
    for (const char* name : names) silence_producers_of(name);
  }
  return wants(step, time_s);
}

void CatalystScript::finish() {
  if (started_) helper_->CatalystFinalize();
}

}  // namespace rhexis::insitu
