// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/catalyst_script.hpp"

#include <vtkCPInputDataDescription.h>

namespace rhexis::insitu {

CatalystScript::CatalystScript(std::string path, PerChannel<Wish> wishes)
    : path_(std::move(path)), wishes_(std::move(wishes)) {
  helper_->PrepareFromScript(path_);
}

void CatalystScript::fill(const Channels& channels) {
  const auto fill_channel = [&](std::size_t channel, auto* source) {
    filled_[channel] = nullptr;
    if (source != nullptr && wishes_[channel].wanted)
      filled_[channel] = grids_[channel].fill(*source, wishes_[channel].fields);
  };
  fill_channel(0, channels.particles);
  fill_channel(1, channels.network);
}

void CatalystScript::clear() {
  for (ChannelGrid& grid : grids_) grid.clear();
}

vtkSmartPointer<vtkCPDataDescription> CatalystScript::describe(long step, double time_s) const {
  auto description = vtkSmartPointer<vtkCPDataDescription>::New();
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    if (!known_[channel]) continue;
    for (const char* name : channel_names[channel]) {
      description->AddInput(name);
      description->GetInputDescriptionByName(name)->SetGrid(filled_[channel]);
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
  for (std::size_t channel = 0; channel < channel_count; ++channel)
    known_[channel] = filled_[channel] != nullptr;
  auto description = describe(step, time_s);
  if (!helper_->Import(description) || !helper_->CatalystInitialize(description)) return false;
  started_ = true;
  return wants(step, time_s);
}

void CatalystScript::finish() {
  if (started_) helper_->CatalystFinalize();
}

}  // namespace rhexis::insitu
