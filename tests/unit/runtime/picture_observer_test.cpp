// SPDX-License-Identifier: BSD-3-Clause
#include "runtime/picture_observer.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rhexis::runtime {
namespace {

/// Scripts that want every step that they are asked for.
struct Willing final : insitu::Pipeline {
  explicit Willing(std::vector<long>& steps) : asked(steps) {}
  std::string description() const override { return "nobody"; }
  bool wants(long step, double) override {
    asked.push_back(step);
    return true;
  }
  void process(long, double, const insitu::Channels&) override {}
  void finish() override {}
  std::vector<long>& asked;
};

TEST(PictureObserver, AsksScriptsOnlyWhenPicturesAreDue) {
  std::vector<long> asked;
  Pictures pictures;
  pictures.pipeline = std::make_unique<Willing>(asked);
  pictures.steps_before = 1000;
  const std::vector<long> steps = {0, 4};
  PictureObserver with_output(pictures, {.output_steps = steps});
  PictureObserver every_third(pictures, {.every_steps = 3, .output_steps = steps});
  const auto asked_by = [&](PictureObserver& observer, const Moment& end) {
    asked.clear();
    observer.wants({.step = 1, .first = true});
    for (long step = 2; step < 8; ++step) observer.wants({.step = step});
    observer.wants(end);
    return asked;
  };
  const Moment end{.step = 8, .last = true}, interrupted{.step = 8, .last = true, .signal = 15};
  EXPECT_EQ(asked_by(with_output, end), (std::vector<long>{1001, 1004, 1008}));
  EXPECT_EQ(asked_by(with_output, interrupted), (std::vector<long>{1001, 1004, 1008}));
  EXPECT_EQ(asked_by(every_third, end), (std::vector<long>{1003, 1006, 1008}));
  EXPECT_EQ(asked_by(every_third, interrupted), (std::vector<long>{1003, 1006}));
}

TEST(PictureObserver, WantsNothingWithoutAPipeline) {
  Pictures pictures;
  PictureObserver observer(pictures, {});
  EXPECT_FALSE(observer.wants({.first = true, .last = true}));
}

}  // namespace
}  // namespace rhexis::runtime
