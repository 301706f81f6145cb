// SPDX-License-Identifier: BSD-3-Clause
/// What scenes of every kind have, and what their `resolve` share.
///
/// A kind of scene is a struct derived from SceneInput in a room of its own, with
///   static constexpr const char* model;                          // its value of scene.model
///   ParameterList declare(TheScene& s);                          // its keys, bound to s
///   void resolve(TheScene& s, const Reading& reading);           // what follows from their values
///   output::FolderPlan folder_plan(const TheScene& s, const runtime::RunOptions& options);
///   runtime::Ending run(TheScene s, const runtime::RunOptions& options, parallel::Communicator comm);
#pragma once

#include <functional>
#include <nlohmann/json_fwd.hpp>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/field_view.hpp"
#include "core/parameter.hpp"
#include "input/reader.hpp"
#include "output/parameters.hpp"
#include "output/results_folder.hpp"
#include "parallel/communicator.hpp"
#include "runtime/console.hpp"
#include "runtime/run_description.hpp"
#include "runtime/run_options.hpp"

namespace rhexis::scenes {

struct SceneInput {
  std::string file, title;
  input::Resolved resolved;  ///< all keys as read
  std::vector<std::string> warnings;
  /// Keys that name files, with the checksums of what was read from those.
  std::vector<std::pair<std::string, std::string>> checksums;
};

/// How an input is read: by whom, what for, and whom to tell.
struct Reading {
  parallel::Communicator comm;
  bool only_checks = false;  ///< `rhexis check`, and no run
  /// Tells the user, at the terminal, of what takes a while or is to be known before it is done; may be
  /// empty. A label and a text as runtime::Console::item has them, or no label.
  std::function<void(const std::string& label, const std::string& text)> tell = {};
  double input_bytes = 0;        ///< memory that reading the input file takes
  std::string no_pictures = {};  ///< why there can be none, whatever the input says; empty: there can
};

/// Tells `console`, which must live on.
Reading reading_for_a_run(parallel::Communicator comm, runtime::Console& console);

/// All keys as read, and the checksums, for run.json and checkpoints.
nlohmann::ordered_json record_of(const SceneInput& s);

/// What a run says of the scene in its header, its record and its pictures.
runtime::RunDescription describe(const SceneInput& s, runtime::PicturesPlan pictures,
                                 const output::Parameters& output);

/// The scripts that the input names become absolute paths, and the plan says why there can be no pictures
/// (runtime/pictures.hpp). Collective; throws InputError of the key insitu.scripts.
void find_scripts(const SceneInput& s, runtime::PicturesPlan& pictures, const Reading& reading);

/// What every run does to its folder: where it is, and the files that it reads.
output::FolderPlan plan_of_folder(const SceneInput& s, const runtime::RunOptions& options,
                                  const std::vector<std::string>& reads);

/// Does `work`; its InputErrors become complete with place.
template <class Work>
auto with_place(const SceneInput& s, const Work& work) {
  try {
    return work();
  } catch (const InputError& error) {
    throw input::located(error, s.resolved);
  }
}

/// The key's value where the user gave one, else null.
const input::ResolvedValue* given(const SceneInput& s, const std::string& key);

/// Warns of a key that was given and `where` this is so does nothing; for conditions that the declarations of
/// keys cannot state.
void warn_of_no_effect(SceneInput& s, const std::string& key, const std::string& where);

/// Who builds with a ParaView most likely looks at the files with it: warns of formats that it cannot read.
void warn_of_an_old_paraview(SceneInput& s, output::StoredAs format);

/// Replaces files named in the input by their absolute paths. They are looked for from the working folder
/// first (what is typed at the terminal), then from the input file's folder (what an input file says of its
/// neighbours); by the root rank, for ranks may see other files. Throws InputError with `key`. Collective.
void find_files(std::vector<std::string>& files, const std::string& key, const std::string& what,
                const std::string& input_file, parallel::Communicator comm);

/// Appends `part` to `all`.
template <class Element>
void append(std::vector<Element>& all, const std::vector<Element>& part) {
  all.insert(all.end(), part.begin(), part.end());
}

/// The names of fields, for what may be drawn of them.
std::vector<std::string> names_of(std::span<const FieldInfo> fields);

}  // namespace rhexis::scenes
