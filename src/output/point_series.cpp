#include "output/point_series.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <numeric>

namespace rhexis::output {
namespace {

constexpr const char* position = "position";

std::vector<StoredField> with_position(const std::vector<FieldInfo>& fields) {
  std::vector<StoredField> stored = {{position, "m", 3, Centring::point}};
  for (const FieldInfo& field : fields) {
    stored.push_back({std::string(field.name), std::string(field.unit), field.components, Centring::point});
  }
  return stored;
}

/// The global numbers of this rank's points.
std::vector<std::int64_t> ids_of(const PointLayout& layout) {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(layout.local_count()));
  for (std::int64_t c = 0; c < layout.column_count; ++c) {
    const auto column = ids.begin() + c * layout.row_count;
    std::iota(column, column + layout.row_count, (layout.first_column + c) * layout.rows + layout.first_row);
  }
  return ids;
}

}  // namespace

PointSeries::PointSeries(const PointSeriesPlan& plan, const PointLayout& layout,
                         parallel::Communicator communicator)
    : layout_(layout),
      series_(named(plan, "particles"), {.points = layout, .cells = layout}, with_position(plan.fields),
              {{.name = "/reference_position", .unit = "m", .components = 3},
               {.name = "/connectivity", .type = FixedDataset::Type::integer}},
              communicator) {
  series_.write_fixed("/connectivity", ids_of(layout));
}

void PointSeries::write_reference(const FieldView& undeformed_positions) {
  series_.write_fixed("/reference_position", undeformed_positions);
}

void PointSeries::write(PointSource& source) {
  series_.write(
      source.step(),
      [&](const StoredField& field) {
        return field.name == position ? source.positions() : source.field(field.name);
      },
      [&](const std::string& place) { return xdmf_grid(source, place); });
}

std::string PointSeries::xdmf_grid(const PointSource& source, const std::string& place) const {
  // The Xdmf3 readers show no cells unless the topology lists its points.
  return fmt::format(
             R"(      <Grid Name="particles" GridType="Uniform">
        <Time Value="{}"/>
        <Information Name="step" Value="{}"/>
        <Topology TopologyType="Polyvertex" NumberOfElements="{}" NodesPerElement="1">
          {}
        </Topology>
        <Geometry GeometryType="XYZ">{}</Geometry>
)",
             source.time_s(), source.step(), layout_.global_count(),
             series_.xdmf_integers("/connectivity", 1, Centring::point),
             series_.xdmf_reals(dataset_name(position, place), 3, Centring::point)) +
         series_.xdmf_attributes(place, position) + FieldSeries::xdmf_annotations(source.annotations()) +
         "      </Grid>\n";
}

}  // namespace rhexis::output
