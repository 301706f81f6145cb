// SPDX-License-Identifier: BSD-3-Clause
/// Lines whose values tell field, component, owner and step, dealt out to ranks in uneven blocks.
#pragma once

#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"
#include "synthetic_source.hpp"

namespace rhexis::test {

/// Line l joins points of its own, 2 l and 2 l + 1; odd lines the other way round.
class SyntheticLines : public LineSource {
 public:
  SyntheticLines(std::int64_t lines, const parallel::Communicator& world, long step) : step_(step) {
    // On two ranks and more, the second has nothing and the first what would be its share too.
    const bool alone = world.size() == 1;
    const auto cut = [&](int part) { return lines * (part == 1 && !alone ? 2 : part) / world.size(); };
    first_ = cut(world.rank());
    count_ = cut(world.rank() + 1) - first_;
    for (std::int64_t l = 0; l < count_; ++l) {
      const std::int64_t odd = (first_ + l) % 2;
      connectivity_.push_back(2 * l + odd);
      connectivity_.push_back(2 * l + 1 - odd);
    }
  }

  void move_to(long step) { step_ = step; }
  void break_connectivity() {
    if (!connectivity_.empty()) connectivity_.back() = 2 * count_;
  }
  long step() const override { return step_; }
  double time_s() const override { return 1e-3 * static_cast<double>(step_); }
  std::span<const FieldInfo> fields() const override { return infos; }
  std::span<const std::int64_t> connectivity() override { return connectivity_; }
  /// The same at all steps.
  FieldView positions() override { return values_of({"position", "m", 3}, 0); }
  FieldView field(std::string_view name) override {
    for (const FieldInfo& info : infos) {
      if (info.name == name) return values_of(info, step_);
    }
    throw std::out_of_range("no field " + std::string(name));
  }
  std::vector<Annotation> annotations() const override {
    return {{"inflow", "m3/s", 100.0 + static_cast<double>(step_)}, {"vessels", "1", 34359738366.0}};
  }

  static constexpr std::array<FieldInfo, 4> infos = {
      FieldInfo{"pressure", "Pa", 1, Centring::point}, FieldInfo{"velocity", "m/s", 3, Centring::point},
      FieldInfo{"flow", "m3/s", 1, Centring::cell}, FieldInfo{"direction", "1", 3, Centring::cell}};

 private:
  FieldView values_of(const FieldInfo& info, long step) {
    const std::int64_t each = info.centring == Centring::point ? 2 : 1;
    FieldView view{.info = info, .count = static_cast<std::size_t>(each * count_)};
    for (int c = 0; c < info.components; ++c) {
      std::vector<double>& values = storage_[std::string(info.name) + std::to_string(c)];
      values.clear();
      for (std::int64_t id = each * first_; id < each * (first_ + count_); ++id) {
        values.push_back(expected_value(info.name, c, id, step));
      }
      view.component[static_cast<std::size_t>(c)] = values.data();
    }
    return view;
  }

  std::int64_t first_ = 0, count_ = 0;
  long step_;
  std::vector<std::int64_t> connectivity_;
  std::map<std::string, std::vector<double>> storage_;
};

}  // namespace rhexis::test
