// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/catalyst_script.hpp"

#include <vtkCPInputDataDescription.h>

namespace rhexis::insitu {

CatalystScript::CatalystScript(std::string path, std::vector<Wish> wishes) : path_(std::move(path)) {
  for (Wish& wish : wishes) inputs_.push_back(std::make_unique<Input>(Input{.wish = std::move(wish)}));
  helper_->PrepareFromScript(path_);
}

void CatalystScript::fill(long step, double time_s, const Channels& channels) {
  for (const auto& input : inputs_) {
    input->filled = nullptr;
    for (const Channel& channel : channels) {
      if (channel.name != input->wish.channel) continue;
      input->filled = std::visit(
          [&](auto* source) { return input->grid.fill(*source, input->wish.fields, step, time_s); },
          channel.source);
    }
  }
}

void CatalystScript::clear() {
  for (const auto& input : inputs_) input->grid.clear();
}

vtkSmartPointer<vtkCPDataDescription> CatalystScript::describe(long step, double time_s) const {
  auto description = vtkSmartPointer<vtkCPDataDescription>::New();
  for (const auto& input : inputs_) {
    if (!input->known) continue;
    for (const std::string& name : script_names(input->wish.channel)) {
      description->AddInput(name.c_str());
      description->GetInputDescriptionByName(name.c_str())->SetGrid(input->filled);
    }
  }
  description->SetTimeData(time_s, static_cast<vtkIdType>(step));
  return description;
}

bool CatalystScript::wants(long step, double time_s) {
  if (!started_) return true;
  auto description = describe(step, time_s);
  return helper_->RequestDataDescription(description) && description->GetIfAnyGridNecessary();
}

void CatalystScript::run(long step, double time_s) {
  if (!started_ && !start(step, time_s)) return;
  helper_->CatalystExecute(describe(step, time_s));
}

bool CatalystScript::start(long step, double time_s) {
  for (const auto& input : inputs_) input->known = input->filled != nullptr;
  auto description = describe(step, time_s);
  if (!helper_->Import(description) || !helper_->CatalystInitialize(description)) return false;
  started_ = true;
  return wants(step, time_s);
}

void CatalystScript::finish() {
  if (started_) helper_->CatalystFinalize();
}

}  // namespace rhexis::insitu
