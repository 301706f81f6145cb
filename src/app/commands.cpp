// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.hpp"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <sstream>

#include "app/check.hpp"
#include "app/configuration.hpp"
#include "app/scene_keys.hpp"
#include "core/stopwatch.hpp"
#include "input/keys.hpp"
#include "output/unfinished_run.hpp"
#include "parallel/node.hpp"
#include "runtime/console.hpp"
#include "runtime/terminal.hpp"
#include "runtime/version.hpp"
#include "scenes/coupled/coupled_files.hpp"
#include "scenes/coupled/coupled_run.hpp"
#include "scenes/ensemble/ensemble_run.hpp"
#include "scenes/network/network_page.hpp"
#include "scenes/network/network_run.hpp"
#include "scenes/vessel/vessel_files.hpp"
#include "scenes/vessel/vessel_run.hpp"

namespace rhexis::app {
namespace {

/// The exit status of what does nothing but print.
int told(parallel::Communicator comm) {
  const std::string failure = runtime::output_failure();
  if (!failure.empty())
    runtime::print_error(fmt::format("rhexis: stdout could not be written: {}\n", failure));
  return comm.all_reduce(std::int64_t{!failure.empty()}, parallel::Reduce::max) != 0 ? 3 : 0;
}

/// What there is to say of a run into `folder` that has not told its end; empty where there is none.
std::string unfinished_run(const std::filesystem::path& folder) {
  using State = output::UnfinishedRun::State;
  const std::optional<output::UnfinishedRun> run = output::unfinished_run(folder);
  if (!run) return {};
  if (run->state == State::at_work) return fmt::format("a run into {} is at work now", folder.string());
  const std::string then =
      run->holds_samples ? "its finished samples are kept, and the same command goes on"
      : run->last_checkpoint.empty()
          ? "it left no checkpoint"
          : fmt::format("its last checkpoint, to --restart from, is {}", run->last_checkpoint.string());
  return fmt::format(
      "the run into {} {} (killed, out of memory, or out of power); {}", folder.string(),
      run->state == State::dead ? "ended without a word" : "is at work, or ended without a word", then);
}

/// The same of the folder of results and of the one that the checkpoint is in; on the root only.
std::vector<std::string> unfinished_runs(const runtime::RunOptions& options, parallel::Communicator comm) {
  std::vector<std::string> texts;
  if (!comm.is_root()) return texts;
  std::vector<std::filesystem::path> folders = {options.directory};
  // <folder>/checkpoints/<name>
  std::filesystem::path of_checkpoint = (options.restart.parent_path() / "..").lexically_normal();
  if (!of_checkpoint.has_filename()) of_checkpoint = of_checkpoint.parent_path();
  std::error_code not_there;
  if (!options.restart.empty() && !std::filesystem::equivalent(of_checkpoint, options.directory, not_there))
    folders.push_back(of_checkpoint);
  for (const std::filesystem::path& folder : folders) {
    const std::string text = unfinished_run(folder);
    if (!text.empty()) texts.push_back(text);
  }
  return texts;
}

/// How the command has its input read; what takes a while is told at `console`, which must live on.
scenes::Reading reading_for(const Command& command, parallel::Communicator comm, runtime::Console& console) {
  if (const std::string& notice = parallel::threads_notice(); !notice.empty()) console.warning(notice);
  scenes::Reading reading = scenes::reading_for_a_run(comm, console);
  reading.only_checks = command.action == Action::check;
  // ParaView would start a second Python, and can be started only once in a process.
  if (command.embedded) reading.no_pictures = "a run within another program draws none";
  return reading;
}

runtime::RunOptions run_options(const Command& command) {
  return {.directory = command.directory.empty()
                           ? std::filesystem::path("results") / std::filesystem::path(command.file).stem()
                           : std::filesystem::path(command.directory),
          .restart = command.restart,
          .overwrite = command.overwrite,
          .quiet = command.quiet,
          .embedded = command.embedded,
          .command = command.arguments};
}

/// Why there can be no pictures, where the scene names scripts; else empty.
std::string obstacle_to_pictures(const Configuration& configuration) {
  return std::visit(
      [](const auto& scene) {
        if constexpr (requires { scene.pictures; }) return scene.pictures.obstacle;
        return std::string();
      },
      configuration);
}

void check_all(const Command& command, parallel::Communicator comm) {
  runtime::Console console(comm.is_root(), command.quiet);
  scenes::Reading reading = reading_for(command, comm, console);
  Configuration configuration = read_configuration(command.file, command.overrides, reading);
  const runtime::RunOptions options = run_options(command);
  if (const std::string obstacle = obstacle_to_pictures(configuration); !obstacle.empty())
    input_of(configuration).warnings.push_back("insitu.scripts: there can be no pictures: " + obstacle);
  std::visit(
      [&](const auto& scene) {
        output::refuse_obstacles(scenes::folder_plan(scene, options), comm);
        check(scene, reading);
      },
      configuration);
  for (const std::string& text : unfinished_runs(options, comm)) console.item("results", text);
}

/// The network of the files, or of the scene, that `rhexis network` is given. Throws InputError.
network::Parameters named_network(const Command& command, parallel::Communicator comm) {
  const std::vector<std::string>& files = command.network_files;
  network::Parameters named;
  if (files.size() != 1 || std::filesystem::path(files[0]).extension() != ".toml") {
    named.files = files;
    named.file_length_unit = command.length_unit;
    return named;
  }
  if (!command.length_unit.empty())
    throw InputError(files[0] +
                     ": a scene tells the unit by network.file_length_unit; leave out --length-unit");
  runtime::Console console(comm.is_root(), true);
  scenes::Reading reading = reading_for(command, comm, console);
  const Configuration configuration = read_configuration(files[0], {}, reading);
  std::visit(
      [&](const auto& scene) {
        if constexpr (requires { scene.network.problem; }) named = scene.network.problem.network;
      },
      configuration);
  if (named.files.empty()) throw InputError(files[0] + ": the scene has no network from files");
  return named;
}

}  // namespace

Command parse_command_line(int argc, char** argv, parallel::Communicator comm) {
  Command command;
  command.arguments.assign(argv, argv + argc);
  CLI::App cli{"Rhexis: rupture of blood vessels by peridynamics, seen while it runs."};
  cli.set_version_flag(
      "--version", [] { return runtime::build_description(); }, "What this program is and was built with");
  cli.require_subcommand(1);

  CLI::App* run = cli.add_subcommand("run", "Simulate what an input file describes");
  CLI::App* check =
      cli.add_subcommand("check", "Validate an input file; print derived numbers and the expected cost");
  CLI::App* keys = cli.add_subcommand("keys", "Explain every key of input files");
  const auto a_name = [](const std::string& text) {
    const bool control = std::ranges::any_of(text, [](unsigned char c) { return c < 0x20 || c == 0x7F; });
    return std::string(text.empty() ? "the name is empty"
                       : control    ? "the name has a control character"
                                    : "");
  };
  for (CLI::App* sub : {run, check}) {
    sub->add_option("FILE", command.file, "Input file (TOML)")->required()->check(a_name);
    sub->add_option("-o,--output", command.directory, "Folder for results; default results/<name of FILE>")
        ->check(a_name);
    sub->add_option("--set", command.overrides, "Replace or add a key, e.g. --set load.pressure='200 kPa'")
        ->type_name("KEY=VALUE")
        ->allow_extra_args(false);
  }
  run->add_option("--restart", command.restart, "Go on from a checkpoint of an earlier run")->check(a_name);
  run->add_flag("--overwrite", command.overwrite,
                "Replace files in the folder for results that no run made (never one that this run reads)");
  run->add_flag("--quiet", command.quiet, "Print errors only");
  CLI::App* network = cli.add_subcommand(
      "network", "Tell what a network is like: parts, ends, ranges, vessels without flow, slips");
  network
      ->add_option("FILES", command.network_files,
                   "The files of a network (see network.files), or a scene that names them (TOML)")
      ->required()
      ->expected(1, 2)
      ->check(a_name);
  network
      ->add_option("--length-unit", command.length_unit, "Unit of lengths in files that cannot tell, e.g. mm")
      ->check(a_name);
  network
      ->add_option("-o,--output", command.directory,
                   "Write the network as read and repaired, in SI: a .json or .vtp file")
      ->check(a_name);
  network
      ->add_option("--picture", command.picture,
                   "Draw the vessels in the colours of their radii, and the ends: a .png file")
      ->check(a_name);
  network->add_flag("--overwrite", command.overwrite, "Replace these files");
  keys->add_option("SECTION", command.section, "One section, or one key (section.key)");

  try {
    cli.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    const bool asked = error.get_exit_code() == 0;  // --help, --version
    std::ostringstream out, problem;
    cli.exit(error, out, problem);
    if (comm.is_root()) {
      runtime::print_out(out.str());
      runtime::print_error(problem.str());
    }
    command.status = asked ? told(comm) : 2;
    return command;
  }
  command.action = run->parsed()       ? Action::run
                   : check->parsed()   ? Action::check
                   : network->parsed() ? Action::network
                                       : Action::keys;
  return command;
}

nlohmann::ordered_json checked_values(const Command& command, parallel::Communicator comm) {
  runtime::Console console(comm.is_root(), /*quiet=*/true);
  scenes::Reading reading = reading_for(command, comm, console);
  const Configuration configuration = read_configuration(command.file, command.overrides, reading);
  const scenes::SceneInput& input = input_of(configuration);
  nlohmann::ordered_json values = {
      {"model", model_of(configuration)}, {"input", scenes::record_of(input)}, {"warnings", input.warnings}};
  if (const peridynamics::WallModel* wall = wall_of(configuration)) {
    values["particles"] = wall->particles();
    values["steps"] = wall->time.count;
    values["time_step_s"] = wall->time.step;
    values["stable_time_step_s"] = wall->time.stable;
  }
  return values;
}

runtime::Ending run(const Command& command, parallel::Communicator comm, runtime::OutputFunction on_output) {
  const double started = seconds_now();
  runtime::Console console(comm.is_root(), command.quiet);
  scenes::Reading reading = reading_for(command, comm, console);
  Configuration configuration = read_configuration(command.file, command.overrides, reading);
  runtime::RunOptions options = run_options(command);
  options.started = started;
  options.on_output = std::move(on_output);
  scenes::append(input_of(configuration).warnings, unfinished_runs(options, comm));
  return std::visit([&](auto& scene) { return scenes::run(std::move(scene), options, comm); }, configuration);
}

int carry_out(const Command& command, parallel::Communicator comm) {
  if (command.action == Action::keys) {
    const std::string text = input::describe_keys(AllKeys().list(), command.section);
    if (comm.is_root()) runtime::print_out(text);
    return told(comm);
  }
  if (command.action == Action::check) {
    check_all(command, comm);
    return told(comm);
  }
  if (command.action == Action::network) {
    scenes::print_network_page(named_network(command, comm),
                               {command.directory, command.picture, command.overwrite}, comm);
    return told(comm);
  }
  const runtime::Ending ending = run(command, comm);
  return ending.interrupted() ? 128 + ending.signal : 0;
}

}  // namespace rhexis::app
