#include "app/vessel_run.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include "app/interrupt.hpp"
#include "app/movie.hpp"
#include "app/version.hpp"
#include "core/error.hpp"
#include "core/format.hpp"
#include "output/checkpoint.hpp"
#include "output/directory.hpp"
#include "peridynamics/bond_kernel.hpp"
#include "peridynamics/schedule.hpp"

namespace rhexis::app {
namespace {

/// Steps between measurements of the opening, once bonds have begun to break.
constexpr long venting_interval = 10;

/// What ranks tell each other after every step, as bits.
enum Flag : std::uint64_t { interrupted = 1, broken = 2, ruptured = 4, unstable = 8 };

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// Adds the time that passes while it lives.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(now()) {}
  ~Stopwatch() { total_ += now() - start_; }
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;

 private:
  double& total_;
  double start_;
};

output::WordBlock word_block(const peridynamics::Body& body) {
  const peridynamics::BondWordLayout l = body.bond_word_layout();
  return {l.rows, l.words, l.first_row, l.row_count, l.first_word, l.word_count};
}

insitu::Renderer renderer(const std::string& name) {
  if (name == "osmesa") return insitu::Renderer::osmesa;
  if (name == "egl") return insitu::Renderer::egl;
  if (name == "x11") return insitu::Renderer::x11;
  return insitu::Renderer::automatic;
}

}  // namespace

VesselRun::VesselRun(Configuration configuration, RunOptions options, parallel::Communicator comm)
    : c_(std::move(configuration)),
      options_(std::move(options)),
      comm_(comm),
      console_(comm.is_root(), options_.quiet),
      started_(now()) {}

VesselRun::~VesselRun() = default;

double VesselRun::pressure_at(long step) const {
  return peridynamics::scheduled_pressure(c_.vessel, time_at(step));
}

Ending VesselRun::run() {
  build();
  open_results();
  try {
    start_insitu();
    say_header();
    if (!options_.restart.empty()) read_checkpoint();
    time_loop();
    finish_pictures();
  } catch (const RunError& error) {
    record_->fail(error.what(), results_, performance());
    throw;
  }
  if (interrupted_) {
    record_->fail("interrupted", results_, performance());
  } else {
    record_->complete(results_, performance());
  }
  say_summary();
  return interrupted_ ? Ending::interrupted : Ending::completed;
}

void VesselRun::build() {
  lattice_ = peridynamics::make_lattice(c_.vessel);
  peridynamics::BondFamilies families = peridynamics::make_families(lattice_);
  const bool periodic = peridynamics::end_condition(c_.vessel) == peridynamics::EndCondition::axial_periodic;
  results_.particles = lattice_.particles();
  results_.bonds = peridynamics::count_bonds(lattice_, families, periodic);
  results_.family_max = peridynamics::largest_family(lattice_, families, periodic);
  results_.time_step_s = c_.time_step;
  results_.stable_time_step_s = c_.stable_time_step;
  body_ = peridynamics::make_body(
      peridynamics::make_setup(c_.vessel, lattice_, std::move(families), c_.time_step), comm_);
  source_ = std::make_unique<peridynamics::ParticleSource>(*body_);
  gauge_ = std::make_unique<peridynamics::OpeningGauge>(lattice_, *body_, comm_);
}

void VesselRun::open_results() {
  const bool restarts = !options_.restart.empty();
  if (restarts) {
    std::int64_t step = 0;
    output::CheckpointReader(options_.restart, comm_).read("step", step);
    first_step_ = static_cast<long>(step);
  }
  output::prepare_directory(options_.directory,
                            restarts ? output::EarlierResults::keep : output::EarlierResults::remove, comm_);
  record_.emplace(options_.directory / "run.json", version(), commit(), c_.record, comm_);
  if (restarts) {
    history_.emplace(options_.directory / "history.csv", comm_, first_step_);
  } else {
    history_.emplace(options_.directory / "history.csv", comm_);
  }
  if (c_.output.fields.empty()) return;
  output::PointSeriesPlan plan;
  plan.directory = options_.directory;
  // A restart leaves the series of the run that it continues as it is.
  if (restarts) plan.basename = fmt::format("particles_from_{:06d}", first_step_);
  plan.title = c_.title;
  plan.version = version();
  plan.precision = c_.output.precision == "double" ? output::Precision::double_precision
                                                   : output::Precision::single_precision;
  for (const FieldInfo& field : peridynamics::ParticleSource::all_fields()) {
    if (std::find(c_.output.fields.begin(), c_.output.fields.end(), field.name) != c_.output.fields.end()) {
      plan.fields.push_back(field);
    }
  }
  std::copy_if(c_.output_steps.begin(), c_.output_steps.end(), std::back_inserter(plan.steps),
               [&](long step) { return step >= first_step_; });
  series_.emplace(plan, body_->layout(), comm_);
  series_->write_reference(source_->positions());
}

void VesselRun::start_insitu() {
  if (!c_.insitu.enabled) {
    renderer_ = "off (insitu.enabled = false)";
    return;
  }
  if (c_.insitu.scripts.empty()) {
    renderer_ = "off (no insitu.scripts)";
    return;
  }
  const Stopwatch watch(spent_.insitu);
  try {
    pipeline_ = insitu::load_pipeline(
        {c_.insitu.scripts, (options_.directory / "images").string(), renderer(c_.insitu.renderer)}, comm_);
    renderer_ = pipeline_->description();
  } catch (const insitu::NotAvailable& reason) {
    renderer_ = std::string("off: ") + reason.what();
  }
}

bool VesselRun::pictures_due(long step, bool output_due) {
  if (!pipeline_) return false;
  const bool due =
      c_.insitu.every_steps ? step % *c_.insitu.every_steps == 0 || step == c_.steps : output_due;
  // Scripts are asked last: the answer may need all ranks.
  return due && pipeline_->wants(step, time_at(step));
}

void VesselRun::observe(long step, bool with_output, bool with_pictures) {
  const double pressure = pressure_at(step) * vent_now_;
  {
    const Stopwatch watch(with_output ? spent_.output : spent_.insitu);
    const peridynamics::Observation& observation = body_->observe(pressure);
    source_->moment(step, time_at(step), observation, {{"pressure", "Pa", pressure}});
  }
  if (with_output) {
    const Stopwatch watch(spent_.output);
    const peridynamics::Totals t = body_->totals();
    open_area_ = gauge_->area();
    const double leak = peridynamics::orifice_flow(c_.vessel.discharge_coefficient, open_area_, pressure,
                                                   c_.vessel.blood_density);
    results_.steps = step;
    results_.simulated_s = time_at(step);
    results_.max_displacement_m = t.max_displacement;
    results_.max_damage = t.max_damage;
    results_.rupture_length_m = t.rupture_length;
    results_.opening_area_m2 = open_area_;
    const double energy = t.kinetic + t.strain + t.fracture;
    const double scale = std::max(std::abs(t.external_work), energy);
    results_.energy_drift = scale > 0 ? (energy - t.external_work) / scale : 0.0;
    history_->append({step, time_at(step), pressure, t.max_displacement, t.max_damage,
                      static_cast<long>(t.broken_bonds), t.kinetic, t.strain, t.external_work,
                      t.rupture_length, leak});
    if (series_) series_->write(*source_);
  }
  if (with_pictures) {
    const Stopwatch watch(spent_.insitu);
    pipeline_->process(*source_);
  }
}

/// Notes what the forces' evaluation at `step` brought about, on any rank.
void VesselRun::take_notice(long step, std::uint64_t flags) {
  if (flags & Flag::unstable) {
    throw RunError(fmt::format(
        "the run became unstable at step {} ({}): a particle moved more than a spacing in one "
        "step; use a smaller time.step (now {}, stable up to {} for small strain)",
        step, quantity(time_at(step), "s"), quantity(c_.time_step, "s"), quantity(c_.stable_time_step, "s")));
  }
  if (flags & Flag::broken && !results_.first_bond_break_s) results_.first_bond_break_s = time_at(step);
  if (flags & Flag::ruptured && !results_.rupture_onset_s) {
    results_.rupture_onset_s = time_at(step);
    results_.max_displacement_at_onset_m = body_->max_displacement();
    console_.line(fmt::format("  rupture begins at {} under {}, largest displacement {}",
                              quantity(time_at(step), "s"), quantity(pressure_at(step) * vent_now_, "Pa"),
                              quantity(*results_.max_displacement_at_onset_m, "m", 3)));
  }
}

/// Settles what share of the pressure is left at the next step.
void VesselRun::vent(long step) {
  if (c_.vessel.venting == "none" || !results_.first_bond_break_s || step % venting_interval != 0) return;
  open_area_ = gauge_->area();
  vent_next_ = peridynamics::venting_factor(open_area_, *c_.vessel.supply_area);
  least_vent_ = std::min(least_vent_, vent_next_);
}

void VesselRun::time_loop() {
  const InterruptGuard guard;
  const auto output_due = [&](long step) {
    return std::binary_search(c_.output_steps.begin(), c_.output_steps.end(), step);
  };
  for (step_ = first_step_;; ++step_) {
    const bool due = output_due(step_) || interrupted_;
    const bool pictures = pictures_due(step_, due);
    if (due || pictures) observe(step_, due, pictures);
    console_.progress(step_, c_.steps,
                      fmt::format("t {}  P {}", quantity(time_at(step_), "s", 3),
                                  quantity(pressure_at(step_) * vent_now_, "Pa", 3)));
    const bool saves =
        c_.output.checkpoint_every > 0 && step_ > first_step_ && step_ % c_.output.checkpoint_every == 0;
    if (interrupted_ || saves) write_checkpoint(step_);
    if (interrupted_ || step_ == c_.steps) return;

    const Stopwatch watch(spent_.solve);
    vent(step_);
    const peridynamics::StepEvents events =
        body_->advance(pressure_at(step_) * vent_now_, pressure_at(step_ + 1) * vent_next_);
    std::uint64_t flags = 0;
    if (InterruptGuard::requested()) flags |= Flag::interrupted;
    if (events.broken > 0) flags |= Flag::broken;
    if (events.damaged) flags |= Flag::ruptured;
    if (events.unstable) flags |= Flag::unstable;
    comm_.all_reduce({&flags, 1}, parallel::Reduce::bit_or);
    take_notice(step_, flags);
    interrupted_ = (flags & Flag::interrupted) != 0;
    vent_now_ = vent_next_;
  }
}

void VesselRun::write_checkpoint(long step) {
  const Stopwatch watch(spent_.output);
  const peridynamics::Body::Saved saved = body_->save();
  const auto path = options_.directory / "checkpoints" / fmt::format("step_{:06d}.h5", step);
  output::CheckpointWriter file(path, comm_);
  file.write("step", std::int64_t{step});
  file.write("time_step", c_.time_step);
  file.write("first_kick_pending", std::int64_t{saved.first_kick_pending});
  file.write("external_work", saved.external_work);
  file.write("vent", vent_now_);
  file.write("first_bond_break", results_.first_bond_break_s.value_or(-1));
  file.write("rupture_onset", results_.rupture_onset_s.value_or(-1));
  file.write("onset_displacement", results_.max_displacement_at_onset_m.value_or(-1));
  constexpr const char* axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    file.write(fmt::format("frame_{}", axes[k]), saved.frame[k]);
    file.write(fmt::format("displacement_{}", axes[k]), body_->layout(), saved.displacement[k]);
    file.write(fmt::format("leapfrog_velocity_{}", axes[k]), body_->layout(), saved.leapfrog_velocity[k]);
  }
  file.write("intact_bonds", word_block(*body_), saved.words);
  file.close();
  if (interrupted_) {
    console_.line("  interrupted; go on with --restart " + path.string());
  }
}

void VesselRun::read_checkpoint() {
  output::CheckpointReader file(options_.restart, comm_);
  peridynamics::Body::Saved saved = body_->save();
  double time_step = 0, onset = -1, first_break = -1, onset_displacement = -1;
  std::int64_t pending = 0;
  file.read("time_step", time_step);
  if (time_step != c_.time_step) {
    throw RunError(
        fmt::format("{}: the checkpoint was made with a time step of {} s, this run has {} s; set time.step",
                    options_.restart.string(), time_step, c_.time_step));
  }
  file.read("first_kick_pending", pending);
  saved.first_kick_pending = pending != 0;
  file.read("external_work", saved.external_work);
  file.read("vent", vent_now_);
  vent_next_ = vent_now_;
  file.read("first_bond_break", first_break);
  file.read("rupture_onset", onset);
  file.read("onset_displacement", onset_displacement);
  if (first_break >= 0) results_.first_bond_break_s = first_break;
  if (onset >= 0) results_.rupture_onset_s = onset;
  if (onset_displacement >= 0) results_.max_displacement_at_onset_m = onset_displacement;
  constexpr const char* axes[] = {"x", "y", "z"};
  for (std::size_t k = 0; k < 3; ++k) {
    file.read(fmt::format("frame_{}", axes[k]), saved.frame[k]);
    file.read(fmt::format("displacement_{}", axes[k]), body_->layout(), saved.displacement[k]);
    file.read(fmt::format("leapfrog_velocity_{}", axes[k]), body_->layout(), saved.leapfrog_velocity[k]);
  }
  file.read("intact_bonds", word_block(*body_), saved.words);
  body_->restore(saved);
}

void VesselRun::finish_pictures() {
  if (!pipeline_) return;
  const Stopwatch watch(spent_.insitu);
  pipeline_->finish();
  if (!c_.output.movie) return;
  std::string problem;
  if (comm_.is_root()) {
    problem = make_movie(options_.directory / "images", options_.directory / "movie.mp4",
                         c_.output.frames_per_second);
  }
  if (!problem.empty()) console_.warning("no movie: " + problem);
}

output::Performance VesselRun::performance() const {
  output::Performance p;
  p.ranks = comm_.size();
  p.threads = parallel::thread_count();
  p.wall_s = now() - started_;
  p.solve_s = spent_.solve;
  p.insitu_s = spent_.insitu;
  p.output_s = spent_.output;
  p.bond_evaluations = comm_.all_reduce(body_->bond_evaluations(), parallel::Reduce::sum);
  if (spent_.solve > 0) p.bond_evaluations_per_s = static_cast<double>(*p.bond_evaluations) / spent_.solve;
  p.flop = static_cast<double>(*p.bond_evaluations) * peridynamics::flop_per_bond;
  p.peak_rss_bytes = comm_.all_reduce(output::peak_resident_bytes(), parallel::Reduce::sum);
  p.node_hours = *p.wall_s * comm_.node_count() / 3600;
  return p;
}

void VesselRun::say_header() {
  const peridynamics::Parameters& v = c_.vessel;
  console_.line(
      fmt::format("Rhexis {} ({}): {}", version(), commit(), c_.title.empty() ? c_.file : c_.title));
  for (const std::string& warning : c_.warnings) console_.warning(warning);
  console_.item("input", c_.file);
  console_.item("vessel", fmt::format("lumen radius {}, outer radius {}, length {}; ends {}",
                                      quantity(v.inner_radius, "m"), quantity(v.outer_radius, "m"),
                                      quantity(v.length, "m"), v.ends));
  console_.item("particles", fmt::format("{} ({} columns x {} rows, {}), spacing {}, horizon {}",
                                         grouped(*results_.particles), lattice_.section.size(), lattice_.rows,
                                         v.cross_section, quantity(lattice_.spacing, "m"),
                                         quantity(lattice_.horizon, "m")));
  console_.item("bonds", fmt::format("{}, at most {} a particle, {} precision", grouped(*results_.bonds),
                                     *results_.family_max, v.bond_precision));
  console_.item("time", fmt::format("{} steps of {} ({:.0f} % of the stable {})", c_.steps - first_step_,
                                    quantity(c_.time_step, "s"), 100 * c_.time_step / c_.stable_time_step,
                                    quantity(c_.stable_time_step, "s")));
  console_.item("load",
                fmt::format("{} ({}), layer {}, venting {}",
                            quantity(v.schedule == "table" ? v.table.back().second : v.pressure, "Pa"),
                            v.schedule, v.layer, v.venting));
  console_.item("parallel", fmt::format("{} rank{} x {} thread{}", comm_.size(), comm_.size() > 1 ? "s" : "",
                                        parallel::thread_count(), parallel::thread_count() > 1 ? "s" : ""));
  console_.item("pictures", renderer_);
  console_.item("results", options_.directory.string());
}

void VesselRun::say_summary() {
  const output::Results& r = results_;
  const output::Performance p = performance();
  const auto at = [](const std::optional<double>& time) { return time ? quantity(*time, "s") : "none"; };
  console_.line(interrupted_ ? "Interrupted; everything so far is saved." : "Done.");
  console_.item("first break", at(r.first_bond_break_s));
  console_.item("rupture", r.rupture_onset_s
                               ? fmt::format("begins at {} (damage {} somewhere), {} long at the end",
                                             at(r.rupture_onset_s), peridynamics::rupture_damage,
                                             quantity(*r.rupture_length_m, "m"))
                               : "none");
  console_.item(
      "at the end",
      fmt::format("largest displacement {}, largest damage {:.0f} %, opening {:.3g} mm2",
                  quantity(*r.max_displacement_m, "m", 3), 100 * *r.max_damage, *r.opening_area_m2 * 1e6));
  if (least_vent_ < 1) {
    console_.item("venting", fmt::format("the opening let the pressure fall to {:.0f} % of the scheduled one",
                                         100 * least_vent_));
  }
  console_.item("energy", fmt::format("balance off by {:.1e} of the work done", *r.energy_drift));
  const long steps = step_ - first_step_;
  console_.item("speed",
                fmt::format("{:.0f} steps/s, {:.3g} bonds/s", static_cast<double>(steps) / *p.solve_s,
                            p.bond_evaluations_per_s.value_or(0)));
  console_.item("time spent",
                fmt::format("{} in all: {} solving, {} pictures, {} output", duration(*p.wall_s),
                            duration(*p.solve_s), duration(*p.insitu_s), duration(*p.output_s)));
  console_.item("memory",
                fmt::format("{:.0f} MB over all ranks", static_cast<double>(*p.peak_rss_bytes) / 1e6));
  console_.item("results", options_.directory.string());
}

}  // namespace rhexis::app
