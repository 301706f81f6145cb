// SPDX-License-Identifier: BSD-3-Clause
/// Small input files of three kinds of scene, and reading them. Collective.
#pragma once

#include <fstream>
#include <string>
#include <vector>

#include "app/configuration.hpp"
#include "unit/output/temporary_directory.hpp"

namespace rhexis::test {

inline const std::string vessel = R"(
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "2 mm"
[discretisation]
spacing = "100 um"
[load]
pressure = "100 kPa"
[time]
end = "50 us"
)";

inline const std::string tree = R"(
[scene]
model = "network"
[tree]
generations = 8
root_radius = "2 mm"
[flow]
inlet_pressure = "100 mmHg"
outlet_pressure = "5 mmHg"
)";

inline const std::string ensemble = R"(
[scene]
model = "ensemble"
[ensemble]
pressures = ["24 kPa"]
samples = 2
strength_spread = 0.1
[vessel]
inner_radius = "1.5 mm"
outer_radius = "2 mm"
length = "2 mm"
[discretisation]
spacing = "125 um"
[load]
schedule = "smooth_ramp"
ramp_time = "0.3 ms"
[time]
end = "0.4 ms"
)";

/// `file` is relative to the sources.
inline app::Configuration read_file(const std::string& file, const std::vector<std::string>& overrides = {}) {
  scenes::Reading reading{.comm = parallel::Communicator::world()};
  return app::read_configuration(RHEXIS_SOURCE_DIR "/" + file, overrides, reading);
}

inline app::Configuration read_scene(const std::string& text,
                                     const std::vector<std::string>& overrides = {}) {
  const TemporaryDirectory folder;
  const std::string file = (folder / "scene.toml").string();
  scenes::Reading reading{.comm = parallel::Communicator::world()};
  if (reading.comm.is_root()) std::ofstream(file) << text;
  return app::read_configuration(file, overrides, reading);
}

}  // namespace rhexis::test
