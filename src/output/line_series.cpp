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
PointLayout in_rank_order(std::size_t mine, const parallel::Communicator& communicator) {
  std::vector<std::int64_t> counts(static_cast<std::size_t>(communicator.size()), 0);
  const auto own = counts.begin() + communicator.rank();
  *own = static_cast<std::int64_t>(mine);
  communicator.all_reduce(std::span<std::int64_t>(counts), parallel::Reduce::sum);
  return {.columns = 1,
          .rows = std::accumulate(counts.begin(), counts.end(), std::int64_t{0}),
          .first_column = 0,
          .column_count = 1,
          .first_row = std::accumulate(counts.begin(), own, std::int64_t{0}),
          .row_count = *own};
}

SeriesLayout layout_of(LineSource& source, const parallel::Communicator& communicator) {
  std::size_t points = 0, ends = 0;
  parallel::together<RunError>(communicator, [&] {
    points = source.positions().count;
    ends = source.connectivity().size();
  });
  const SeriesLayout layout = {in_rank_order(points, communicator), in_rank_order(ends / 2, communicator)};
  if (layout.cells.rows == 0) throw RunError("there are no lines to store");
  return layout;
}

std::vector<StoredField> stored(const std::vector<FieldInfo>& fields) {
  std::vector<StoredField> result;
  for (const FieldInfo& field : fields) {
    result.push_back({std::string(field.name), std::string(field.unit), field.components, field.centring});
  }
  return result;
}

/// The source's connectivity in the numbering of all ranks.
std::vector<std::int64_t> global_ends(LineSource& source, const PointLayout& points) {
  const std::span<const std::int64_t> local = source.connectivity();
  std::vector<std::int64_t> ends(local.begin(), local.end());
  for (std::int64_t& end : ends) {
    if (end < 0 || end >= points.row_count) {
      throw std::logic_error(fmt::format("a line ends at point {} of {}", end, points.row_count));
    }
    end += points.first_row;
  }
  return ends;
}

}  // namespace

LineSeries::LineSeries(const LineSeriesPlan& plan, LineSource& source, parallel::Communicator communicator)
    : layout_(layout_of(source, communicator)),
      series_(named(plan, "network"), layout_, stored(plan.fields),
              {{.name = "/position", .unit = "m", .components = 3},
               {.name = "/connectivity",
                .type = FixedDataset::Type::integer,
                .components = 2,
                .centring = Centring::cell}},
              communicator) {
  std::vector<std::int64_t> ends;
  parallel::together<RunError>(communicator, [&] { ends = global_ends(source, layout_.points); });
  series_.write_fixed("/connectivity", ends);
  series_.write_fixed("/position", source.positions());
}

void LineSeries::write(LineSource& source) {
  series_.write(
      source.step(), [&](const StoredField& field) { return source.field(field.name); },
      [&](const std::string& place) { return xdmf_grid(source, place); });
}

std::string LineSeries::xdmf_grid(const LineSource& source, const std::string& place) const {
  return fmt::format(
             R"(      <Grid Name="network" GridType="Uniform">
        <Time Value="{}"/>
        <Information Name="step" Value="{}"/>
        <Topology TopologyType="Polyline" NumberOfElements="{}" NodesPerElement="2">
          {}
        </Topology>
        <Geometry GeometryType="XYZ">{}</Geometry>
)",
             source.time_s(), source.step(), layout_.cells.global_count(),
             series_.xdmf_integers("/connectivity", 2, Centring::cell),
             series_.xdmf_reals("/position", 3, Centring::point)) +
         series_.xdmf_attributes(place, "") + FieldSeries::xdmf_annotations(source.annotations()) +
         "      </Grid>\n";
}

}  // namespace rhexis::output
