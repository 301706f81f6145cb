// SPDX-License-Identifier: BSD-3-Clause
// What checkpoints hold of a cascade: for each number of its events and its failures a list (SI units; not a
// number where there is none), and the names of vessels.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "studies/cascade/cascade_state.hpp"

namespace rhexis::studies {
namespace {

using hemodynamics::VesselFailure;

constexpr double largest = output::CheckpointReader::largest;
constexpr double missing = std::numeric_limits<double>::quiet_NaN();
constexpr double largest_vessel = std::numeric_limits<std::uint32_t>::max();
constexpr const char* failures_name = "cascade_failures";
constexpr const char* names_name = "cascade_vessel_names";
constexpr const char* next_names_name = "cascade_next_vessel_names";
constexpr char end_of_name = '\0';

/// One number of every row, and the range that makes sense of it.
template <class Row>
struct Column {
  std::string name;
  std::function<double(const Row&)> get;
  std::function<void(Row&, double)> set;
  bool may_be_missing = false;
  double least = -largest, most = largest;
};

/// The column of a member that is a number, a flag or an enum; `member` gives a reference to it.
template <class Row, class Member>
Column<Row> column(const char* name, const Member& member, double least = -largest, double most = largest) {
  using Value = std::remove_cvref_t<decltype(member(std::declval<Row&>()))>;
  return {.name = name,
          .get = [member](const Row& row) { return static_cast<double>(member(row)); },
          .set = [member](Row& row, double x) { member(row) = static_cast<Value>(x); },
          .least = least,
          .most = most};
}

/// The same of a member that may be empty.
template <class Row, class Member>
Column<Row> optional_column(const char* name, const Member& member, double least = -largest,
                            double most = largest) {
  using Value = typename std::remove_cvref_t<decltype(member(std::declval<Row&>()))>::value_type;
  return {
      .name = name,
      .get = [member](const Row& row) { return member(row) ? static_cast<double>(*member(row)) : missing; },
      .set =
          [member](Row& row, double x) {
            if (!std::isnan(x)) member(row) = static_cast<Value>(x);
          },
      .may_be_missing = true,
      .least = least,
      .most = most};
}

/// A point's three, m.
template <class Member>
void add_point(std::vector<Column<CascadeEvent>>& columns, const std::string& name, const Member& member) {
  constexpr const char* axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    columns.push_back({.name = name + "_" + axes[k],
                       .get = [=](const CascadeEvent& e) { return member(e) ? (*member(e))[k] : missing; },
                       .set =
                           [=](CascadeEvent& e, double x) {
                             if (std::isnan(x)) return;
                             if (!member(e)) member(e).emplace();
                             (*member(e))[k] = x;
                           },
                       .may_be_missing = true});
  }
}

std::vector<Column<CascadeEvent>> event_columns() {
  using Event = CascadeEvent;
  std::vector<Column<Event>> columns = {
      column<Event>(
          "cascade_vessel", [](auto& e) -> auto& { return e.vessel.vessel; }, 0, largest_vessel),
      column<Event>(
          "cascade_kind", [](auto& e) -> auto& { return e.vessel.kind; }, 0, 2),
      {.name = "cascade_generation",
       .get = [](const Event& e) { return e.vessel.generation < 0 ? missing : e.vessel.generation; },
       .set = [](Event& e, double x) { e.vessel.generation = std::isnan(x) ? -1 : static_cast<int>(x); },
       .may_be_missing = true,
       .least = 0,
       .most = 127},
      column<Event>(
          "cascade_radius", [](auto& e) -> auto& { return e.vessel.radius; }, 0),
      column<Event>(
          "cascade_length", [](auto& e) -> auto& { return e.vessel.length; }, 0),
      column<Event>(
          "cascade_wall_thickness", [](auto& e) -> auto& { return e.vessel.wall_thickness; }, 0),
      column<Event>(
          "cascade_strength_factor", [](auto& e) -> auto& { return e.vessel.strength_factor; }, 0),
      column<Event>(
          "cascade_flow", [](auto& e) -> auto& { return e.vessel.flow; }),
      column<Event>(
          "cascade_pressure_from", [](auto& e) -> auto& { return e.vessel.pressure_from; }),
      column<Event>(
          "cascade_pressure_to", [](auto& e) -> auto& { return e.vessel.pressure_to; }),
      column<Event>(
          "cascade_risk", [](auto& e) -> auto& { return e.risk; }),
      column<Event>(
          "cascade_net_pressure", [](auto& e) -> auto& { return e.net_pressure; }),
      optional_column<Event>(
          "cascade_ruptured", [](auto& e) -> auto& { return e.ruptured; }, 0, 1),
      optional_column<Event>(
          "cascade_time", [](auto& e) -> auto& { return e.time; }, 0),
      optional_column<Event>(
          "cascade_rupture_onset", [](auto& e) -> auto& { return e.rupture_onset; }, 0),
      column<Event>(
          "cascade_opening", [](auto& e) -> auto& { return e.opening; }, 0),
      column<Event>(
          "cascade_inflow_before", [](auto& e) -> auto& { return e.inflow_before; }),
      optional_column<Event>(
          "cascade_inflow_after", [](auto& e) -> auto& { return e.inflow_after; }),
      optional_column<Event>(
          "cascade_leak", [](auto& e) -> auto& { return e.leak; }),
      optional_column<Event>(
          "cascade_next_risk", [](auto& e) -> auto& { return e.next_risk; })};
  add_point(
      columns, "cascade_start", [](auto& e) -> auto& { return e.vessel.start; });
  add_point(
      columns, "cascade_end", [](auto& e) -> auto& { return e.vessel.end; });
  return columns;
}

std::vector<Column<VesselFailure>> failure_columns() {
  using Failure = VesselFailure;
  return {column<Failure>(
              "cascade_failed_vessel", [](auto& f) -> auto& { return f.vessel; }, 0, largest_vessel),
          column<Failure>(
              "cascade_occluded", [](auto& f) -> auto& { return f.occluded; }, 0, 1),
          column<Failure>(
              "cascade_orifice_strength", [](auto& f) -> auto& { return f.orifice.strength; }, 0),
          column<Failure>(
              "cascade_outside_pressure", [](auto& f) -> auto& { return f.orifice.outside_pressure; })};
}

/// `rows` are the same number on every rank.
template <class Row>
void save_rows(const std::vector<Row>& rows, const std::vector<Column<Row>>& columns,
               output::CheckpointWriter& file) {
  if (rows.empty()) return;
  for (const Column<Row>& c : columns) {
    std::vector<double> list;
    for (const Row& row : rows) list.push_back(c.get(row));
    file.write(c.name, list);
  }
}

template <class Row>
std::vector<Row> read_rows(std::int64_t count, const std::vector<Column<Row>>& columns,
                           output::CheckpointReader& file) {
  std::vector<Row> rows(static_cast<std::size_t>(count));
  if (rows.empty()) return rows;
  for (const Column<Row>& c : columns) {
    std::vector<double> list(rows.size());
    file.read(c.name, list, c.least, c.most);
    for (std::size_t i = 0; i < rows.size(); ++i) {
      if (std::isnan(list[i]) && !c.may_be_missing) file.refuse(fmt::format("'{}' lacks a number", c.name));
      c.set(rows[i], list[i]);
    }
  }
  return rows;
}

std::vector<std::string> read_names(const char* name, std::size_t count, output::CheckpointReader& file) {
  std::string text;
  file.read(name, text);
  std::vector<std::string> names;
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(end_of_name, begin), text.size());
    names.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  if (names.size() != count)
    file.refuse(fmt::format("'{}' has {} names, of {} events", name, names.size(), count));
  return names;
}

}  // namespace

void save_cascade(const CascadeState& state, parallel::Communicator comm, output::CheckpointWriter& file) {
  file.write(cascade_name, static_cast<std::int64_t>(state.events.size()));
  file.write(failures_name, static_cast<std::int64_t>(state.failures.size()));
  file.write("cascade_elapsed", state.elapsed);
  file.write("cascade_steps_before", state.steps_before);
  save_rows(state.events, event_columns(), file);
  save_rows(state.failures, failure_columns(), file);
  std::string names, next_names;
  for (const CascadeEvent& event : state.events) {
    names += event.vessel.name + end_of_name;
    next_names += event.next_vessel.value_or("") + end_of_name;
  }
  file.write(names_name, comm.broadcast(names));
  file.write(next_names_name, comm.broadcast(next_names));
}

CascadeState read_cascade(output::CheckpointReader& file) {
  constexpr double most_events = 1e6;
  std::int64_t events = 0, failures = 0;
  CascadeState state;
  file.read(cascade_name, events, 0, most_events);
  file.read(failures_name, failures, 0, static_cast<double>(events));
  file.read("cascade_elapsed", state.elapsed, 0);
  file.read("cascade_steps_before", state.steps_before, 0);
  state.events = read_rows(events, event_columns(), file);
  state.failures = read_rows(failures, failure_columns(), file);
  const auto names = read_names(names_name, state.events.size(), file);
  const auto next_names = read_names(next_names_name, state.events.size(), file);
  for (std::size_t i = 0; i < state.events.size(); ++i) {
    CascadeEvent& event = state.events[i];
    event.vessel.name = names[i];
    if (event.next_risk) event.next_vessel = next_names[i];
    state.simulated.push_back(static_cast<std::uint32_t>(event.vessel.vessel));
  }
  return state;
}

}  // namespace rhexis::studies
