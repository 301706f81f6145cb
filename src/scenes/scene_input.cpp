// SPDX-License-Identifier: BSD-3-Clause
#include "scenes/scene_input.hpp"

#include <algorithm>
#include <filesystem>

#include "input/wording.hpp"
#include "parallel/together.hpp"

namespace rhexis::scenes {

const input::ResolvedValue* given(const Configuration& c, const std::string& key) {
  const auto value = std::ranges::find(c.resolved.values, key, &input::ResolvedValue::key);
  return value != c.resolved.values.end() && value->origin != "default" ? &*value : nullptr;
}

void warn_of_no_effect(Configuration& c, const std::string& key, const std::string& where) {
  if (const input::ResolvedValue* value = given(c, key))
    c.warnings.push_back(value->place + ": has no effect " + where);
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

void append(ParameterList& all, const ParameterList& part) {
  all.insert(all.end(), part.begin(), part.end());
}

}  // namespace rhexis::scenes
