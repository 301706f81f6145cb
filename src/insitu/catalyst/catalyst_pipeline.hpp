// SPDX-License-Identifier: BSD-3-Clause
/// The plugin's Pipeline: ParaView's set-up and end, and one round of scripts per step.
#pragma once

#include <vtkCPProcessor.h>
#include <vtkSmartPointer.h>

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "insitu/catalyst/agreement.hpp"
#include "insitu/catalyst/catalyst_script.hpp"
#include "insitu/catalyst/script_guard.hpp"
#include "insitu/pipeline.hpp"

namespace rhexis::insitu {

class CatalystPipeline : public Pipeline {
 public:
  CatalystPipeline(const Settings& settings, parallel::Communicator communicator);
  ~CatalystPipeline() override;

  std::string description() const override { return description_; }
  bool wants(long step, double time_s) override;
  void process(long step, double time_s, const Channels& channels) override;
  void finish() override;

 private:
  void start_paraview();
  void add_scripts(const Settings& settings);
  std::vector<CatalystScript*> scripts_wanting(long step, double time_s);
  void throw_if_failed() const;
  void close();

  // In this order: what stands first goes last.
  parallel::OwnCommunicator paraview_communicator_;  ///< ParaView's messages never meet the solver's
  parallel::OwnCommunicator agreement_communicator_;
  std::filesystem::path image_directory_;
  std::function<void(const std::string& script, long step)> after_script_;
  long step_ = 0;  ///< the last that was processed
  Agreement agreement_;
  std::string description_;
  vtkSmartPointer<vtkCPProcessor> processor_;
  std::optional<ScriptGuard> guard_;
  std::vector<std::unique_ptr<CatalystScript>> scripts_;
};

}  // namespace rhexis::insitu
