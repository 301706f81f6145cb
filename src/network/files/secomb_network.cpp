// SPDX-License-Identifier: BSD-3-Clause
// The network files (network.dat) of T. W. Secomb's programs for flow and oxygen in microvessels.
//
// Lines of words divided by blanks or tabs; words beyond those named here, and asterisks after them, are not
// read:
//   - six lines of head (title, box, points, distances, ...);
//   - N total number of segments, a heading, then N rows: name type from to diameter (um) flow (nl/min)
//     haematocrit; types 4 and 5 carry blood;
//   - N total number of nodes, a heading, then N rows: name x y z (um);
//   - N total number of boundary nodes, a heading, then N rows: node type value haematocrit; the value of
//     type 0 is a pressure (mmHg), that of types 2 and 4 to 9 a flow into the network (nl/min), the sign of
//     type -2 tells the direction of a flow that is not known.
#include <fmt/format.h>

#include <cmath>
#include <string_view>
#include <unordered_map>
#include <unordered_set>

#include "core/error.hpp"
#include "core/format.hpp"
#include "core/scanning.hpp"
#include "network/files/network_file.hpp"
#include "network/names.hpp"

namespace rhexis::network {
namespace {

constexpr double micrometre = 1e-6;                  ///< m
constexpr double nanolitre_per_minute = 1e-12 / 60;  ///< m3/s
constexpr int lines_of_head = 6;

/// A line, cut into words.
struct Line {
  std::size_t number = 0;  ///< in the file, from 1
  std::vector<std::string_view> words;
};

class Reader {
 public:
  Reader(const std::filesystem::path& file, const FileOptions& options)
      : file_(file.string()), text_(read_network_text(file)), rest_(text_), builder_(options) {}

  BoundedGraph read() {
    const bool is_whole = builder_.faults().collect([&] {
      for (int i = 0; i < lines_of_head; ++i) next("the head of six lines");
      read_list("segments", 5, [&](const Line& line) { read_segment(line); });
      read_list("nodes", 4, [&](const Line& line) { read_node(line); });
      read_list("boundary nodes", 3, [&](const Line& line) { read_boundary_node(line); });
    });
    if (is_whole) add_all();
    return builder_.finish(file_);
  }

 private:
  template <class Row>
  struct Placed {
    Row row;
    std::size_t line;
  };

  std::string where(std::size_t line) const { return fmt::format("{}:{}", file_, line); }

  /// The next line with words; `what` should be there.
  Line next(const std::string& what) {
    Line line;
    while (line.words.empty()) {
      if (rest_.empty())
        throw InputError(fmt::format("{}: the file ends before {}; is it cut short?", where(line_), what));
      const auto end = rest_.find('\n');
      cut(rest_.substr(0, end), line.words);
      rest_.remove_prefix(end == std::string_view::npos ? rest_.size() : end + 1);
      line.number = ++line_;
    }
    return line;
  }

  static void cut(std::string_view text, std::vector<std::string_view>& words) {
    constexpr std::string_view between = " \t\r*";
    while (true) {
      const auto begin = text.find_first_not_of(between);
      if (begin == std::string_view::npos) return;
      text.remove_prefix(begin);
      const auto end = std::min(text.find_first_of(between), text.size());
      words.push_back(text.substr(0, end));
      text.remove_prefix(end);
    }
  }

  double number(const Line& line, std::size_t word, const char* name) const {
    const std::optional<double> value = finite_number(line.words[word]);
    if (!value)
      throw InputError(fmt::format("{}: {} = {}: not a finite number", where(line.number), name,
                                   line.words[word].substr(0, 60)));
    return *value;
  }

  /// A line with the number of rows, a heading, and the rows, of `words` words at least.
  template <class Read>
  void read_list(const std::string& name, std::size_t words, const Read& read) {
    const Line head = next("the number of " + name);
    const std::optional<double> count = finite_number(head.words[0]);
    if (!count || *count < 0 || *count != std::floor(*count))
      throw InputError(fmt::format("{}: the number of {} is expected, as in '546 total number of {}'",
                                   where(head.number), name, name));
    next("the heading of the " + name);
    for (double i = 0; i < *count; ++i) {
      const Line line = next(fmt::format("the last of {} {}", *count, name));
      builder_.faults().collect([&] {
        if (line.words.size() < words)
          throw InputError(fmt::format("{}: {} words, at least {} are expected in a row of {}",
                                       where(line.number), line.words.size(), words, name));
        read(line);
      });
    }
  }

  void read_segment(const Line& line) {
    const double type = number(line, 1, "type");
    if (type != 4 && type != 5) {
      if (others_++ == 0) first_other_ = line.words[0];
      return;
    }
    VesselRow row;
    row.id = line.words[0];
    row.from = line.words[2];
    row.to = line.words[3];
    row.radius = 0.5 * micrometre * number(line, 4, "diameter");
    used_.insert(std::string(canonical_id(row.from)));
    used_.insert(std::string(canonical_id(row.to)));
    segments_.push_back({std::move(row), line.number});
  }

  void read_node(const Line& line) {
    JunctionRow row;
    row.id = line.words[0];
    row.x = micrometre * number(line, 1, "x");
    row.y = micrometre * number(line, 2, "y");
    row.z = micrometre * number(line, 3, "z");
    node_.try_emplace(std::string(canonical_id(row.id)), nodes_.size());
    nodes_.push_back({std::move(row), line.number});
  }

  void read_boundary_node(const Line& line) {
    const std::string id(line.words[0]);
    const auto found = node_.find(std::string(canonical_id(id)));
    if (found == node_.end())
      throw InputError(fmt::format("{}: there is no node {}", where(line.number), id));
    JunctionRow& row = nodes_[found->second].row;
    if (row.pressure || row.flow || row.tells_direction)
      throw InputError(fmt::format("{}: node {} is given twice", where(line.number), id));
    const double type = number(line, 1, "type"), value = number(line, 2, "value");
    if (type != 0 && std::abs(type) != 2 && !(type >= 4 && type <= 9))
      throw InputError(fmt::format(
          "{}: type = {} of boundary node {}: must be 0 (a pressure in mmHg), 2 or 4 to 9 (a flow in nl/min)",
          where(line.number), text(type), id));
    if (!used_.contains(found->first)) {
      if (unused_ends_++ == 0) first_unused_end_ = id;
      return;
    }
    if (type == 0)
      row.pressure = value * pascals_per_mmhg;
    else if (type == -2)
      row.tells_direction = true;
    else
      row.flow = value * nanolitre_per_minute;
    if (line.words.size() > 3) row.haematocrit = number(line, 3, "haematocrit");
  }

  void add_all() {
    for (const Placed<JunctionRow>& node : nodes_) {
      const bool is_read = builder_.faults().collect([&] { builder_.add(node.row, where(node.line)); });
      if (!is_read) builder_.mention_junction(node.row.id);
    }
    for (const Placed<VesselRow>& segment : segments_) {
      builder_.faults().collect(
          [&] { builder_.add(segment.row, where(segment.line), static_cast<std::uint32_t>(segment.line)); });
    }
    if (others_ > 0)
      builder_.note(fmt::format(
          "{}: {} segments of other types than 4 and 5 carry no blood and are left out; the first is {}",
          file_, grouped(others_), first_other_));
    if (unused_ends_ > 0)
      builder_.note(
          fmt::format("{}: {} boundary nodes are no segment's end and are left out; the first is {}", file_,
                      grouped(unused_ends_), first_unused_end_));
  }

  std::string file_, text_;
  std::string_view rest_;
  std::size_t line_ = 0;
  NetworkBuilder builder_;
  std::vector<Placed<VesselRow>> segments_;
  std::vector<Placed<JunctionRow>> nodes_;
  std::unordered_map<std::string, std::size_t> node_;  ///< by canonical id
  std::unordered_set<std::string> used_;               ///< canonical ids of nodes at segments
  long long others_ = 0, unused_ends_ = 0;
  std::string first_other_, first_unused_end_;
};

}  // namespace

BoundedGraph read_secomb_network(const std::filesystem::path& file, const FileOptions& options) {
  return Reader(file, options).read();
}

}  // namespace rhexis::network
