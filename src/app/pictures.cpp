#include "app/pictures.hpp"

namespace rhexis::app {
namespace {

insitu::Renderer renderer(const std::string& name) {
  if (name == "osmesa") return insitu::Renderer::osmesa;
  if (name == "egl") return insitu::Renderer::egl;
  if (name == "x11") return insitu::Renderer::x11;
  return insitu::Renderer::automatic;
}

}  // namespace

Pictures start_pictures(const insitu::Parameters& parameters, const std::filesystem::path& results,
                        parallel::Communicator comm) {
  if (!parameters.enabled) return {.pipeline = nullptr, .description = "off (insitu.enabled = false)"};
  if (parameters.scripts.empty()) return {.pipeline = nullptr, .description = "off (no insitu.scripts)"};
  try {
    auto pipeline = insitu::load_pipeline(
        {parameters.scripts, (results / "images").string(), renderer(parameters.renderer)}, comm);
    std::string description = pipeline->description();
    return {.pipeline = std::move(pipeline), .description = std::move(description)};
  } catch (const insitu::NotAvailable& reason) {
    return {.pipeline = nullptr, .description = std::string("off: ") + reason.what()};
  } catch (const RunError& bad_script) {
    throw InputError(bad_script.what());
  }
}

}  // namespace rhexis::app
