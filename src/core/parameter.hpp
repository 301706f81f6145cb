// SPDX-License-Identifier: BSD-3-Clause
/// One declaration per input key, made beside the physics that uses it; the reader, the checks, `rhexis keys`
/// and the record of a run all work from it.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "core/enum_names.hpp"

namespace rhexis {

/// Allowed values, in SI units; an open end excludes the bound itself.
struct Range {
  double lower = -std::numeric_limits<double>::infinity();
  double upper = std::numeric_limits<double>::infinity();
  bool lower_open = false;
  bool upper_open = false;

  bool contains(double v) const {
    return (lower_open ? v > lower : v >= lower) && (upper_open ? v < upper : v <= upper);
  }
  static Range any() { return {}; }
  static Range positive() { return {.lower = 0, .lower_open = true}; }
  static Range not_negative() { return {.lower = 0}; }
  static Range between(double lower, double upper) { return {.lower = lower, .upper = upper}; }
  static Range at_least(double lower) { return {.lower = lower}; }
};

/// A point of a curve read from input, e.g. a pressure at a time, in SI units.
using CurvePoint = std::pair<double, double>;

/// An enum's variable as the home of a value, known by the names in the enum's table only.
class EnumTarget {
 public:
  template <NamedEnum Enum>
  EnumTarget(Enum* target) : target_(target), access_(&access_to<Enum>) {}

  std::vector<std::string> names() const { return access_->names(); }
  std::string name() const { return access_->get(target_); }
  /// `name` must be one of the names.
  void set(const std::string& name) const { access_->set(target_, name); }

 private:
  struct Access {
    std::vector<std::string> (*names)();
    std::string (*get)(const void* target);
    void (*set)(void* target, const std::string& name);
  };
  template <NamedEnum Enum>
  static constexpr Access access_to{
      .names =
          [] {
            std::vector<std::string> names;
            for (const auto& named : name_table(Enum{})) names.emplace_back(named.name);
            return names;
          },
      .get = [](const void* target) { return std::string(name_of(*static_cast<const Enum*>(target))); },
      .set = [](void* target,
                const std::string& name) { *static_cast<Enum*>(target) = value_of<Enum>(name).value(); }};

  void* target_;
  const Access* access_;
};

/// One member of an element of a list.
using ElementTarget = std::variant<double*, std::optional<double>*, std::string*, std::vector<double>*>;

/// One member of every element of a list: the home of a key in a section that may stand any number of times,
/// [[section]].
class ListTarget {
 public:
  template <class Element, class Member>
  ListTarget(std::vector<Element>* list, Member Element::*member)
      : resize_([list](std::size_t count) { list->resize(count); }),
        at_([list, member](std::size_t i) -> ElementTarget { return &((*list)[i].*member); }) {
    const auto element = std::make_shared<Element>();
    prototype_ = &(element.get()->*member);
    prototype_owner_ = element;
  }

  void resize(std::size_t count) const { resize_(count); }
  ElementTarget at(std::size_t i) const { return at_(i); }
  /// The member of an element that nothing has been read into.
  ElementTarget prototype() const { return prototype_; }

 private:
  std::function<void(std::size_t)> resize_;
  std::function<ElementTarget(std::size_t)> at_;
  ElementTarget prototype_;
  std::shared_ptr<void> prototype_owner_;
};

/// Where the value goes. The text "auto" leaves an optional one empty.
using ParameterTarget =
    std::variant<double*, std::optional<double>*, std::int64_t*, std::optional<std::int64_t>*, bool*,
                 std::string*, std::vector<std::string>*, std::vector<double>*, std::vector<CurvePoint>*,
                 EnumTarget, ListTarget>;

/// Another key, and the values of it that are meant, as a user would write them in TOML; none: any
/// that is given.
struct Condition {
  std::string key = {};
  std::vector<std::string> values = {};
};

/// `key` has one of these values of an enum.
template <NamedEnum... Enum>
Condition when(std::string key, Enum... values) {
  return {std::move(key), {'"' + std::string(name_of(values)) + '"' ...}};
}

struct Parameter {
  std::string key;         ///< "section.name", e.g. "vessel.inner_radius"
  ParameterTarget target;  ///< typed home of the value, in SI units; what it holds is the default
  std::string unit =
      {};  ///< "m", "Pa", "s", ...; "1" for a plain number; for a curve "s, Pa"; empty for text
  std::string default_in = {};            ///< unit in which the default is shown, e.g. "mm"; empty: `unit`
  std::string meaning = {};               ///< one sentence
  std::string source = {};                ///< paper and equation or table, where there is one
  Range range = {};                       ///< allowed range of each number
  std::vector<std::string> choices = {};  ///< allowed words of a text; empty: any, of an enum: all its names
  bool required = false;                  ///< has no default
  std::vector<Condition> only_with = {};  ///< the key has no effect unless one of them holds; none: always
};

using ParameterList = std::vector<Parameter>;

}  // namespace rhexis
