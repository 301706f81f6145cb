// SPDX-License-Identifier: BSD-3-Clause
/// A body whose values tell field, component, particle and step, divided among ranks in a chosen way.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::test {

/// Exact in single precision for the small bodies of the tests.
inline double expected_value(std::string_view field, int component, std::int64_t id, long step) {
  return static_cast<double>(field.size() * 4096 + static_cast<std::size_t>(component) * 1024) +
         static_cast<double>(id) + 0.25 * static_cast<double>(step % 4);
}

/// A table of `rows` x `columns` divided into `row_parts` x (ranks / row_parts) blocks of uneven size; ranks
/// beyond the blocks have nothing.
inline TablePart divided_table(std::int64_t rows, std::int64_t columns, const parallel::Communicator& world,
                               int row_parts) {
  const int column_parts = std::max(1, world.size() / row_parts);
  TablePart part{.rows = {.global_count = rows}, .width = columns, .count = 0};
  if (world.rank() >= row_parts * column_parts) return part;
  const auto cut = [](std::int64_t total, int of, int parts) { return total * of * of / (parts * parts); };
  const int r = world.rank() / column_parts, c = world.rank() % column_parts;
  const std::int64_t first_row = cut(rows, r, row_parts);
  part.rows.add({first_row, cut(rows, r + 1, row_parts) - first_row});
  part.first = cut(columns, c, column_parts);
  part.count = cut(columns, c + 1, column_parts) - part.first;
  return part;
}

/// The numbers of such a table's cells, row after row, divided like it.
inline IdRanges divided(std::int64_t rows, std::int64_t columns, const parallel::Communicator& world,
                        int row_parts) {
  const TablePart part = divided_table(rows, columns, world, row_parts);
  IdRanges ids{.global_count = rows * columns};
  for (const IdRange& range : part.rows.ranges) {
    for (std::int64_t row = range.first; row < range.first + range.count; ++row)
      ids.add({row * columns + part.first, part.count});
  }
  return ids;
}

/// Ranges of all lengths with gaps between them, as of particles along a curve through space.
inline IdRanges dealt_out(std::int64_t count, const parallel::Communicator& world) {
  IdRanges ids{.global_count = count};
  std::int64_t first = 0;
  for (std::int64_t deal = 0; first < count; ++deal) {
    const std::int64_t length = std::min(1 + deal * deal % 7, count - first);
    if (deal % world.size() == world.rank()) ids.add({first, length});
    first += length;
  }
  return ids;
}

class SyntheticSource : public PointSource {
 public:
  SyntheticSource(IdRanges ids, long step) : ids_(std::move(ids)), step_(step) {}

  void move_to(long step) { step_ = step; }
  long step() const override { return step_; }
  double time_s() const override { return 1e-3 * static_cast<double>(step_); }
  const IdRanges& ids() const override { return ids_; }
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
    FieldView view{.info = info, .count = static_cast<std::size_t>(ids_.local_count())};
    for (int c = 0; c < info.components; ++c) {
      std::vector<double>& values = storage_[std::string(info.name) + std::to_string(c)];
      values.clear();
      for (const IdRange& range : ids_.ranges) {
        for (std::int64_t id = range.first; id < range.first + range.count; ++id)
          values.push_back(expected_value(info.name, c, id, step_));
      }
      view.component[static_cast<std::size_t>(c)] = values.data();
    }
    return view;
  }

  IdRanges ids_;
  long step_;
  std::map<std::string, std::vector<double>> storage_;
};

}  // namespace rhexis::test
