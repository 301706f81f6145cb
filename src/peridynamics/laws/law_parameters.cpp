// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/laws/law_parameters.hpp"

#include <algorithm>
#include <iterator>
#include <string_view>
#include <utility>

#include "core/error.hpp"
#include "core/format.hpp"
#include "peridynamics/laws/all_laws.hpp"
#include "peridynamics/laws/correspondence/gradient_laws.hpp"

namespace rhexis::peridynamics {
namespace {

std::string key_of(const LawNumber& number) {
  return "material." + std::string(number.name);
}

std::string in_quotes(std::string_view name) {
  return '"' + std::string(name) + '"';
}

/// material.law: its meaning, sources and choices are those of the laws.
Parameter law_key(LawChoice& choice) {
  Parameter key{.key = "material.law", .target = &choice.name, .meaning = "How bonds pull: "};
  std::vector<std::string> meanings;
  const auto add = [&]<class Law>() {
    key.choices.emplace_back(Law::name);
    meanings.push_back(std::string(Law::name) + " (" + std::string(Law::meaning) + ")");
    key.source += (key.source.empty() ? "" : "; ") + std::string(Law::source);
  };
  for_each_law(add);
  for_each_gradient_law(add);
  for (std::size_t i = 0; i < meanings.size(); ++i) {
    const bool last = i + 1 == meanings.size();
    key.meaning += (i == 0 ? "" : last ? " or " : ", ") + meanings[i];
  }
  key.meaning += ".";
  return key;
}

}  // namespace

bool LawChoice::by_gradient() const {
  bool found = false;
  for_each_gradient_law([&]<class Law>() { found = found || name == Law::name; });
  return found;
}

ParameterList declare(LawChoice& choice) {
  ParameterList keys{
      law_key(choice),
      {.key = "material.poisson_ratio",
       .target = &choice.poisson_ratio,
       .unit = "1",
       .meaning = "Poisson's ratio; other than 1/4 only with a law that is not one of bonds alone: "
                  "\"neo_hookean\", \"fibre_reinforced\" (where it is that of the matrix) or \"lps\".",
       .source = "Silling 2007",
       .range = {.lower = -1, .upper = 0.4999, .lower_open = true}}};
  for_each_law([&]<class Law>() {
    for (const LawNumber& number : Law::numbers) {
      keys.push_back({.key = key_of(number),
                      .target = &choice.numbers[std::string(number.name)],
                      .unit = "1",
                      .meaning = std::string(number.meaning) +
                                 "; to be given with law = " + in_quotes(Law::name) + ", and only there.",
                      .range = number.range});
    }
  });
  std::ranges::move(declare(choice.wall), std::back_inserter(keys));
  return keys;
}

namespace {

/// Layers and fibres belong to one law, which needs them.
void check_layers(const LawChoice& choice) {
  const bool chosen = choice.name == FibreReinforced::name;
  if (chosen && choice.wall.layers.empty())
    throw InputError("\"fibre_reinforced\" needs a section [[layer]] for each layer of the wall",
                     "material.law");
  if (chosen) wall_layers(choice.wall);
  if (chosen || (choice.wall.layers.empty() && choice.wall.fibres.empty())) return;
  throw InputError(
      "only for material.law = " + in_quotes(FibreReinforced::name) + ", not " + in_quotes(choice.name),
      choice.wall.layers.empty() ? "fibre[1].k1" : "layer[1].shear_modulus");
}

}  // namespace

void resolve(const LawChoice& choice) {
  check_layers(choice);
  for_each_law([&]<class Law>() {
    const bool chosen = choice.name == Law::name;
    if (chosen && !Law::state_based && choice.poisson_ratio != Pmb::poisson_ratio) {
      throw InputError(
          "material.law = " + in_quotes(choice.name) +
              " is bond-based: its Poisson's ratio is 1/4; for another take \"neo_hookean\" or \"lps\"",
          "material.poisson_ratio");
    }
    for (const LawNumber& number : Law::numbers) {
      const auto found = choice.numbers.find(std::string(number.name));
      const bool given = found != choice.numbers.end() && found->second;
      if (given && !chosen)
        throw InputError(
            "only for material.law = " + in_quotes(Law::name) + ", not " + in_quotes(choice.name),
            key_of(number));
      if (chosen && !given)
        throw InputError("material.law = " + in_quotes(Law::name) + " needs " + std::string(number.example),
                         key_of(number));
    }
  });
}

void check_hardening(const LawChoice& choice, double critical_stretch) {
  if (choice.name == FibreReinforced::name) {
    const double at_break =
        FibreReinforced(wall_layers(choice.wall), choice.poisson_ratio).stiffening(critical_stretch);
    if (at_break > 1e4)
      throw InputError(
          "at the critical stretch the fibres would be " + text(at_break) +
              " times as stiff as the wall at rest; 1e4 is allowed: take a smaller critical stretch",
          "material.critical_stretch");
  }
  if (choice.by_gradient()) return;
  with_law(choice, [&]<class Law>(const Law& law) {
    if constexpr (requires { law.hardening(critical_stretch); }) {
      const double at_break = law.hardening(critical_stretch);
      if (at_break > 10) {
        throw InputError("a bond would pull exp(" + text(at_break) +
                             ") times as hard as a linear one before it breaks; a critical_stretch^2 may be "
                             "10 at most",
                         key_of(Law::numbers.front()));
      }
    }
  });
}

}  // namespace rhexis::peridynamics
