// SPDX-License-Identifier: BSD-3-Clause
// GraphML, as igraph, NetworkX and Gephi write it: nodes and edges whose attributes have the names of the
// columns of CSV tables, with units in brackets ("radius [um]"), or lengths in network.file_length_unit.
#include <fmt/format.h>

#include <map>
#include <unordered_map>

#include "core/error.hpp"
#include "core/scanning.hpp"
#include "network/files/network_file.hpp"
#include "network/files/xml_reader.hpp"

namespace rhexis::network {
namespace {

/// What a <key> declares: an attribute of nodes or edges (or both), which a column may be.
struct Key {
  std::string name, domain, default_value;
};

/// A key as attribute of nodes, or of edges: its column, or null, and what turns its numbers into SI.
struct Attribute {
  const Column* column = nullptr;
  double factor = 1;
};

/// An element and the texts of its attributes, by columns.
class Record {
 public:
  Record(std::string where, std::size_t line) : where_(std::move(where)), line_(line) {}

  void set(const std::string& column, std::string value, double factor = 1) {
    values_[column] = {std::move(value), factor};
  }
  const std::string& where() const { return where_; }
  std::size_t line() const { return line_; }

  std::string text(const std::string& name) const {
    const auto found = values_.find(name);
    return found == values_.end() ? std::string() : found->second.first;
  }
  std::optional<double> number(const std::string& name) const {
    const auto found = values_.find(name);
    if (found == values_.end()) return std::nullopt;
    const auto& [text, factor] = found->second;
    const std::optional<double> value = finite_number(text);
    if (!value)
      throw InputError(fmt::format("{}: {} = {}: not a finite number", where_, name, text.substr(0, 60)));
    return *value * factor;
  }

 private:
  std::string where_;
  std::size_t line_;
  std::map<std::string, std::pair<std::string, double>> values_;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const FileOptions& options)
      : file_(file.string()),
        text_(read_network_text(file)),
        xml_(file_, text_),
        options_(options),
        builder_(options) {}

  BoundedGraph read() {
    using Event = XmlReader::Event;
    for (Event event = xml_.next(); event != Event::finished; event = xml_.next()) {
      if (event != Event::begin) continue;
      if (xml_.name() == "key")
        read_key();
      else if (xml_.name() == "graph")
        begin_graph();
      else if (xml_.name() == "node")
        read_node();
      else if (xml_.name() == "edge")
        read_edge();
      else if (xml_.name() == "hyperedge")
        throw InputError(xml_.where() + ": a hyperedge is no vessel");
    }
    if (graphs_ == 0) throw InputError(file_ + ": no GraphML: there is no <graph>");
    if (!names_a_radius()) throw InputError(file_ + ": no attribute of edges is called radius or diameter");
    for (const Record& edge : edges_) builder_.add_vessel(edge, static_cast<std::uint32_t>(edge.line()));
    builder_.note_ignored(file_, "attributes", ignored_);
    return builder_.finish(file_);
  }

 private:
  void begin_graph() {
    if (++graphs_ > 1) throw InputError(xml_.where() + ": a second graph; one is expected");
    for (const auto& [id, key] : keys_) {
      if (key.domain != "edge") node_attributes_[id] = attribute_of(key, junction_columns());
      if (key.domain != "node") edge_attributes_[id] = attribute_of(key, vessel_columns());
      const bool is_known = (key.domain != "edge" && node_attributes_[id].column != nullptr) ||
                            (key.domain != "node" && edge_attributes_[id].column != nullptr);
      if (!is_known) ignored_.push_back(key.name);
    }
  }

  /// A declaration of an attribute, with its <default> where it has one.
  void read_key() {
    Key key{xml_.attribute("attr.name"), xml_.attribute("for"), {}};
    const std::string id = xml_.attribute("id");
    if (key.name.empty()) key.name = id;
    for (int depth = 1; depth > 0;) {
      const XmlReader::Event event = xml_.next();
      if (event == XmlReader::Event::begin) ++depth;
      if (event == XmlReader::Event::end) --depth;
      if (event == XmlReader::Event::text && depth == 2) key.default_value = xml_.text();
    }
    keys_[id] = key;
  }

  /// The column that a key is; none for those that the elements themselves say.
  Attribute attribute_of(const Key& key, const Columns& columns) {
    const Heading heading = parsed_heading(key.name);
    const Column* column = find_column(columns, heading.name);
    if (column == nullptr || column->name == "id" || column->name == "from" || column->name == "to")
      return {};
    UnitOfColumn unit;
    try {
      unit = unit_of(*column, heading, options_.length_unit, options_.to_si);
    } catch (const InputError& error) {
      throw InputError(fmt::format("{}: attribute {}: {}", file_, key.name, error.what()));
    }
    if (unit.is_the_length_unit) builder_.use_length_unit();
    if (unit.factor) return {column, *unit.factor};
    if (column->unit != "m") return {};
    throw InputError(
        fmt::format("{}: attribute {} needs its unit: network.file_length_unit, or a name such as '{} [um]'",
                    file_, key.name, column->name));
  }

  /// The element that has begun, with the values that its attributes have by default.
  Record begun_element(const std::unordered_map<std::string, Attribute>& attributes) {
    Record record(xml_.where(), xml_.line());
    for (const auto& [id, attribute] : attributes) {
      const std::string& value = keys_[id].default_value;
      if (attribute.column != nullptr && !value.empty())
        record.set(attribute.column->name, value, attribute.factor);
    }
    return record;
  }

  /// Reads the element to its end, and its data into `record`.
  void read_data(Record& record, const std::unordered_map<std::string, Attribute>& attributes) {
    std::string key;
    for (int depth = 1; depth > 0;) {
      const XmlReader::Event event = xml_.next();
      if (event == XmlReader::Event::begin && ++depth == 2 && xml_.name() == "data")
        key = xml_.attribute("key");
      if (event == XmlReader::Event::end && --depth == 1) key.clear();
      if (event == XmlReader::Event::text && !key.empty()) {
        const auto found = attributes.find(key);
        if (found != attributes.end() && found->second.column != nullptr)
          record.set(found->second.column->name, xml_.text(), found->second.factor);
      }
    }
  }

  void read_node() {
    Record record = begun_element(node_attributes_);
    record.set("id", xml_.attribute("id"));
    read_data(record, node_attributes_);
    builder_.add_junction(record);
  }

  /// Without an id of its own an edge has its number, from 0.
  void read_edge() {
    Record record = begun_element(edge_attributes_);
    const std::string id = xml_.attribute("id");
    record.set("id", id.empty() ? std::to_string(edges_.size()) : id);
    record.set("from", xml_.attribute("source"));
    record.set("to", xml_.attribute("target"));
    read_data(record, edge_attributes_);
    edges_.push_back(std::move(record));
  }

  bool names_a_radius() const {
    for (const auto& [id, attribute] : edge_attributes_)
      if (attribute.column != nullptr &&
          (attribute.column->name == "radius" || attribute.column->name == "diameter"))
        return true;
    return false;
  }

  std::string file_, text_;
  XmlReader xml_;
  const FileOptions& options_;
  NetworkBuilder builder_;
  std::map<std::string, Key> keys_;
  std::unordered_map<std::string, Attribute> node_attributes_, edge_attributes_;
  std::vector<Record> edges_;
  std::vector<std::string> ignored_;
  int graphs_ = 0;
};

}  // namespace

BoundedGraph read_graphml_network(const std::filesystem::path& file, const FileOptions& options) {
  return Reader(file, options).read();
}

}  // namespace rhexis::network
