// What checkpoints hold of a network and its vessel, coupled.
#include <fmt/format.h>

#include <array>

#include "app/checkpoint_input.hpp"
#include "app/network_coupling.hpp"
#include "core/error.hpp"
#include "output/kept_rows.hpp"
#include "parallel/together.hpp"

namespace rhexis::app {
namespace {

constexpr std::array places = {"from", "middle", "to"};

std::string load_name(std::size_t place) {
  return fmt::format("net_pressure_in_intact_vessel_{}", places[place]);
}

}  // namespace

/// Names, members and least values of the exchange so far, once for `save` and `restore`.
template <class Coupling, class Visit>
void NetworkCoupling::for_each_number(Coupling& c, const Visit& visit) {
  for (std::size_t i = 0; i < 3; ++i)
    visit(fmt::format("net_pressure_{}", places[i]), c.load_.pressure[i], 0.0);
  visit("leak", c.leak_, 0.0);
  visit("leaked_volume", c.leaked_, 0.0);
  visit("last_exchange_time", c.last_time_, 0.0);
  visit("worst_imbalance", c.worst_imbalance_, 0.0);
  visit("schedule_share", c.schedule_, 0.0);
  visit("highest_reynolds", c.highest_reynolds_, 0.0);
  visit("windows", c.windows_, 0.0);
}

void NetworkCoupling::save(output::CheckpointWriter& file) const {
  file.write("coupling_mode", c_.coupling.mode);
  file.write(coupled_vessel_name, comm_.broadcast(chosen_.name));
  file.write("network_inflow", network_.flow().inflow);
  for (std::size_t i = 0; i < 3; ++i) file.write(load_name(i), first_load_.pressure[i]);
  if (two_way())
    for_each_number(*this,
                    [&](const std::string& name, const auto& value, double) { file.write(name, value); });
  if (cascade_ != nullptr) save_cascade(*cascade_, comm_, file);
}

void NetworkCoupling::restore(output::CheckpointReader& file, double time_s,
                              const std::filesystem::path& directory) {
  compare_with(file);
  if (!two_way()) return;
  for_each_number(*this,
                  [&](const std::string& name, auto& value, double least) { file.read(name, value, least); });
  // The exchange at the checkpoint's moment is done anew.
  parallel::on_root<InputError>(comm_, [&] {
    kept_table_ = output::kept_rows(directory / table_name, table_header,
                                    [&](double row_time) { return row_time < time_s; });
  });
}

/// A run goes on with the network that it began with, or its results would be those of neither.
void NetworkCoupling::compare_with(output::CheckpointReader& file) const {
  if (!file.holds(coupled_vessel_name))
    file.refuse("the checkpoint is not of a vessel that is coupled with a network");
  if (file.holds(cascade_name) != (cascade_ != nullptr))
    file.refuse(cascade_ != nullptr ? "the checkpoint is not of a cascade, as cascade.events asks for"
                                    : "the checkpoint is of a cascade's event; set cascade.events");
  std::string mode, vessel;
  double inflow = 0;
  std::array<double, 3> load{};
  file.read("coupling_mode", mode);
  if (mode != c_.coupling.mode)
    file.refuse(fmt::format("coupling.mode was \"{}\", and now is \"{}\"", mode, c_.coupling.mode));
  file.read(coupled_vessel_name, vessel);
  file.read("network_inflow", inflow);
  for (std::size_t i = 0; i < 3; ++i) file.read(load_name(i), load[i]);
  parallel::on_root<InputError>(comm_, [&] {
    const auto differs = [&](const std::string& what, const std::string& was, const std::string& now) {
      file.refuse(fmt::format("the network is not as it was: {} was {}, and now is {}", what, was, now));
    };
    if (vessel != chosen_.name) differs("the chosen vessel", vessel, chosen_.name);
    // Another constant load is a user's right, and is told.
    if (!two_way() && cascade_ == nullptr) return;
    if (!alike(inflow, network_.flow().inflow))
      differs("its inflow", fmt::format("{} m3/s", inflow), fmt::format("{} m3/s", network_.flow().inflow));
    for (std::size_t i = 0; i < 3; ++i) {
      if (alike(load[i], first_load_.pressure[i])) continue;
      differs(fmt::format("the net pressure in the intact vessel ({})", places[i]),
              fmt::format("{} Pa", load[i]), fmt::format("{} Pa", first_load_.pressure[i]));
    }
  });
}

}  // namespace rhexis::app
