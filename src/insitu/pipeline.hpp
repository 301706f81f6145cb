// SPDX-License-Identifier: BSD-3-Clause
/// Pictures while the program runs: what the solver sees of ParaView Catalyst. Nothing here needs ParaView,
/// which is loaded (as the plugin librhexis_catalyst.so) only when a pipeline is asked for.
///
///     const insitu::Settings settings{.scripts = {"/home/me/vessel.py"}, .image_directory = "images"};
///     auto pipeline = insitu::load_pipeline(settings, parallel::Communicator::world());
///     for (...) {                                       // every rank calls all of these, in the same order
///       if (pipeline->wants(step, time_s)) pipeline->process(step, time_s, {{"particles", &body}});
///     }
///     pipeline->finish();                               // before MPI ends
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/enum_names.hpp"
#include "core/error.hpp"
#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::insitu {

/// Who draws. `automatic` takes the first that works of OSMesa (in memory, by the processor), EGL (no
/// display, by a graphics card where there is one) and X11 (needs DISPLAY).
enum class Renderer { automatic, osmesa, egl, x11 };

constexpr auto name_table(Renderer) {
  using enum Renderer;
  return std::to_array<Named<Renderer>>(
      {{automatic, "auto"}, {osmesa, "osmesa"}, {egl, "egl"}, {x11, "x11"}});
}

/// What a channel of the run is called (`particles`, `network`), and the names of its fields.
struct ChannelFields {
  std::string name;
  std::vector<std::string> fields;
};

struct Settings {
  std::vector<std::string>
      scripts;                  ///< absolute paths of Catalyst V2 Python scripts (.py or package folders)
  std::string image_directory;  ///< every extract of every script lands here; made with the first picture
  Renderer renderer = Renderer::automatic;
  std::vector<ChannelFields> channels;  ///< that the run has
  double time_limit_s = 600;            ///< longest time that one script may take at one step
  std::string live;                     ///< host:port where ParaView listens (Catalyst Live); empty: nobody
  /// Called on every rank once a script's pictures of a step are written. What it throws, `process` throws.
  std::function<void(const std::string& script, long step)> after_script;
  /// Told the reason before the program is ended because a script does not end (on this rank; perhaps on
  /// another thread than the caller's, which then does nothing any more).
  std::function<void(const std::string&)> before_abort;
};

/// The plugin is not there, or the system lacks what it needs; the message says which.
struct NotAvailable : RunError {
  using RunError::RunError;
};

/// Something that a run shows under a name.
struct Channel {
  std::string name;
  std::variant<PointSource*, LineSource*> source;
};
/// What a run shows at one moment, the same names on all ranks.
using Channels = std::vector<Channel>;

/// The source of this name and kind; null where there is none.
template <class Source>
Source* find_source(const Channels& channels, std::string_view name) {
  for (const Channel& channel : channels) {
    if (channel.name != name) continue;
    if (Source* const* source = std::get_if<Source*>(&channel.source)) return *source;
  }
  return nullptr;
}

/// Catalyst scripts at work on what a run shows, which they know as channels, `particles` and `network`
/// (or by the names of the saved files, `particles.xdmf` and `network.xdmf`; a reader of any saved file
/// becomes a source of the run).
///
/// A script says which fields it needs by lines such as
///     fields = ["displacement", "damage"]      # of the particles
///     network_fields = ["pressure", "radius"]  # of the network
/// (literal strings, outside any function), or, where it was exported from ParaView, by what it selects of a
/// reader (`PointArrayStatus`). Without either it gets all fields of a channel that it names (as
/// `registrationName`, to `GetTrivialProducer`, or by the file of results that a reader would read), and if
/// it says nothing of either channel, all of both. A channel that a script does not ask for is not made for
/// it. All calls are collective, and what they throw they throw on every rank.
class Pipeline {
 public:
  Pipeline() = default;
  Pipeline(const Pipeline&) = delete;
  Pipeline& operator=(const Pipeline&) = delete;
  virtual ~Pipeline() = default;

  /// Who draws, e.g. "ParaView Catalyst 5.11.0, OSMesa (llvmpipe (LLVM 15.0.6, 256 bits))".
  virtual std::string description() const = 0;

  /// Whether some script's own triggers ask for this step. Scripts start at the first step processed, so
  /// until then the answer is yes.
  virtual bool wants(long step, double time_s) = 0;

  /// Runs the scripts that want this step, each on copies of what it asks for; `step` and `time_s` are those
  /// that they see. Throws RunError, naming
  /// script, line and reason, if a script fails on any rank, takes longer than the limit, or leaves the
  /// process changed (working folder, handlers of signals ...). Should ranks get stuck because a script
  /// raised on one while the others wait for it inside ParaView, or should a script wait for ever inside a
  /// library, the program is ended (MPI_Abort, status 3) after RHEXIS_SCRIPT_TIMEOUT seconds (environment
  /// variable, default 60).
  virtual void process(long step, double time_s, const Channels& channels) = 0;

  /// Ends scripts and ParaView (as the destructor does, which however cannot tell that a script failed in
  /// doing so); no other call may follow, and MPI must not end before. A process can load one pipeline only.
  virtual void finish() = 0;
};

/// Reads the scripts without running them, as `load_pipeline` does, and without starting ParaView: throws
/// InputError, naming script, line and reason, for what cannot be read or parsed, for a channel or field that
/// the run does not have, for files of two scripts that would have one name. Collective. Returns why there
/// can be no pictures; empty if there can.
std::string inspect_scripts(const Settings& settings, parallel::Communicator communicator);
/// Memory that ParaView takes for that, bytes; measured with 5.11 and 5.13.
inline constexpr double inspection_bytes = 300e6;

/// Loads the plugin, starts ParaView and checks the scripts without running them. The plugin is looked for in
/// the folder RHEXIS_PLUGIN_DIR (environment variable) or else in the installation's (core/installation.hpp).
/// Throws NotAvailable without ParaView, RunError for a bad script.
std::unique_ptr<Pipeline> load_pipeline(const Settings& settings, parallel::Communicator communicator);

/// Whether the plugin's file is in its place; costs nothing.
bool plugin_available();

/// The plugin's entry points, found by name.
using CreatePipeline = Pipeline*(const Settings&, parallel::Communicator);
inline constexpr const char* create_pipeline_symbol = "rhexis_create_pipeline";
using InspectScripts = void(const Settings&, std::string& obstacle);
inline constexpr const char* inspect_scripts_symbol = "rhexis_inspect_scripts";

}  // namespace rhexis::insitu
