// SPDX-License-Identifier: BSD-3-Clause
#include "output/line_series.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <numeric>
#include <stdexcept>

#include "core/error.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

/// `mine` of this rank's items in a row of all ranks' items.
IdRanges in_rank_order(std::size_t mine, const parallel::Communicator& communicator) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(communicator.size()), 0);
  const auto own = counts.begin() + communicator.rank();
  *own = static_cast<std::int64_t>(mine);
  communicator.all_reduce(std::span<std::int64_t>(counts), parallel::Reduce::sum);
  IdRanges ids{.global_count = std::accumulate(counts.begin(), counts.end(), std::int64_t{0})};
  ids.add({std::accumulate(counts.begin(), own, std::int64_t{0}), *own});
  return ids;
}

SeriesLayout layout_of(LineSource& source, const parallel::Communicator& communicator) {
  std::size_t points = 0, ends = 0;
  parallel::together<RunError>(communicator, [&] {
    points = source.positions().count;
    ends = source.connectivity().size();
  });
  const SeriesLayout layout = {in_rank_order(points, communicator), in_rank_order(ends / 2, communicator)};
  if (layout.cells.global_count == 0) throw RunError("there are no lines to store");
  return layout;
}

SeriesPlan with_annotations(SeriesPlan plan, const LineSource& source) {
  plan.annotations.clear();
  for (const Annotation& note : source.annotations()) plan.annotations.emplace_back(note.name);
  return plan;
}

/// The source's connectivity in the numbering of all ranks.
std::vector<std::int64_t> global_ends(LineSource& source, const IdRanges& points) {
  const std::int64_t first = points.ranges.empty() ? 0 : points.ranges.front().first;
  const std::span<const std::int64_t> local = source.connectivity();
  std::vector<std::int64_t> ends(local.begin(), local.end());
  for (std::int64_t& end : ends) {
    if (end < 0 || end >= points.local_count()) {
      throw std::logic_error(fmt::format("a line ends at point {} of {}", end, points.local_count()));
    }
    end += first;
  }
  return ends;
}

}  // namespace

LineSeries::LineSeries(const LineSeriesPlan& plan, LineSource& source, parallel::Communicator communicator) {
  const SeriesLayout layout = layout_of(source, communicator);
  formats_ = open_series(named(with_annotations(plan, source), "network"), layout, SeriesKind::lines,
                         stored(plan.fields), communicator);
  std::vector<std::int64_t> ends;
  parallel::together<RunError>(communicator, [&] { ends = global_ends(source, layout.points); });
  for (const auto& series : formats_) {
    series->write_connectivity(ends);
    series->write_positions(source.positions());
  }
}

void LineSeries::write(LineSource& source) {
  for (const auto& series : formats_) {
    series->write(series_step(source), [&](const StoredField& field) { return source.field(field.name); });
  }
}

}  // namespace rhexis::output
