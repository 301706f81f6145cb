// SPDX-License-Identifier: BSD-3-Clause
#include "output/point_series.hpp"

namespace rhexis::output {
namespace {

std::vector<StoredField> with_position(const std::vector<FieldInfo>& fields) {
  std::vector<StoredField> all = {{position_field, "m", 3, Centring::point}};
  const std::vector<StoredField> others = stored(fields);
  all.insert(all.end(), others.begin(), others.end());
  return all;
}

}  // namespace

PointSeries::PointSeries(const PointSeriesPlan& plan, const IdRanges& points,
                         parallel::Communicator communicator)
    : formats_(open_series(named(plan, "particles"), {.points = points, .cells = points}, SeriesKind::points,
                           with_position(plan.fields), communicator)) {}

void PointSeries::write_reference(const FieldView& undeformed_positions) {
  for (const auto& series : formats_) series->write_positions(undeformed_positions);
}

void PointSeries::write(PointSource& source) {
  for (const auto& series : formats_) {
    series->write(series_step(source), [&](const StoredField& field) {
      return field.name == position_field ? source.positions() : source.field(field.name);
    });
  }
}

void PointSeries::finish() {
  for (const auto& series : formats_) series->finish();
}

}  // namespace rhexis::output
