// SPDX-License-Identifier: BSD-3-Clause
// What checkpoints hold of a vessel that is coupled with its network, and its table.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.hpp"
#include "coupling/coupled_vessel.hpp"
#include "output/kept_rows.hpp"
#include "parallel/together.hpp"

namespace rhexis::coupling {
namespace {

constexpr const char* table_header =
    "time_s,schedule,net_pressure_from_Pa,net_pressure_middle_Pa,net_pressure_to_Pa,opening_m2,leak_m3_s,"
    "inflow_m3_s,outflow_m3_s,resistance_factor,imbalance";
constexpr std::array places = {"from", "middle", "to"};

std::string load_name(std::size_t place) {
  return fmt::format("net_pressure_in_intact_vessel_{}", places[place]);
}

/// Names, members and least values of the exchange so far, once for `save` and `restore`.
template <class State, class Visit>
void for_each_number(State& s, const Visit& visit) {
  for (std::size_t i = 0; i < 3; ++i)
    visit(fmt::format("net_pressure_{}", places[i]), s.load.pressure[i], 0.0);
  visit("leak", s.leak, 0.0);
  visit("leaked_volume", s.leaked, 0.0);
  visit("last_exchange_time", s.last_time, 0.0);
  visit("worst_imbalance", s.worst_imbalance, 0.0);
  visit("schedule_share", s.schedule, 0.0);
  visit("highest_reynolds", s.highest_reynolds, 0.0);
  visit("windows", s.windows, 0.0);
}

}  // namespace

bool agree(double a, double b) {
  return std::abs(a - b) <= 1e-9 * std::max(std::abs(a), std::abs(b));
}

void CoupledVessel::open_table(const output::ResultsFolder& folder) {
  if (!two_way()) return;
  const std::filesystem::path path = folder.claim(exchange_table_name);
  parallel::on_root<RunError>(comm_, [&] {
    table_ = output::TableFile(path, kept_table_.empty() ? fmt::format("{}\n", table_header) : kept_table_);
  });
}

void CoupledVessel::save(output::CheckpointWriter& file, double inflow) const {
  file.write("coupling_mode", std::string(name_of(p_.mode)));
  file.write(coupled_vessel_name, chosen_.name);
  file.write("network_inflow", inflow);
  for (std::size_t i = 0; i < 3; ++i) file.write(load_name(i), intact_load_.pressure[i]);
  if (!two_way()) return;
  for_each_number(state_,
                  [&](const std::string& name, const auto& value, double) { file.write(name, value); });
}

void CoupledVessel::restore(output::CheckpointReader& file, double inflow, bool compares_load, double time_s,
                            const std::filesystem::path& directory) {
  compare_with(file, inflow, compares_load || two_way());
  if (!two_way()) return;
  for_each_number(state_,
                  [&](const std::string& name, auto& value, double least) { file.read(name, value, least); });
  // The exchange at the checkpoint's moment is done anew.
  parallel::on_root<InputError>(comm_, [&] {
    kept_table_ = output::kept_rows(directory / exchange_table_name, table_header,
                                    [&](double row_time) { return row_time < time_s; });
  });
}

/// A run goes on with the network that it began with, or its results would be those of neither.
void CoupledVessel::compare_with(output::CheckpointReader& file, double inflow, bool compares_load) const {
  std::string mode, vessel;
  double earlier_inflow = 0;
  std::array<double, 3> load{};
  file.read("coupling_mode", mode);
  if (mode != name_of(p_.mode))
    file.refuse(fmt::format("coupling.mode was \"{}\", and now is \"{}\"", mode, name_of(p_.mode)));
  file.read(coupled_vessel_name, vessel);
  file.read("network_inflow", earlier_inflow);
  for (std::size_t i = 0; i < 3; ++i) file.read(load_name(i), load[i]);
  parallel::on_root<InputError>(comm_, [&] {
    const auto differs = [&](const std::string& what, const std::string& was, const std::string& now) {
      file.refuse(fmt::format("the network is not as it was: {} was {}, and now is {}", what, was, now));
    };
    if (vessel != chosen_.name) differs("the chosen vessel", vessel, chosen_.name);
    // Another constant load is a user's right, and is told.
    if (!compares_load) return;
    if (!agree(earlier_inflow, inflow))
      differs("its inflow", fmt::format("{} m3/s", earlier_inflow), fmt::format("{} m3/s", inflow));
    for (std::size_t i = 0; i < 3; ++i) {
      if (agree(load[i], intact_load_.pressure[i])) continue;
      differs(fmt::format("the net pressure in the intact vessel ({})", places[i]),
              fmt::format("{} Pa", load[i]), fmt::format("{} Pa", intact_load_.pressure[i]));
    }
  });
}

}  // namespace rhexis::coupling
