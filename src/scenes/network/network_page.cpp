// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/network/network_page.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "core/format.hpp"
#include "hemodynamics/steady/graph/graph_flow.hpp"
#include "input/units.hpp"
#include "network/connectivity.hpp"
#include "network/files/network_file.hpp"
#include "network/files/network_writer.hpp"
#include "network/survey/network_survey.hpp"
#include "network/survey/survey_text.hpp"
#include "output/atomic_file.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"
#include "runtime/console.hpp"
#include "scenes/network/network_page_picture.hpp"

namespace rhexis::scenes {
namespace {

/// Throws InputError where a file to write is there already, or one that is read, or has no folder.
void check_obstacles(const std::filesystem::path& path, const PageFiles& files,
                     const network::Parameters& parameters) {
  std::error_code ignored;
  for (const std::string& file : parameters.files)
    if (std::filesystem::equivalent(file, path, ignored))
      throw InputError(path.string() + ": the network is read from this file; write another");
  const std::filesystem::path folder = std::filesystem::absolute(path).parent_path();
  if (!std::filesystem::is_directory(folder, ignored))
    throw InputError(path.string() + ": there is no folder " + folder.string());
  if (!files.overwrite &&
      std::filesystem::symlink_status(path, ignored).type() != std::filesystem::file_type::not_found)
    throw InputError(path.string() + ": there is such a file; --overwrite replaces it");
}

/// Throws InputError where a file to write is of another kind, or is in the way.
void check_files(const PageFiles& files, const network::Parameters& parameters) {
  const std::filesystem::path kind = files.clean.extension();
  if (!files.clean.empty() && kind != ".json" && kind != ".vtp")
    throw InputError(files.clean.string() + ": the file to write must end in .json or .vtp");
  if (!files.picture.empty() && files.picture.extension() != ".png")
    throw InputError(files.picture.string() + ": the picture must end in .png");
  for (const std::filesystem::path* path : {&files.clean, &files.picture})
    if (!path->empty()) check_obstacles(*path, files, parameters);
}

void write(const network::BoundedGraph& network, const std::filesystem::path& path) {
  if (path.extension() == ".json") {
    output::write_atomically(path, network::json_of(network));
    return;
  }
  output::TemporaryFile file(path);
  network::write_vtp_network(file.name(), network);
  file.put_in_place();
}

/// Bars, one for each of at most ten ranges of equal ratio.
void print_radii(runtime::Console& console, const std::vector<double>& radius) {
  const auto range = std::ranges::minmax(radius);
  const double least = range.min, largest = range.max;  // names that lambdas may hold
  if (!(largest > least)) return;
  constexpr std::size_t bins = 10;
  constexpr double longest_bar = 40;
  const double decades = std::log(largest / least);
  std::array<std::size_t, bins> counts{};
  for (const double r : radius) {
    const double place = std::log(r / least) / decades * bins;
    ++counts[std::min(bins - 1, static_cast<std::size_t>(std::max(0.0, place)))];
  }
  const auto most = static_cast<double>(std::ranges::max(counts));
  console.line("  radii of the vessels:");
  for (std::size_t b = 0; b < bins; ++b) {
    const auto edge = [&](std::size_t i) {
      return quantity(least * std::exp(decades * static_cast<double>(i) / bins), "m", 3);
    };
    const auto bar = static_cast<std::size_t>(std::ceil(longest_bar * static_cast<double>(counts[b]) / most));
    console.line(fmt::format("  {:>10} to {:>8} {:>12}  {}", edge(b), edge(b + 1),
                             grouped(static_cast<long long>(counts[b])), std::string(bar, '#')));
  }
}

void print_page(const network::BoundedGraph& network, const network::Parameters& parameters) {
  const std::vector<std::uint32_t> part = network::first_of_part(network.graph);
  const network::NetworkSurvey survey = network::survey_of(network, part);
  runtime::Console console(true, false);
  console.line(fmt::format("Network {}", fmt::join(parameters.files, ", ")));
  console.item("vessels", grouped(static_cast<long long>(survey.vessels)));
  console.item("junctions", grouped(static_cast<long long>(survey.junctions)));
  for (const auto& [label, text] : network::survey_lines(survey)) console.item(label, text);
  print_radii(console, network.graph.radius);
  for (const std::string& warning : network::survey_warnings(survey)) console.warning(warning);
  try {
    hemodynamics::check_flow_problem(network.graph, network.conditions, part);
    console.item("flow",
                 "can be solved: rhexis run, with a scene of model \"network\" that names these files");
  } catch (const InputError& error) {
    console.item("flow", std::string("cannot be solved: ") + error.what());
  }
}

}  // namespace

void print_network_page(const network::Parameters& parameters, const PageFiles& files,
                        parallel::Communicator comm) {
  network::BoundedGraph network;
  parallel::on_root<InputError>(comm, [&] {
    network::check_length_unit(parameters, "add, for example, --length-unit mm");
    check_files(files, parameters);
  });
  if (!files.picture.empty()) check_picture_can_be_drawn(comm);
  parallel::on_root<InputError>(comm, [&] {
    network = network::read_network(parameters, input::to_si);
    if (files.clean.extension() == ".vtp") network::check_fits_vtp(network, files.clean);
    if (!files.picture.empty() && network.graph.x.empty())
      throw InputError("--picture: the junctions have no coordinates: there is nothing to draw");
    print_page(network, parameters);
  });
  runtime::Console console(comm.is_root(), false);
  if (!files.clean.empty()) {
    parallel::on_root<RunError>(comm, [&] { write(network, files.clean); });
    console.item("written",
                 fmt::format("{} (in SI: network.file_length_unit = \"m\")", files.clean.string()));
  }
  if (files.picture.empty()) return;
  draw_network_page(network, files.picture, comm);
  console.item("picture", files.picture.string());
}

}  // namespace rhexis::scenes
