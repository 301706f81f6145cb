// SPDX-License-Identifier: BSD-3-Clause
#include "app/configuration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "app/pictures.hpp"
#include "app/scene_keys.hpp"
#include "app/wall_memory.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "core/memory.hpp"
#include "core/text_file.hpp"
#include "input/catalogue.hpp"
#include "input/document.hpp"
#include "input/reader.hpp"
#include "input/units.hpp"
#include "input/wording.hpp"
#include "network/network_file.hpp"
#include "network/vtp_network.hpp"
#include "parallel/node.hpp"
#include "parallel/together.hpp"
#include "peridynamics/bonds/surface_correction.hpp"
#include "peridynamics/laws/strength.hpp"
#include "peridynamics/loads/pressure_layer.hpp"
#include "peridynamics/loads/schedule.hpp"
#include "peridynamics/loads/schedule_table.hpp"
#include "peridynamics/loads/thin_spots.hpp"
#include "peridynamics/stability/time_steps.hpp"
#include "runtime/version.hpp"
#include "studies/ensemble/walls.hpp"
#include "studies/screening/screening.hpp"

namespace rhexis::app {
namespace {

/// What `check` finds wrong is said of that key.
template <class Check>
void check_key(const char* key, const Check& check) {
  try {
    check();
  } catch (const InputError& error) {
    throw InputError(error.what(), key);
  }
}

/// The key's value where the user gave one, else null.
const input::ResolvedValue* given(const Configuration& c, const std::string& key) {
  const auto value = std::ranges::find(c.resolved.values, key, &input::ResolvedValue::key);
  return value != c.resolved.values.end() && value->origin != "default" ? &*value : nullptr;
}

/// Warns of a key that was given and `where` this is so does nothing; conditions that the declarations of
/// keys cannot state.
void no_effect(Configuration& c, const std::string& key, const std::string& where) {
  if (const input::ResolvedValue* value = given(c, key))
    c.warnings.push_back(value->place + ": has no effect " + where);
}

std::string read_on_root(const std::string& file, parallel::Communicator comm) {
  std::string text;
  parallel::on_root<InputError>(comm, [&] { text = input::read_text(file); });
  return comm.broadcast(text);
}

/// Memory that reading `text` takes, bytes. Throws InputError where there is not as much.
double reading_bytes(const std::string& text, const std::string& file, parallel::Communicator comm) {
  constexpr double of_a_character = 32;  // measured on a table of a million points
  const double bytes = of_a_character * static_cast<double>(text.size());
  const MemoryLimit limit = available_memory();
  const double here = limit.of_machine ? parallel::ranks_of_node(comm) : 1;
  parallel::together<InputError>(comm, [&] {
    if (here * bytes <= limit.bytes) return;
    throw InputError(fmt::format(
        "{}: to read its {:.3g} MB of text takes {:.3g} GB of memory, and {:.3g} GB are left by {}; a long "
        "table belongs in a CSV file (load.table_file)",
        file, 1e-6 * static_cast<double>(text.size()), 1e-9 * here * bytes, 1e-9 * limit.bytes,
        limit.source));
  });
  return bytes;
}

void settle_time_step(Configuration& c) {
  const peridynamics::Lattice lattice = peridynamics::make_lattice(c.vessel);
  const peridynamics::PressureLayer layer =
      peridynamics::make_pressure_layer(c.vessel, lattice);  // throws where no particle would be loaded
  if (c.vessel.spots.thin_the_wall() && peridynamics::ThinSpots(c.vessel, lattice, layer).absent() == 0)
    c.warnings.push_back(
        "spot.thickness has no effect: a wall is thinned by whole particles, and none lies "
        "outside of what is left; take a smaller discretisation.spacing");
  c.families = peridynamics::shared_families(c.vessel, lattice);
  const peridynamics::TimeSteps time = peridynamics::time_steps(c.vessel, lattice, c.families);
  c.stable_time_step = time.stable;
  c.time_step = time.step;
  c.steps = time.count;
  const double end = static_cast<double>(c.steps) * c.time_step;
  if (std::abs(c.vessel.end_time - end) > 1e-3 * c.time_step) {
    c.warnings.push_back("time.end is not a whole number of steps; the run ends at " + quantity(end, "s", 6));
  }
}

/// Files named in the input are looked for from the working folder first (what is typed at the terminal),
/// then from the input file's folder (what an input file says of its neighbours); by the root rank, for ranks
/// may see other files.
void find_files(std::vector<std::string>& files, const std::string& key, const std::string& what,
                const std::string& input_file, parallel::Communicator comm) {
  namespace fs = std::filesystem;
  for (std::string& file : files) {
    std::string found;
    parallel::on_root<InputError>(comm, [&] {
      const fs::path beside = fs::path(input_file).parent_path() / file;
      for (const fs::path& path : {fs::path(file), beside}) {
        std::error_code no;  // a name may be too long, or a folder closed
        if (found.empty() && fs::exists(path, no)) found = fs::canonical(path).string();
      }
      if (!found.empty()) return;
      const auto shown = [](const fs::path& path) {
        constexpr std::size_t longest = 400;
        const std::string text = fs::absolute(path).lexically_normal().string();
        return text.size() <= longest ? text : input::shortened(text);
      };
      const std::string here = shown(file), there = shown(beside);
      throw InputError("there is no " + what + " " + here + (there == here ? "" : " or " + there), key);
    });
    file = comm.broadcast(found);
  }
}

/// Reads load.table_file, where there is one, into load.table.
void read_table(Configuration& c, parallel::Communicator comm) {
  peridynamics::Parameters& v = c.vessel;
  if (v.table_file.empty()) return;
  if (!v.table.empty())
    throw InputError("give either load.table or load.table_file, not both", "load.table_file");
  std::vector<std::string> files{v.table_file};
  find_files(files, "load.table_file", "table", c.file, comm);
  v.table_file = files.front();
  check_key("load.table_file", [&] {
    std::string text;
    constexpr std::uintmax_t most = 1'000'000'000;
    parallel::on_root<InputError>(comm,
                                  [&] { text = whole_file(v.table_file, most, ", too much for a table"); });
    text = comm.broadcast(text);
    c.table_checksum = peridynamics::checksum(text);
    parallel::together<InputError>(
        comm, [&] { v.table = peridynamics::schedule_table(v.table_file, std::move(text), input::to_si); });
  });
}

void resolve_vessel(Configuration& c, parallel::Communicator comm) {
  const auto warnings = peridynamics::resolve(c.vessel);
  c.warnings.insert(c.warnings.end(), warnings.begin(), warnings.end());
  settle_memory(c, comm);
  parallel::together(
      comm, [&] { within_memory("the wall", "discretisation.spacing", [&] { settle_time_step(c); }); });
  if (c.is_ensemble()) return;
  if (c.output.fields.empty()) no_effect(c, "output.precision", "without output.fields");
  if (c.output.fields.empty() && !c.is_coupled()) no_effect(c, "output.format", "without output.fields");
  c.output_steps = output::planned_steps(c.output, c.steps, c.time_step);
}

/// Who builds with a ParaView most likely looks at the files with it.
void warn_of_an_old_paraview(Configuration& c) {
  const std::string version = runtime::paraview_version();
  int major = 0, minor = 0;
  if (std::sscanf(version.c_str(), "%d.%d", &major, &minor) != 2 ||
      std::pair(major, minor) >= std::pair(5, 12))
    return;
  c.warnings.push_back(
      "output.format = \"" + c.output.format + "\": ParaView " + version +
      ", which Rhexis was built with, cannot read VTKHDF files of particles and networks; 5.12 "
      "and later can");
}

/// Where results are told by pressure, it should be one that walls have seen.
void warn_of_an_unfinished_ramp(Configuration& c) {
  const double share = peridynamics::schedule_share(c.vessel, c.vessel.end_time);
  if (share < 1 - 1e-9)
    c.warnings.push_back("the ramp is not over at time.end: walls see " + text(100 * share, 3) +
                         " % of each pressure at most; shorten load.ramp_time, or end later");
}

void resolve_ensemble(Configuration& c, parallel::Communicator comm) {
  ensemble::resolve(c.ensemble);
  resolve_vessel(c, comm);  // the mean one
  const auto warnings = ensemble::check_walls(c.ensemble, c.vessel);
  c.warnings.insert(c.warnings.end(), warnings.begin(), warnings.end());
  warn_of_an_unfinished_ramp(c);
}

void resolve_network(Configuration& c, parallel::Communicator comm) {
  network::Parameters& n = c.network;
  hemodynamics::resolve(c.hemodynamics);
  if (n.vtp && n.tier == "distributed")
    throw InputError("not with network.tier = \"distributed\"", "network.vtp");
  if (n.vtp && !network::knows_vtp())
    throw InputError("VTP files need ParaView's VTK when Rhexis is built", "network.vtp");
  const bool explicit_tier = n.tier == "explicit" || (n.tier == "auto" && n.source == "file");
  if (c.hemodynamics.phase_separation && !explicit_tier) {
    throw InputError("phase separation needs network.tier = \"explicit\"", "blood.phase_separation");
  }
  if (n.tier == "distributed") {
    if (c.screening.top > 0)
      throw InputError("vessels are screened with network.tier = \"implicit\" or \"explicit\"",
                       "screening.top");
    if (!n.weakness.vessels.empty() || !n.weakness.subtrees.empty())
      throw InputError("weak walls need network.tier = \"implicit\" or \"explicit\"", "weakness.vessels");
  }
  if (n.source == "file") {
    if (!n.weakness.subtrees.empty())
      throw InputError("only a tree has subtrees; name the vessels", "weakness.subtrees");
    check_key("network.files", [&] { network::format_of(n.files); });
    if (n.tier == "implicit") throw InputError("only a tree can be implicit", "network.tier");
    check_key("network.file_length_unit", [&] { input::to_si("1 " + n.file_length_unit, "m"); });
    for (const input::ResolvedValue& value : c.resolved.values) {
      const bool of_trees = input::section_of(value.key) == "tree" || value.key == "flow.inlet_pressure" ||
                            value.key == "flow.outlet_pressure" || value.key == "flow.inlet_flow";
      if (of_trees && value.origin != "default")
        throw InputError("says something of a tree; of a network from files, the files say it", value.key);
    }
    no_effect(c, "network.statistics", "on a network from files, whose vessels have no generations");
    if (network::format_of(n.files) != network::NetworkFormat::vtp)
      no_effect(c, "network.file_length_unit", "on CSV and JSON files, which tell their units");
    find_files(n.files, "network.files", "network file", c.file, comm);
    return;
  }
  if (n.tier == "explicit" || n.tier == "distributed") {
    for (const char* key : {"network.statistics", "network.shown_subtree"})
      no_effect(c, key, "with network.tier = \"" + n.tier + "\", only with \"implicit\"");
  }
  if (!n.files.empty())
    throw InputError("files are read only where network.source = \"file\"", "network.files");
  c.tree = network::rules_from(n.tree, network::artery_wall(n.wall), network::vein_wall(n.wall));
  const hemodynamics::TreeBoundary boundary = hemodynamics::tree_boundary(c.hemodynamics);
  if (boundary.inlet_pressure && boundary.outlet_pressure &&
      *boundary.inlet_pressure < *boundary.outlet_pressure)
    c.warnings.push_back(
        "flow.inlet_pressure is below flow.outlet_pressure: blood runs backwards, from veins to arteries");
  if (!n.tree.length_by_radius.empty()) {
    for (const char* key : {"tree.length_ratio", "tree.length_ratio_by_generation"})
      no_effect(c, key, "where tree.length_by_radius is given");
  }
  const network::TreePair tree(c.tree);
  const auto check_path = [&](const std::string& path, const char* key) {
    check_key(key, [&] { tree.id_of(path); });
  };
  for (const std::string& vessel : n.query) check_path(vessel, "network.query");
  network::WallVariation(n.weakness).mark_in_tree(n.weakness, c.tree.generations);
  if (c.is_coupled() && !c.coupling.screens()) check_path(c.coupling.vessel, "coupling.vessel");
  check_path(n.shown_subtree, "network.shown_subtree");
  if (n.tier == "explicit" && c.tree.generations > 27) {
    throw InputError(
        "an explicit network of more than 27 generations needs more memory than a machine has; take "
        "\"implicit\"",
        "network.tier");
  }
}

/// What can be told before the network is solved.
void resolve_coupling(Configuration& c) {
  coupling::Parameters& p = c.coupling;
  if (c.network.tier == "distributed")
    throw InputError("a coupled vessel needs an implicit or explicit network", "network.tier");
  if (c.vessel.schedule == "table")
    throw InputError("the network says the pressure; a schedule by table is for scenes of one vessel",
                     "load.schedule");
  if (c.vessel.spacing) no_effect(c, "coupling.resolution", "where discretisation.spacing is given");
  if (p.window && *p.window > c.vessel.end_time)
    throw InputError("longer than the run, time.end = " + quantity(c.vessel.end_time, "s"),
                     "coupling.window");
  if (p.mode == "two_way") {
    if (c.vessel.venting != "none" && given(c, "load.venting"))
      throw InputError("not with coupling.mode = \"two_way\", where the network says how the pressure falls",
                       "load.venting");
    c.vessel.venting = "none";
    no_effect(c, "load.supply_area", "with coupling.mode = \"two_way\": the network supplies the blood");
  }
  if (p.compression_from && p.compression_to && *p.compression_from >= *p.compression_to)
    throw InputError("must be above body.compression_from", "body.compression_to");
  c.vessel.blood_density = c.hemodynamics.density;
  c.network.wall.young_modulus = c.vessel.young_modulus;
  c.network.wall.poisson_ratio = c.vessel.law.poisson_ratio;
  if (c.vessel.energy_release_rate && !c.vessel.horizon)
    throw InputError(
        "before the network is solved no spacing is known, and so no critical stretch; give "
        "discretisation.horizon, or material.critical_stretch",
        "material.energy_release_rate");
  peridynamics::settle_critical_stretch(c.vessel);
  c.screening.critical_stretch = *c.vessel.critical_stretch;
  if (p.events > 0 && c.network.source == "tree" && c.network.tier != "explicit")
    throw InputError("a cascade needs network.tier = \"explicit\"", "cascade.events");
  if (p.events > 0 && c.hemodynamics.phase_separation)
    throw InputError("not with blood.phase_separation", "cascade.events");
  if (p.events > 0) {
    c.screening.top = std::max<std::int64_t>(1, c.screening.top);
    warn_of_an_unfinished_ramp(c);
  }
  const hemodynamics::Parameters& h = c.hemodynamics;
  if ((p.mode == "two_way" || p.events > 0) && c.network.source == "tree" && !h.outlet_pressure)
    throw InputError("needed where a tree bleeds: what then leaves it is less than flow.inlet_flow",
                     "flow.outlet_pressure");
  if (p.screens()) c.screening.top = std::max<std::int64_t>(1, c.screening.top);
}

/// A slip in a unit is a factor of ten at least.
void warn_of_a_load_beyond_all(Configuration& c) {
  constexpr double beyond_all = 5;
  const std::optional<double> risk = risk_of_load(c.vessel);
  if (!risk || *risk < beyond_all) return;
  c.warnings.push_back(fmt::format(
      "under {} the lumen would stretch to {:.3g} times material.critical_stretch: the wall is blown "
      "to pieces at a small part of this load; check the units",
      quantity(peridynamics::highest_pressure(c.vessel), "Pa"), *risk));
}

}  // namespace

void resolve_wall(Configuration& c, parallel::Communicator comm) {
  try {
    resolve_vessel(c, comm);
  } catch (const InputError& error) {
    if (!c.is_coupled() || !network_knows(error.key)) throw input::located(error, c.resolved);
    const peridynamics::Parameters& v = c.vessel;
    throw input::located(
        InputError(std::string(error.what()) + " (lumen radius " + quantity(v.inner_radius, "m") + ", wall " +
                       quantity(v.outer_radius - v.inner_radius, "m") + ", length " +
                       quantity(v.length, "m") + ")",
                   "coupling.vessel"),
        c.resolved);
  }
}

std::optional<double> risk_of_load(const peridynamics::Parameters& v) {
  if (v.law.name == "fung") return {};
  return screening::risk({*v.critical_stretch, v.young_modulus, v.law.poisson_ratio, 0},
                         peridynamics::highest_pressure(v), v.outer_radius / v.inner_radius - 1, {1, 1});
}

Configuration read_configuration(const std::string& file, const std::vector<std::string>& overrides,
                                 parallel::Communicator comm, Configuration c) {
  c.file = file;
  const std::string text = read_on_root(file, comm);
  c.input_bytes = reading_bytes(text, file, comm);
  parallel::together(comm, [&] {  // a rank may lack the database of units
    const input::Document document = input::parse_document(text, file, overrides);
    c.resolved = input::read(document, declare_model(c, document));
    c.warnings = c.resolved.warnings;
  });
  try {
    if (c.model == "vessel") {
      read_table(c, comm);
      resolve_vessel(c, comm);
      warn_of_a_load_beyond_all(c);
    } else if (c.is_ensemble()) {
      resolve_ensemble(c, comm);
    } else {
      resolve_network(c, comm);
      if (c.is_coupled()) resolve_coupling(c);
    }
    const bool stores = c.model == "vessel" ? !c.output.fields.empty() : !c.is_ensemble();
    if (stores && c.output.format != "xdmf") warn_of_an_old_paraview(c);
    find_scripts(c, comm);
  } catch (const InputError& error) {
    throw input::located(error, c.resolved);
  }
  c.record = input::to_json(c.resolved);
  if (!c.table_checksum.empty()) c.record["load"]["table_file"]["checksum"] = c.table_checksum;
  return c;
}

}  // namespace rhexis::app
