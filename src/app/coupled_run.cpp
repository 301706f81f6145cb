#include "app/coupled_run.hpp"

#include <fmt/format.h>

#include <optional>
#include <utility>

#include "app/folder_plan.hpp"
#include "app/network_coupling.hpp"
#include "app/network_files.hpp"
#include "app/network_tables.hpp"
#include "app/stopwatch.hpp"
#include "app/vessel_run.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "output/atomic_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::app {
namespace {

/// Ruptures one after the other. Each event has a folder of its own, with all that a coupled run leaves; what
/// the cascade adds is cascade.csv and run.json beside them.
class CascadeRun : private RunBase {
 public:
  CascadeRun(Configuration configuration, RunOptions options, parallel::Communicator comm)
      : RunBase(std::move(configuration), std::move(options), comm) {
    if (!options_.restart.empty()) throw InputError("a cascade cannot be restarted");
  }

  Ending run() {
    // Of the input: told once, not by every event.
    const std::vector<std::string> warnings = std::exchange(c_.warnings, {});
    const Configuration first = c_;
    say_title(console_, c_);
    open_folder();
    std::optional<NetworkCoupling> next;
    next.emplace(c_, comm_, console_);
    if (!next->at_rest()) c_ = next->hand_over();
    const Ending ending = recorded([&] {
      start_insitu();
      open_record();
      for (const std::string& warning : warnings) warn(warning);
      results_.cascade = nlohmann::ordered_json::array();
      Ending last = Ending::completed;
      std::string obstacle;  // to the next event
      const auto goes_on = [&] {
        return obstacle.empty() && !next->at_rest() && last == Ending::completed &&
               static_cast<std::int64_t>(results_.cascade.size()) < c_.coupling.events;
      };
      while (goes_on()) {
        last = simulate(*next);
        write_table();
        const Aftermath aftermath = c_.aftermath;
        c_ = first;
        c_.aftermath = aftermath;
        c_.coupling.vessel = "screening";
        c_.network.query = first.network.query;
        next.reset();
        next.emplace(c_, comm_, console_);
        tell_what_followed(*next);
        write_table();
        if (!goes_on()) break;
        try {
          c_ = next->hand_over();
        } catch (const InputError& error) {
          obstacle =
              fmt::format("event {} cannot be simulated: {}", results_.cascade.size() + 1, error.what());
        }
      }
      results_.network = next->network_results();
      next->write(*folder_);
      finish_insitu();
      make_movie();
      if (!obstacle.empty()) throw RunError(obstacle);
      return last == Ending::interrupted;
    });
    say_summary(ending == Ending::interrupted ? "interrupted"
                : next->at_rest()
                    ? fmt::format("no other vessel's risk is above {}", text(c_.coupling.risk_limit))
                    : "after cascade.events");
    return ending;
  }

 private:
  Ending simulate(NetworkCoupling& coupling) {
    const auto number = results_.cascade.size() + 1;
    const QueriedVessel vessel = coupling.vessel();
    console_.line(fmt::format("Event {}: vessel {}, risk {:.3f}", number, vessel.name, coupling.risk()));
    RunOptions options = options_;
    options.folder = folder_->subfolder(fmt::format("event_{:02d}", number));
    options.directory = options.folder->path();
    options.started = seconds_now();
    options.pictures = pictures_;
    coupling.set_event(number);
    const double pressure = coupling.pressure();
    VesselRun run(c_, options, comm_, &coupling);
    const Ending ending = run.run();
    spent_.add(run.spent());
    const output::Results& r = run.results();
    const double opening = r.opening_area_m2.value_or(0);
    c_.aftermath.settled.push_back(static_cast<std::uint32_t>(vessel.vessel));
    if (r.rupture_onset_s) {
      c_.aftermath.injuries.push_back({static_cast<std::uint32_t>(vessel.vessel),
                                       c_.coupling.outcome == "occlusion", coupling.orifice(opening)});
    }
    nlohmann::ordered_json event{{"event", number}, {"time_s", nullptr}, {"risk", coupling.risk()}};
    event.update(to_json(vessel));
    event["net_pressure_Pa"] = pressure;
    event["ruptured"] = r.rupture_onset_s.has_value();
    // An interrupted wall might have torn yet.
    if (ending == Ending::interrupted && !r.rupture_onset_s) event["ruptured"] = nullptr;
    event["rupture_onset_s"] = nullptr;
    if (r.rupture_onset_s) {
      event["time_s"] = elapsed_ + *r.rupture_onset_s;
      event["rupture_onset_s"] = *r.rupture_onset_s;
    }
    event["opening_m2"] = opening;
    event["inflow_before_m3_s"] = coupling.inflow();
    for (const char* later : {"inflow_after_m3_s", "leak_m3_s", "next_vessel", "next_risk"})
      event[later] = nullptr;
    elapsed_ += r.simulated_s.value_or(0);
    results_.cascade.push_back(std::move(event));
    results_.simulated_s = elapsed_;
    pictures_->steps_before += r.steps.value_or(0) + 1;
    pictures_->seconds_before = elapsed_;
    return ending;
  }

  /// The last event's row is complete when the network has been solved with what it left.
  void tell_what_followed(const NetworkCoupling& after) {
    if (!comm_.is_root()) return;
    nlohmann::ordered_json& event = results_.cascade.back();
    event["inflow_after_m3_s"] = after.inflow();
    if (event["ruptured"] == true && !after.leaks().empty()) event["leak_m3_s"] = after.leaks().back();
    if (after.risk() <= 0) return;
    event["next_vessel"] = after.vessel().name;
    event["next_risk"] = after.risk();
  }

  /// Of the record: one row for each event.
  void write_table() {
    const std::filesystem::path path = folder_->claim("cascade.csv");
    parallel::on_root<RunError>(comm_, [&] {
      const auto columns = {"event",
                            "time_s",
                            "name",
                            "kind",
                            "generation",
                            "risk",
                            "ruptured",
                            "rupture_onset_s",
                            "net_pressure_Pa",
                            "opening_m2",
                            "leak_m3_s",
                            "inflow_before_m3_s",
                            "inflow_after_m3_s",
                            "next_vessel",
                            "next_risk"};
      std::string table = fmt::format("{}\n", fmt::join(columns, ","));
      for (const auto& event : results_.cascade) {
        std::vector<std::string> row;
        for (const char* column : columns) {
          const auto& value = event[column];
          row.push_back(value.is_null()     ? ""
                        : value.is_string() ? quoted(value.template get<std::string>())
                                            : value.dump());
        }
        table += fmt::format("{}\n", fmt::join(row, ","));
      }
      output::write_atomically(path, table);
    });
  }

  void say_summary(const std::string& why_ended) {
    console_.line("Cascade:");
    if (comm_.is_root()) {
      for (const auto& event : results_.cascade) {
        console_.item(
            fmt::format("event {}", event["event"].get<int>()),
            fmt::format("{}, risk {:.3f}: {}", event["name"].get<std::string>(), event["risk"].get<double>(),
                        event["ruptured"] == true
                            ? fmt::format("ruptured at {}, inflow {:.4g} to {:.4g} mL/min",
                                          quantity(event["time_s"].get<double>(), "s"),
                                          event["inflow_before_m3_s"].get<double>() * 6e7,
                                          event["inflow_after_m3_s"].get<double>() * 6e7)
                            : std::string(event["ruptured"].is_null() ? "interrupted" : "held")));
      }
    }
    console_.item("ended", why_ended);
    say_cost(performance());
  }

  double elapsed_ = 0;  ///< s, simulated in all events
};

}  // namespace

Ending run_coupled(Configuration configuration, const RunOptions& options, parallel::Communicator comm) {
  if (configuration.coupling.events > 0) return CascadeRun(std::move(configuration), options, comm).run();
  if (configuration.coupling.mode == "two_way" && !options.restart.empty())
    throw InputError("--restart: checkpoints do not hold the state of two-way coupling");
  Console console(comm.is_root(), options.quiet);
  say_title(console, configuration);
  RunOptions with_folder = options;
  with_folder.folder.emplace(folder_plan(configuration, options), comm);
  NetworkCoupling coupling(configuration, comm, console);
  const Configuration& with_vessel = coupling.hand_over();
  return VesselRun(with_vessel, with_folder, comm, &coupling).run();
}

}  // namespace rhexis::app
