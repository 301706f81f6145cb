// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <unordered_map>

#include "core/error.hpp"
#include "network/files/network_file.hpp"

namespace rhexis::network {
namespace {

using Json = nlohmann::json;

/// Kinds of quantities by their names in "units", and the SI unit of each.
struct Kind {
  std::string_view name, si;
};
constexpr Kind kinds[] = {{"length", "m"}, {"pressure", "Pa"}, {"flow", "m3/s"}, {"resistance", "Pa s/m3"}};

/// The units that a file gives to its numbers.
class Units {
 public:
  Units(const std::string& file, const FileOptions& options) : file_(file), options_(options) {}

  void read(const Json& units) {
    if (!units.is_object())
      throw InputError(file_ + ": units: an object is expected, such as {\"length\": \"mm\"}");
    for (const Kind& kind : kinds) {
      const auto unit = units.find(kind.name);
      if (unit == units.end()) continue;
      const std::string place = fmt::format("{}: units.{}", file_, kind.name);
      if (!unit->is_string()) throw InputError(place + ": a unit in quotes is expected");
      try {
        factors_[&kind - kinds] = options_.to_si("1 " + unit->get<std::string>(), kind.si);
      } catch (const InputError& error) {
        throw InputError(fmt::format("{} = {}: {}", place, unit->dump(), error.what()));
      }
    }
    if (std::isnan(factors_[0]) && !options_.length_unit.empty()) {
      factors_[0] = options_.to_si("1 " + options_.length_unit, "m");
      uses_length_unit_ = true;
    }
  }

  /// What turns a number of SI unit `si` ("1": a plain number) into SI; none: the file does not tell its
  /// unit.
  std::optional<double> factor(const std::string& si) const {
    const auto kind = std::ranges::find(kinds, si, &Kind::si);
    if (kind == std::end(kinds)) return 1;
    const double factor = factors_[kind - kinds];
    return std::isnan(factor) ? std::nullopt : std::optional(factor);
  }

  /// That a number needs its unit, to end a message.
  static std::string missing(const std::string& si) {
    const auto kind = std::ranges::find(kinds, si, &Kind::si);
    return fmt::format("needs units.{}, for example \"{}\"{}", kind->name, kind->si,
                       kind == kinds ? ", or network.file_length_unit" : "");
  }

  bool uses_length_unit() const { return uses_length_unit_; }

 private:
  const std::string& file_;
  const FileOptions& options_;
  double factors_[std::size(kinds)] = {NAN, NAN, NAN, NAN};
  bool uses_length_unit_ = false;
};

/// An element of a list of junctions or vessels; its members are known by the names of columns.
class Record {
 public:
  Record(std::string file, std::string list, const Columns& columns, const Units& units)
      : file_(std::move(file)),
        list_(std::move(list)),
        columns_(columns),
        units_(units),
        values_(columns.size()) {}

  /// Goes to the next element. Throws InputError where it is no object, or two members mean the same.
  void take(const Json& element) {
    ++index_;
    std::ranges::fill(values_, nullptr);
    if (!element.is_object()) throw InputError(where() + ": an object is expected");
    for (const auto& member : element.items()) {
      const std::size_t column = column_of(member.key());
      if (column == columns_.size()) continue;
      if (values_[column] != nullptr)
        throw InputError(fmt::format("{}: two members mean the {}", where(), columns_[column].name));
      values_[column] = &member.value();
    }
  }

  std::string where() const { return fmt::format("{}: {}[{}]", file_, list_, index_ - 1); }

  /// A text, or a number as text; empty where there is none.
  std::string text(std::string_view name) const {
    const Json* value = values_[index_of(name)];
    if (value == nullptr || value->is_null()) return {};
    if (value->is_string()) return value->get<std::string>();
    const bool whole_number =
        value->is_number_integer() ||
        (value->is_number() && value->get<double>() == std::floor(value->get<double>()) &&
         std::abs(value->get<double>()) < 1e15);
    if (whole_number)
      return value->is_number_integer() ? value->dump() : fmt::format("{:.0f}", value->get<double>());
    throw InputError(
        fmt::format("{}.{} = {}: a text or a whole number is expected", where(), name, value->dump()));
  }

  std::optional<double> number(std::string_view name) const {
    const std::size_t column = index_of(name);
    const Json* value = values_[column];
    if (value == nullptr || value->is_null()) return std::nullopt;
    if (!value->is_number() || !std::isfinite(value->get<double>()))
      throw InputError(fmt::format("{}.{} = {}: a finite number is expected", where(), name, value->dump()));
    const std::optional<double> factor = units_.factor(columns_[column].unit);
    if (!factor)
      throw InputError(fmt::format("{}.{} {}", where(), name, Units::missing(columns_[column].unit)));
    return value->get<double>() * *factor;
  }

  /// Members that are not known, each once.
  const std::vector<std::string>& ignored() const { return ignored_; }

 private:
  std::size_t index_of(std::string_view name) const {
    return static_cast<std::size_t>(std::ranges::find(columns_, name, &Column::name) - columns_.begin());
  }

  /// The number of the column that a member is; that of columns if it is none.
  std::size_t column_of(const std::string& member) {
    const auto [found, isnew] = known_.try_emplace(member, columns_.size());
    if (!isnew) return found->second;
    if (const Column* column = find_column(columns_, member))
      found->second = static_cast<std::size_t>(column - columns_.data());
    else
      ignored_.push_back(member);
    return found->second;
  }

  std::string file_, list_;
  const Columns& columns_;
  const Units& units_;
  std::vector<const Json*> values_;  ///< [column]
  std::unordered_map<std::string, std::size_t> known_;
  std::vector<std::string> ignored_;
  std::size_t index_ = 0;
};

Json parsed(const std::string& file, const std::string& text) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const auto upto = text.substr(0, error.byte > 0 ? error.byte - 1 : 0);
    throw InputError(fmt::format("{}:{}: not valid JSON, or cut short: {}", file,
                                 1 + std::count(upto.begin(), upto.end(), '\n'), error.what()));
  } catch (const Json::exception& error) {  // a number beyond all
    throw InputError(file + ": " + error.what());
  }
}

class Reader {
 public:
  Reader(const std::filesystem::path& file, const FileOptions& options)
      : file_(file.string()), units_(file_, options), builder_(options) {
    document_ = parsed(file_, read_network_text(file));
    if (!document_.is_object())
      throw InputError(file_ + ": an object with units, junctions and vessels is expected");
    refuse_lumped_models();
    units_.read(document_.value("units", Json::object()));
    if (units_.uses_length_unit()) builder_.use_length_unit();
  }

  BoundedGraph read() {
    const std::string junctions = list_called({"junctions", "vertices", "nodes"}),
                      vessels = list_called({"vessels", "edges"});
    refuse_without_radii(vessels);
    each(junctions, junction_columns(), [&](Record& record) { builder_.add_junction(record); });
    each(vessels, vessel_columns(), [&](Record& record) { builder_.add_vessel(record); });
    std::vector<std::string> others;
    for (const auto& member : document_.items())
      if (member.key() != "units" && member.key() != junctions && member.key() != vessels)
        others.push_back(member.key());
    builder_.note_ignored(file_, "members", others);
    return builder_.finish(file_);
  }

 private:
  /// The inputs of 0-D solvers have resistances where a network of vessels has radii.
  void refuse_lumped_models() const {
    const auto vessels = document_.find("vessels");
    const bool is_lumped = document_.contains("simulation_parameters") ||
                           (vessels != document_.end() && vessels->is_array() && !vessels->empty() &&
                            vessels->front().is_object() && vessels->front().contains("zero_d_element_type"));
    if (is_lumped)
      throw InputError(file_ +
                       ": the input of a 0-D solver, whose vessels are resistances; a network needs of every "
                       "vessel id, from, to and radius, and of every junction its id");
  }

  /// Where no vessel at all has a radius, the file means something else: told once, with what it has.
  void refuse_without_radii(const std::string& vessels) const {
    std::vector<std::string> others;
    for (const Json& vessel : document_[vessels]) {
      if (!vessel.is_object()) return;  // told with its number
      for (const auto& member : vessel.items()) {
        const Column* column = find_column(vessel_columns(), member.key());
        if (column != nullptr && (column->name == "radius" || column->name == "diameter")) return;
        if (column == nullptr && std::ranges::find(others, member.key()) == others.end())
          others.push_back(member.key());
      }
    }
    if (document_[vessels].empty()) return;
    throw InputError(
        fmt::format("{}: no member of {} is called radius or diameter; members that are not "
                    "known: {}",
                    file_, vessels, fmt::join(others, ", ")));
  }

  /// The first of these members that there is, which must be a list.
  std::string list_called(std::initializer_list<const char*> names) const {
    for (const char* name : names)
      if (const auto list = document_.find(name); list != document_.end() && list->is_array()) return name;
    throw InputError(fmt::format("{}: {}: a list is expected", file_, *names.begin()));
  }

  template <class Read>
  void each(const std::string& list, const Columns& columns, const Read& read) {
    Record record(file_, list, columns, units_);
    for (const Json& element : document_[list]) {
      if (builder_.faults().collect([&] { record.take(element); }))
        read(record);
      else
        builder_.lose_junction();
    }
    builder_.note_ignored(file_, "members of " + list, record.ignored());
  }

  std::string file_;
  Json document_;
  Units units_;
  NetworkBuilder builder_;
};

}  // namespace

BoundedGraph read_json_network(const std::filesystem::path& file, const FileOptions& options) {
  return Reader(file, options).read();
}

}  // namespace rhexis::network
