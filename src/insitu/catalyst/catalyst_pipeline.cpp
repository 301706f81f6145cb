// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/catalyst_pipeline.hpp"

#include <vtkCLIOptions.h>
#include <vtkMPI.h>
#include <vtkPVVersion.h>
#include <vtkProcessModule.h>
#include <vtkRemotingCoreConfiguration.h>

#include <cstdlib>
#include <filesystem>

#include "insitu/catalyst/inspection.hpp"
#include "insitu/catalyst/process_state.hpp"
#include "insitu/window/headless_window.hpp"

namespace rhexis::insitu {
namespace {

/// Chooses who draws and says who it is; throws NotAvailable if that cannot be had.
std::string start_renderer(Renderer wanted) {
  if (wanted == Renderer::automatic || wanted == Renderer::osmesa) {
    const std::string name = use_headless_windows(Headless::osmesa);
    if (!name.empty()) return "OSMesa (" + name + ")";
  }
  if (wanted == Renderer::automatic || wanted == Renderer::egl) {
    const std::string name = use_headless_windows(Headless::egl);
    if (!name.empty()) return "EGL (" + name + ")";
  }
  const char* display = std::getenv("DISPLAY");
  const bool has_display = display != nullptr && *display != '\0';
  if ((wanted == Renderer::automatic || wanted == Renderer::x11) && has_display) return "X11";
  switch (wanted) {
    case Renderer::osmesa:
      throw NotAvailable("not available: OSMesa gives no OpenGL 3.2 (Debian: libosmesa6)");
    case Renderer::egl:
      throw NotAvailable("not available: EGL gives no OpenGL 3.2 without a display (Debian: libegl1)");
    case Renderer::x11:
      throw NotAvailable("not available: X11 needs the environment variable DISPLAY");
    case Renderer::automatic:
      break;
  }
  throw NotAvailable("not available: neither OSMesa nor EGL nor an X display (Debian: libosmesa6)");
}

/// Keeps ParaView from looking for an X display, which ends the program on all ranks but the first.
void disable_display_test() {
  vtkNew<vtkCLIOptions> options;
  auto* configuration = vtkRemotingCoreConfiguration::GetInstance();
  configuration->PopulateRenderingOptions(options, vtkProcessModule::PROCESS_BATCH);
  char program[] = "rhexis", option[] = "--disable-xdisplay-test";
  char* arguments[] = {program, option, nullptr};
  char** argv = arguments;
  int argc = 2;
  options->Parse(argc, argv);
}

/// Rendering by the processor takes as many threads as the solver, not all cores on every rank; and lending
/// memory in structure-of-arrays layout is meant, though some filters copy it.
void set_environment_defaults() {
  setenv("LP_NUM_THREADS", std::to_string(parallel::thread_count()).c_str(), /*overwrite=*/0);
  setenv("VTK_SILENCE_GET_VOID_POINTER_WARNINGS", "1", /*overwrite=*/0);
}

/// What `action` throws, as text.
template <class Action>
std::string failure_of(Action action) {
  try {
    action();
    return {};
  } catch (const std::exception& error) {
    return error.what();
  }
}

}  // namespace

CatalystPipeline::CatalystPipeline(const Settings& settings, parallel::Communicator communicator)
    : paraview_communicator_(communicator),
      agreement_communicator_(communicator),
      image_directory_(settings.image_directory),
      after_script_(settings.after_script),
      agreement_(parallel::Communicator(agreement_communicator_.handle()), settings.time_limit_s,
                 settings.before_abort) {
  set_environment_defaults();
  const std::string no_renderer = agreement_.agree(failure_of([&] {
    const std::string renderer = start_renderer(settings.renderer);
    description_ = std::string("ParaView Catalyst ") + PARAVIEW_VERSION_FULL + ", " + renderer;
  }));
  if (!no_renderer.empty()) throw NotAvailable(no_renderer);
  const ProcessState before;  // VTK and Python take over signals that are the solver's
  start_paraview();
  agreement_.agree(failure_of([&] {
    guard_.emplace(agreement_, std::filesystem::absolute(settings.image_directory).string(), settings.live);
    add_scripts(settings);
  }));
  before.restore();
  if (!agreement_.failure().empty()) close();
  throw_if_failed();
}

CatalystPipeline::~CatalystPipeline() {
  close();
}

void CatalystPipeline::start_paraview() {
  disable_display_test();
  processor_ = vtkSmartPointer<vtkCPProcessor>::New();
  vtkMPICommunicatorOpaqueComm opaque(&paraview_communicator_.handle());
  processor_->Initialize(opaque);
}

void CatalystPipeline::add_scripts(const Settings& settings) {
  const std::vector<std::vector<Wish>> wishes = inspect(settings);
  for (std::size_t i = 0; i < wishes.size(); ++i)
    scripts_.push_back(std::make_unique<CatalystScript>(settings.scripts[i], wishes[i]));
}

std::vector<CatalystScript*> CatalystPipeline::scripts_wanting(long step, double time_s) {
  std::vector<CatalystScript*> wanting;
  for (const auto& script : scripts_) {
    if (script->wants(step, time_s)) wanting.push_back(script.get());
    throw_if_failed();
  }
  return wanting;
}

bool CatalystPipeline::wants(long step, double time_s) {
  return !scripts_wanting(step, time_s).empty();
}

void CatalystPipeline::process(long step, double time_s, const Channels& channels) {
  step_ = step;
  for (CatalystScript* script : scripts_wanting(step, time_s)) {
    agreement_.agree(failure_of([&] {
      std::filesystem::create_directories(image_directory_);
      script->fill(step, time_s, channels);
    }));
    if (agreement_.failure().empty()) guard_->call(script->path(), [&] { script->run(step, time_s); });
    script->clear();
    throw_if_failed();
    if (after_script_) after_script_(script->path(), step);
  }
}

void CatalystPipeline::finish() {
  const bool failed_before = !agreement_.failure().empty();
  std::vector<std::string> paths;
  for (const auto& script : scripts_) paths.push_back(script->path());
  close();
  if (failed_before) return;
  throw_if_failed();
  for (const std::string& path : paths)
    if (after_script_) after_script_(path, step_);
}

void CatalystPipeline::close() {
  if (processor_ == nullptr) return;
  for (const auto& script : scripts_) guard_->call(script->path(), [&] { script->finish(); });
  scripts_.clear();
  if (guard_) guard_->forget_scripts();
  processor_->Finalize();
  processor_ = nullptr;
}

void CatalystPipeline::throw_if_failed() const {
  if (!agreement_.failure().empty()) throw RunError(agreement_.failure());
}

}  // namespace rhexis::insitu

extern "C" [[gnu::visibility("default")]] rhexis::insitu::Pipeline* rhexis_create_pipeline(
    const rhexis::insitu::Settings& settings, rhexis::parallel::Communicator communicator) {
  return new rhexis::insitu::CatalystPipeline(settings, communicator);
}

extern "C" [[gnu::visibility("default")]] void rhexis_inspect_scripts(
    const rhexis::insitu::Settings& settings, std::string& obstacle) {
  obstacle = rhexis::insitu::missing_modules();
  if (obstacle.empty()) rhexis::insitu::inspect(settings);
}
