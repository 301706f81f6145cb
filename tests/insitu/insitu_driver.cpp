// Runs Catalyst scripts on a synthetic vessel, as the solver would; checked by test_insitu.py.
//   insitu_driver IMAGE_DIRECTORY RENDERER FRAMES SCRIPT...
// Prints JSON lines: one when loaded, one per frame, one at the end; `error: ...` on failure (status 3).
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <map>

#include "insitu/pipeline.hpp"
#include "synthetic_vessel.hpp"

namespace {

using rhexis::insitu::Renderer;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void run(const rhexis::insitu::Settings& settings, int frames, rhexis::parallel::Communicator world) {
  const double start = now_s();
  const auto pipeline = rhexis::insitu::load_pipeline(settings, world);
  if (world.is_root()) {
    std::printf(R"({"description": "%s", "seconds": %.3f})"
                "\n",
                pipeline->description().c_str(), now_s() - start);
  }
  rhexis::test::SyntheticVessel vessel(world.rank(), world.size());
  for (int frame = 0; frame < frames; ++frame) {
    const double begin = now_s();
    vessel.advance(50L * frame, frames > 1 ? static_cast<double>(frame) / (frames - 1) : 1);
    const bool wanted = pipeline->wants(vessel.step(), vessel.time_s());
    if (wanted) pipeline->process(vessel);
    if (world.is_root()) {
      std::printf(R"({"step": %ld, "wanted": %d, "seconds": %.3f})"
                  "\n",
                  vessel.step(), wanted ? 1 : 0, now_s() - begin);
    }
  }
  pipeline->finish();
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  if (!world.is_root()) return;
  std::printf(R"({"peak_MB": %ld, "asked": {)", usage.ru_maxrss / 1024);
  const char* comma = "";
  for (const auto& [name, count] : vessel.asked) {
    std::printf(R"(%s"%s": %d)", comma, name.c_str(), count);
    comma = ", ";
  }
  std::printf("}}\n");
}

}  // namespace

int main(int argc, char** argv) {
  const rhexis::parallel::Session session(argc, argv);
  const auto world = rhexis::parallel::Communicator::world();
  const std::map<std::string, Renderer> renderers = {{"automatic", Renderer::automatic},
                                                     {"osmesa", Renderer::osmesa},
                                                     {"egl", Renderer::egl},
                                                     {"x11", Renderer::x11}};
  try {
    run({.scripts = {argv + 4, argv + argc}, .image_directory = argv[1], .renderer = renderers.at(argv[2])},
        std::stoi(argv[3]), world);
  } catch (const rhexis::insitu::NotAvailable& error) {
    if (world.is_root()) std::printf("%s\n", error.what());
    return 4;
  } catch (const rhexis::RunError& error) {
    std::printf("error: %s\n", error.what());  // every rank: the test counts them
    return 3;
  }
  return 0;
}
