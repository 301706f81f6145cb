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

namespace rhexis::scenes {
namespace {

/// Throws InputError where the file is of another kind, there already, or one that is read.
void check_clean_file(const CleanFile& clean, const network::Parameters& parameters) {
  if (clean.path.empty()) return;
  const std::string extension = clean.path.extension().string(), name = clean.path.string();
  if (extension != ".json" && extension != ".vtp")
    throw InputError(name + ": the file to write must end in .json or .vtp");
  for (const std::string& file : parameters.files) {
    std::error_code ignored;
    if (std::filesystem::equivalent(file, clean.path, ignored))
      throw InputError(name + ": the network is read from this file; write another");
  }
  std::error_code ignored;
  if (!clean.overwrite &&
      std::filesystem::symlink_status(clean.path, ignored).type() != std::filesystem::file_type::not_found)
    throw InputError(name + ": there is such a file; --overwrite replaces it");
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

void print_network_page(const network::Parameters& parameters, const CleanFile& clean,
                        parallel::Communicator comm) {
  network::BoundedGraph network;
  parallel::on_root<InputError>(comm, [&] {
    network::check_length_unit(parameters, "add, for example, --length-unit mm");
    check_clean_file(clean, parameters);
    network = network::read_network(parameters, input::to_si);
    if (clean.path.extension() == ".vtp") network::check_fits_vtp(network, clean.path);
    print_page(network, parameters);
  });
  if (clean.path.empty()) return;
  parallel::on_root<RunError>(comm, [&] {
    write(network, clean.path);
    runtime::Console(true, false)
        .item("written", fmt::format("{} (in SI: network.file_length_unit = \"m\")", clean.path.string()));
  });
}

}  // namespace rhexis::scenes
