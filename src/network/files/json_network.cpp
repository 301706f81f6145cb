// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/error.hpp"
#include "network/files/network_file.hpp"

namespace rhexis::network {
namespace {

using Json = nlohmann::json;

/// Members of junctions and vessels with a quantity: its kind in "units", and the SI unit.
struct Kind {
  const char* name;
  const char* si;
};
constexpr Kind kinds[] = {{"length", "m"}, {"pressure", "Pa"}, {"flow", "m3/s"}, {"resistance", "Pa s/m3"}};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const ToSi& to_si) : file_(file.string()) {
    const std::string text = read_network_text(file);
    try {
      document_ = Json::parse(text);
    } catch (const Json::parse_error& error) {
      const auto upto = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
      throw InputError(fmt::format("{}:{}: not valid JSON, or cut short: {}", file_,
                                   1 + std::count(upto.begin(), upto.end(), '\n'), error.what()));
    } catch (const Json::exception& error) {  // a number beyond all
      refuse(error.what());
    }
    if (!document_.is_object()) refuse("an object with units, junctions and vessels is expected");
    known(document_, "", {"units", "junctions", "vessels"});
    const Json units = document_.value("units", Json::object());
    if (!units.is_object()) refuse("units: an object is expected, such as {\"length\": \"mm\"}");
    known(units, "units.", {"length", "pressure", "flow", "resistance"});
    for (const Kind& kind : kinds) {
      if (!units.contains(kind.name)) continue;
      const std::string place = std::string("units.") + kind.name;
      if (!units[kind.name].is_string()) refuse(place + ": a unit in quotes is expected");
      try {
        factors_[&kind - kinds] = to_si("1 " + units[kind.name].get<std::string>(), kind.si);
      } catch (const InputError& error) {
        refuse(place + " = " + units[kind.name].dump() + ": " + error.what());
      }
    }
  }

  BoundedGraph read() {
    NetworkBuilder builder;
    each("junctions", {"id", "x", "y", "z", "pressure", "flow", "resistance"},
         [&](const Json& j, const std::string& at) {
           builder.add(
               JunctionRow{id(j, "id", at), number(j, "x", "length", at), number(j, "y", "length", at),
                           number(j, "z", "length", at), number(j, "pressure", "pressure", at),
                           number(j, "flow", "flow", at), number(j, "resistance", "resistance", at)},
               file_ + ": " + at);
         });
    each("vessels",
         {"id", "from", "to", "radius", "diameter", "length", "wall_thickness", "kind", "generation"},
         [&](const Json& v, const std::string& at) {
           if (v.contains("radius") && v.contains("diameter"))
             refuse(at + ": give one of radius and diameter");
           std::optional<double> radius = number(v, "radius", "length", at);
           if (const auto diameter = number(v, "diameter", "length", at)) radius = *diameter / 2;
           builder.add(
               VesselRow{id(v, "id", at), id(v, "from", at), id(v, "to", at), radius,
                         number(v, "length", "length", at), number(v, "wall_thickness", "length", at),
                         v.contains("kind") ? id(v, "kind", at) : "", number(v, "generation", "", at)},
               file_ + ": " + at);
         });
    return builder.finish(file_);
  }

 private:
  [[noreturn]] void refuse(const std::string& problem) const { throw InputError(file_ + ": " + problem); }

  void known(const Json& object, const std::string& place, const std::vector<std::string>& names) const {
    for (const auto& member : object.items()) {
      if (std::find(names.begin(), names.end(), member.key()) != names.end()) continue;
      refuse(fmt::format("{}{}: there is no such member (members: {})", place, member.key(),
                         fmt::join(names, ", ")));
    }
  }

  template <class Read>
  void each(const char* list, const std::vector<std::string>& names, const Read& read) const {
    if (!document_.contains(list) || !document_[list].is_array())
      refuse(std::string(list) + ": a list is expected");
    std::size_t index = 0;
    for (const Json& element : document_[list]) {
      const std::string at = fmt::format("{}[{}]", list, index++);
      if (!element.is_object()) refuse(at + ": an object is expected");
      known(element, at + ".", names);
      read(element, at);
    }
  }

  /// A text, or a whole number as text.
  std::string id(const Json& object, const char* name, const std::string& at) const {
    if (!object.contains(name)) refuse(fmt::format("{}.{} is missing", at, name));
    const Json& value = object[name];
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_integer()) return value.dump();
    refuse(fmt::format("{}.{} = {}: a text or a whole number is expected", at, name, value.dump()));
  }

  std::optional<double> number(const Json& object, const char* name, std::string_view kind,
                               const std::string& at) const {
    if (!object.contains(name) || object[name].is_null()) return std::nullopt;
    const Json& value = object[name];
    if (!value.is_number() || !std::isfinite(value.get<double>())) {
      refuse(fmt::format("{}.{} = {}: a finite number is expected", at, name, value.dump()));
    }
    for (const Kind& k : kinds) {
      if (kind != k.name) continue;
      const double factor = factors_[&k - kinds];
      if (std::isnan(factor))
        refuse(fmt::format("{}.{} needs units.{}, for example \"{}\"", at, name, k.name, k.si));
      return value.get<double>() * factor;
    }
    return value.get<double>();
  }

  std::string file_;
  Json document_;
  double factors_[std::size(kinds)] = {NAN, NAN, NAN, NAN};
};

}  // namespace

BoundedGraph read_json_network(const std::filesystem::path& file, const ToSi& to_si) {
  return Reader(file, to_si).read();
}

}  // namespace rhexis::network
