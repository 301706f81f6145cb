// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/scene.hpp"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "input/catalogue.hpp"
#include "input/wording.hpp"
#include "parallel/together.hpp"
#include "runtime/version.hpp"

namespace rhexis::scenes {

Reading reading_for_a_run(parallel::Communicator comm, runtime::Console& console) {
  return {.comm = comm, .tell = [&console](const std::string& label, const std::string& text) {
            label.empty() ? console.line(text) : console.item(label, text);
          }};
}

nlohmann::ordered_json record_of(const SceneInput& s) {
  nlohmann::ordered_json record = input::to_json(s.resolved);
  for (const auto& [key, checksum] : s.checksums)
    record[input::section_of(key)][input::name_of(key)]["checksum"] = checksum;
  return record;
}

runtime::RunDescription describe(const SceneInput& s, runtime::PicturesPlan pictures,
                                 const output::Parameters& output) {
  return {.file = s.file,
          .title = s.title,
          .input = std::make_shared<const nlohmann::ordered_json>(record_of(s)),
          .pictures = std::move(pictures),
          .movie = output.movie,
          .frames_per_second = output.frames_per_second};
}

void find_scripts(const SceneInput& s, runtime::PicturesPlan& pictures, const Reading& reading) {
  pictures.obstacle = reading.no_pictures;
  runtime::find_scripts(pictures, s.file, reading.comm);
}

output::FolderPlan plan_of_folder(const SceneInput& s, const runtime::RunOptions& options,
                                  const std::vector<std::string>& reads) {
  output::FolderPlan plan{.directory = options.directory, .overwrite = options.overwrite};
  plan.reads = {s.file};
  plan.reads.insert(plan.reads.end(), reads.begin(), reads.end());
  if (!options.restart.empty()) {
    plan.reads.push_back(options.restart);
    plan.earlier = output::EarlierResults::keep;
  }
  return plan;
}

const input::ResolvedValue* given(const SceneInput& s, const std::string& key) {
  const auto value = std::ranges::find(s.resolved.values, key, &input::ResolvedValue::key);
  return value != s.resolved.values.end() && value->origin != "default" ? &*value : nullptr;
}

void warn_of_no_effect(SceneInput& s, const std::string& key, const std::string& where) {
  if (const input::ResolvedValue* value = given(s, key))
    s.warnings.push_back(value->place + ": has no effect " + where);
}

void warn_of_an_old_paraview(SceneInput& s, output::StoredAs format) {
  if (format == output::StoredAs::xdmf) return;
  const std::string version = runtime::paraview_version();
  int major = 0, minor = 0;
  if (std::sscanf(version.c_str(), "%d.%d", &major, &minor) != 2 ||
      std::pair(major, minor) >= std::pair(5, 12))
    return;
  s.warnings.push_back("output.format = \"" + std::string(name_of(format)) + "\": ParaView " + version +
                       ", which Rhexis was built with, cannot read VTKHDF files of particles and networks; "
                       "5.12 and later can");
}

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

std::vector<std::string> names_of(std::span<const FieldInfo> fields) {
  std::vector<std::string> names;
  for (const FieldInfo& field : fields) names.emplace_back(field.name);
  return names;
}

}  // namespace rhexis::scenes
