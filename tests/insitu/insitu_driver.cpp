// SPDX-License-Identifier: BSD-3-Clause
// Runs Catalyst scripts on a synthetic vessel, network or both, as the solver would; checked by
// test_insitu.py.
//   insitu_driver IMAGE_DIRECTORY RENDERER CHANNELS FRAMES SCRIPT...
// CHANNELS: particles | network | both; a network may say of what kind, e.g. network:spatial:11 (planar,
// spatial, unknown; generations of each tree; 4 without).
// Environment: DRIVER_TIME_LIMIT (s), DRIVER_LIVE (host:port).
// Prints JSON lines: one when loaded, one per frame, one at the end; `error: ...` on failure (status 3).
#include <sys/resource.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>

#include "insitu/pipeline.hpp"
#include "synthetic_network.hpp"
#include "synthetic_vessel.hpp"

namespace {

using rhexis::insitu::Renderer;

double now_s() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

void print_asked(const std::map<std::string, int>& asked) {
  const char* comma = "";
  for (const auto& [name, count] : asked) {
    std::printf(R"(%s"%s": %d)", comma, name.c_str(), count);
    comma = ", ";
  }
}

std::vector<std::string> names_of(std::span<const rhexis::FieldInfo> fields) {
  std::vector<std::string> names;
  for (const rhexis::FieldInfo& field : fields) names.emplace_back(field.name);
  return names;
}

void run(rhexis::insitu::Settings settings, const std::string& channels, int frames,
         rhexis::parallel::Communicator world) {
  const double start = now_s();
  rhexis::test::SyntheticVessel vessel(world.rank(), world.size());
  rhexis::test::SyntheticNetwork network(channels, world.rank(), world.size());
  const bool with_vessel = !channels.starts_with("network"), with_network = channels != "particles";
  if (with_vessel) settings.channels.push_back({"particles", names_of(vessel.fields())});
  if (with_network) settings.channels.push_back({"network", names_of(network.fields())});
  if (const char* limit = std::getenv("DRIVER_TIME_LIMIT")) settings.time_limit_s = std::stod(limit);
  if (const char* live = std::getenv("DRIVER_LIVE")) settings.live = live;
  settings.before_abort = [](const std::string& reason) {
    std::printf("record: %s\n", reason.c_str());
    std::fflush(stdout);  // what comes next need not
  };
  const auto pipeline = rhexis::insitu::load_pipeline(settings, world);
  if (world.is_root()) {
    std::printf(R"({"description": "%s", "seconds": %.3f})"
                "\n",
                pipeline->description().c_str(), now_s() - start);
  }
  for (int frame = 0; frame < frames; ++frame) {
    const double begin = now_s();
    const double progress = frames > 1 ? static_cast<double>(frame) / (frames - 1) : 1;
    vessel.advance(50L * frame, progress);
    network.advance(50L * frame, progress);
    const bool wanted = pipeline->wants(vessel.step(), vessel.time_s());
    if (wanted) {
      rhexis::insitu::Channels shown;
      if (with_vessel) shown.push_back({"particles", &vessel});
      if (with_network) shown.push_back({"network", &network});
      pipeline->process(vessel.step(), vessel.time_s(), shown);
    }
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
  print_asked(vessel.asked);
  std::printf(R"(}, "asked_of_network": {)");
  print_asked(network.asked);
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
    rhexis::insitu::Settings settings;
    settings.scripts = {argv + 5, argv + argc};
    settings.image_directory = argv[1];
    settings.renderer = renderers.at(argv[2]);
    run(settings, argv[3], std::stoi(argv[4]), world);
  } catch (const rhexis::insitu::NotAvailable& error) {
    if (world.is_root()) std::printf("%s\n", error.what());
    return 4;
  } catch (const rhexis::RunError& error) {
    std::printf("error: %s\n", error.what());  // every rank: the test counts them
    return 3;
  }
  return 0;
}
