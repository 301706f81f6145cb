// SPDX-License-Identifier: BSD-3-Clause
/// A body whose values tell field, component, particle and step, divided among ranks in a chosen way.
#pragma once

#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::test {

/// Exact in single precision for the small bodies of the tests.
inline double expected_value(std::string_view field, int component, std::int64_t id, long step) {
  return static_cast<double>(field.size() * 4096 + static_cast<std::size_t>(component) * 1024) +
         static_cast<double>(id) + 0.25 * static_cast<double>(step % 4);
}

/// `column_parts` x (ranks / column_parts) blocks of uneven size; ranks beyond the blocks have nothing.
inline PointLayout divided(std::int64_t columns, std::int64_t rows, const parallel::Communicator& world,
                           int column_parts) {
  const int row_parts = std::max(1, world.size() / column_parts);
  PointLayout layout{.columns = columns, .rows = rows};
  if (world.rank() >= column_parts * row_parts) return layout;
  const auto cut = [](std::int64_t total, int part, int parts) {
    return total * part * part / (parts * parts);
  };
  const int c = world.rank() / row_parts, r = world.rank() % row_parts;
  layout.first_column = cut(columns, c, column_parts);
  layout.column_count = cut(columns, c + 1, column_parts) - layout.first_column;
  layout.first_row = cut(rows, r, row_parts);
  layout.row_count = cut(rows, r + 1, row_parts) - layout.first_row;
  return layout;
}

class SyntheticSource : public PointSource {
 public:
  SyntheticSource(const PointLayout& layout, long step) : layout_(layout), step_(step) {}

  void move_to(long step) { step_ = step; }
  long step() const override { return step_; }
  double time_s() const override { return 1e-3 * static_cast<double>(step_); }
  const PointLayout& layout() const override { return layout_; }
  std::span<const FieldInfo> fields() const override { return infos; }
  FieldView positions() override { return values_of({"position", "m", 3}); }
  FieldView field(std::string_view name) override {
    for (const FieldInfo& info : infos) {
      if (info.name == name) return values_of(info);
    }
    throw std::out_of_range("no field " + std::string(name));
  }
  std::vector<Annotation> annotations() const override {
    return {{"pressure", "Pa", 100.0 + static_cast<double>(step_)}};
  }

  static constexpr std::array<FieldInfo, 2> infos = {FieldInfo{"displacement", "m", 3},
                                                     FieldInfo{"damage", "1", 1}};

 private:
  FieldView values_of(const FieldInfo& info) {
    FieldView view{.info = info, .count = static_cast<std::size_t>(layout_.local_count())};
    for (int c = 0; c < info.components; ++c) {
      std::vector<double>& values = storage_[std::string(info.name) + std::to_string(c)];
      values.clear();
      for (std::int64_t column = 0; column < layout_.column_count; ++column) {
        for (std::int64_t row = 0; row < layout_.row_count; ++row) {
          const std::int64_t id = (layout_.first_column + column) * layout_.rows + layout_.first_row + row;
          values.push_back(expected_value(info.name, c, id, step_));
        }
      }
      view.component[static_cast<std::size_t>(c)] = values.data();
    }
    return view;
  }

  PointLayout layout_;
  long step_;
  std::map<std::string, std::vector<double>> storage_;
};

}  // namespace rhexis::test
