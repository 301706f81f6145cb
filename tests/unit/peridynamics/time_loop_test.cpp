// SPDX-License-Identifier: BSD-3-Clause
#include "peridynamics/simulation/time_loop.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/error.hpp"
#include "peridynamics/simulation/energy_balance.hpp"
#include "peridynamics/simulation/rupture_observer.hpp"
#include "support/weak_vessel.hpp"

namespace rhexis::peridynamics {
namespace {

/// Writes down what it is called for, and is interested in every `every`th step.
struct Diary final : Observer {
  Diary(std::string its_name, long steps, std::vector<std::string>& its_book)
      : name(std::move(its_name)), every(steps), book(its_book) {}
  void note(const std::string& what, const Moment& moment) {
    book.push_back(name + " " + what + " " + std::to_string(moment.step));
  }
  void arrive(const Moment& moment) override {
    moments.push_back(moment);
    note("arrives", moment);
  }
  bool wants(const Moment& moment) override { return moment.step % every == 0; }
  void observe(const Moment& moment) override {
    note("observes", moment);
    if (fails) throw RunError("the disk is full");
  }
  void rescue(const Moment& moment) override { note("rescues", moment); }
  void end(const Moment& moment) override { note("ends", moment); }

  std::string name;
  long every;
  std::vector<std::string>& book;
  std::vector<Moment> moments = {};
  bool fails = false;
};

struct NotedLoad final : LoadSource {
  explicit NotedLoad(std::vector<std::string>& its_book) : book(its_book) {}
  void at_moment(VesselSimulation& s) override {
    book.push_back("load answers " + std::to_string(s.step_number()));
  }
  std::vector<std::string>& book;
};

struct Loop {
  test::MadeVessel made;
  std::vector<std::string> book;
  NotedLoad load{book};
  Diary a{"a", 1, book}, b{"b", 2, book};
  int run(const LoopPlan& plan) {
    TimeLoop loop(made.simulation, load, plan);
    loop.subscribe(a);
    loop.subscribe(b);
    return loop.run();
  }
};

TEST(TimeLoop, CallsObserversInTheOrderOfTheirSubscription) {
  Loop loop;
  EXPECT_EQ(loop.run({.steps = 1}), 0);
  const std::vector<std::string> expected = {
      "a arrives 0", "b arrives 0",    "load answers 0", "a observes 0", "b observes 0", "a arrives 1",
      "b arrives 1", "load answers 1", "a observes 1",   "a ends 1",     "b ends 1"};
  EXPECT_EQ(loop.book, expected);
  EXPECT_TRUE(loop.a.moments[0].first && !loop.a.moments[0].last);
  EXPECT_TRUE(!loop.a.moments[1].first && loop.a.moments[1].last);
  EXPECT_EQ(loop.a.moments[1].time_s, loop.made.simulation.time_at(1));
}

TEST(TimeLoop, ASignalEndsTheRunAtTheMomentAfterTheStep) {
  Loop loop;
  int asked = 0;
  EXPECT_EQ(loop.run({.steps = 50, .signal = [&] { return ++asked == 3 ? 15 : 0; }}), 15);
  EXPECT_EQ(loop.made.simulation.step_number(), 3);
  EXPECT_EQ(loop.a.moments.back().signal, 15);
  EXPECT_TRUE(loop.a.moments.back().last);
}

TEST(TimeLoop, ASignalDuringTheLastStepComesTooLate) {
  Loop loop;
  EXPECT_EQ(loop.run({.steps = 3, .signal = [&] { return loop.a.moments.size() == 3 ? 15 : 0; }}), 0);
}

TEST(TimeLoop, HasAllObserversRescueWhenOneFails) {
  Loop loop;
  loop.a.fails = true;
  EXPECT_THROW(loop.run({.steps = 3}), RunError);
  const std::vector<std::string> expected = {"a arrives 0",  "b arrives 0", "load answers 0",
                                             "a observes 0", "a rescues 0", "b rescues 0"};
  EXPECT_EQ(loop.book, expected);
}

TEST(TimeLoop, TellsOfTheRuptureOnceAndEndsThereIfAsked) {
  Loop loop;
  int told = 0;
  RuptureObserver rupture(loop.made.simulation, [&](const RuptureEvents& events) {
    ++told;
    EXPECT_TRUE(events.onset);
  });
  TimeLoop time_loop(loop.made.simulation, loop.load, {.steps = 1000, .ends_at_rupture = true});
  time_loop.subscribe(rupture);
  EXPECT_EQ(time_loop.run(), 0);
  EXPECT_EQ(told, 1);
  EXPECT_EQ(*loop.made.simulation.rupture().onset,
            loop.made.simulation.time_at(loop.made.simulation.step_number() - 1));
  // Continued, it tells nothing that was known before.
  RuptureObserver later(loop.made.simulation, [&](const RuptureEvents&) { ++told; });
  later.arrive({});
  EXPECT_EQ(told, 1);
}

TEST(TimeLoop, ObservingChangesNothing) {
  Loop watched, unwatched;
  watched.run({.steps = 200});
  TimeLoop(unwatched.made.simulation, unwatched.load, {.steps = 200}).run();
  EXPECT_EQ(watched.made.simulation.totals().strain, unwatched.made.simulation.totals().strain);
  EXPECT_EQ(watched.made.simulation.body().save().displacement,
            unwatched.made.simulation.body().save().displacement);
}

TEST(EnergyBalance, RefusesAWallThatHoldsMoreThanTheLoadHasPutIn) {
  test::MadeVessel made;
  LoadSource load;
  EnergyBalance balance(made.simulation, {});
  TimeLoop loop(made.simulation, load, {.steps = 20});
  loop.subscribe(balance);
  loop.run();
  // A wall that is thrown apart.
  Body::Saved state = made.simulation.body().save();
  for (double& v : state.leapfrog_velocity[0]) v = 10;
  made.simulation.body().restore(state);
  TimeLoop further(made.simulation, load, {.steps = 20});
  further.subscribe(balance);
  try {
    further.run();
    FAIL() << "not refused";
  } catch (const UnstableError& error) {
    EXPECT_EQ(error.step, 20);
    EXPECT_NE(std::string(error.what()).find("more energy than the load has put in"), std::string::npos);
  }
}

TEST(EnergyBalance, LooksMoreAndMoreRarelyAfterTheFirstBreak) {
  test::MadeVessel made;
  const std::vector<long> steps = {0, 100};
  EnergyBalance balance(made.simulation, steps);
  const auto wanted = [&] {
    std::vector<long> found;
    for (long step = 0; step <= 100; ++step)
      if (balance.wants({.step = step})) found.push_back(step);
    return found;
  };
  EXPECT_EQ(wanted(), steps);
  made.simulation.resume(40, {.first_break = made.simulation.time_at(40)}, {});
  EXPECT_EQ(wanted(), (std::vector<long>{0, 41, 42, 44, 48, 56, 72, 100}));
}

TEST(CrushedBonds, AreToldOfOnce) {
  test::MadeVessel made;
  // Every particle is drawn towards the axis, all to a third of its distance.
  Body::Saved state = made.simulation.body().save();
  const FieldView at_rest = made.simulation.particle_source().reference_positions();
  for (std::size_t k = 0; k < 2; ++k) {
    for (std::size_t i = 0; i < at_rest.count; ++i) state.displacement[k][i] = -0.7 * at_rest.component[k][i];
  }
  made.simulation.body().restore(state);
  made.simulation.observe();
  ASSERT_GT(made.simulation.totals().crushed_bonds, 0);
  bool told = false;
  int warnings = 0;
  CrushedBonds crushed(made.simulation, {}, told, [&](const std::string&) { ++warnings; });
  EXPECT_FALSE(crushed.wants({.step = 7}));
  ASSERT_TRUE(crushed.wants({.step = 7, .last = true}));
  for (int i = 0; i < 2; ++i) crushed.observe({});
  EXPECT_TRUE(told);
  EXPECT_EQ(warnings, 1);
}

}  // namespace
}  // namespace rhexis::peridynamics
