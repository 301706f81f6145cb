// SPDX-License-Identifier: BSD-3-Clause
#include "output/xdmf_series.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "output/series_file.hpp"
#include "output/xdmf_list.hpp"

namespace rhexis::output {
namespace {

std::string dataset_name(const std::string& field, long step, bool planned) {
  return planned ? fmt::format("/{}/{:06}", field, step) : fmt::format("/{}/unplanned", field);
}

/// The moment whose text is the longest among those with these annotations.
SeriesStep longest(SeriesStep moment) {
  constexpr double most_digits = -2.2250738585072014e-308;
  moment.step = std::numeric_limits<long>::lowest();
  moment.time_s = most_digits;
  for (Annotation& note : moment.annotations) note.value = most_digits;
  return moment;
}

}  // namespace

XdmfSeries::XdmfSeries(const SeriesPlan& plan, const SeriesLayout& layout, SeriesKind kind,
                       std::vector<StoredField> fields, parallel::Communicator communicator)
    : FieldSeries(plan, layout, std::move(fields), ".h5", communicator),
      kind_(kind),
      basename_(plan.basename),
      list_path_(plan.directory / (plan.basename + ".xdmf")) {
  file().create(this->fields().size() * (planned().size() + 1) + 2, [&](Hdf5File& h5) {
    h5.write_text("/", "title", plan.title);
    h5.write_text("/", "version", plan.version);
    for (const StoredField& field : this->fields()) {
      h5.create_group("/" + field.name);
      h5.write_text("/" + field.name, "unit", field.unit);
      for (const long step : planned()) file().lay_out_reals(h5, place_of(field, step, true, 0));
      file().lay_out_reals(h5, place_of(field, 0, false, 0));
    }
    file().lay_out_reals(h5, fixed_positions());
    h5.write_text(fixed_positions().dataset, "unit", "m");
    file().lay_out(h5, connectivity(), H5T_STD_I64LE);
  });
  file().reserve({fixed_positions(), connectivity()});
  if (kind_ == SeriesKind::points) file().write(connectivity(), numbers_of(layout.points));
}

Place XdmfSeries::fixed_positions() const {
  return {kind_ == SeriesKind::points ? "/reference_position" : "/position", 3};
}

Place XdmfSeries::connectivity() const {
  return {"/connectivity", kind_ == SeriesKind::points ? 1 : 2, Centring::cell};
}

Place XdmfSeries::place_of(const StoredField& field, long step, bool planned, std::size_t) const {
  return {dataset_name(field.name, step, planned), field.components, field.centring};
}

std::function<void()> XdmfSeries::prepare(const SeriesStep& moment, bool planned, std::size_t) {
  if (!list_) start_list(moment);
  return [list = list_, text = grid(moment, planned)] { list->add(text); };
}

void XdmfSeries::unlist(std::size_t) {
  list_->remove_last();
}

void XdmfSeries::start_list(const SeriesStep& moment) {
  const std::string head = fmt::format(
      R"(<?xml version="1.0"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="{}" GridType="Collection" CollectionType="Temporal">
)",
      basename_);
  list_ = std::make_shared<XdmfList>(list_path_, head, "    </Grid>\n  </Domain>\n</Xdmf>\n",
                                     grid(longest(moment), true).size());
}

std::string XdmfSeries::item(const Place& place, const char* type, int bytes) const {
  const std::string width = place.components == 1 ? "" : fmt::format(" {}", place.components);
  return fmt::format(
      R"(<DataItem Dimensions="{}{}" NumberType="{}" Precision="{}" Format="HDF">{}.h5:{}</DataItem>)",
      file().layout().of(place.centring).global_count, width, type, bytes, basename_, place.dataset);
}

std::string XdmfSeries::reals(const Place& place) const {
  return item(place, "Float", file().bytes_of_real());
}

std::string XdmfSeries::grid(const SeriesStep& moment, bool planned) const {
  const bool points = kind_ == SeriesKind::points;
  // The Xdmf3 readers show no cells unless the topology lists its points.
  std::string text = fmt::format(
      R"(      <Grid Name="{}" GridType="Uniform">
        <Time Value="{}"/>
        <Information Name="step" Value="{}"/>
        <Topology TopologyType="{}" NumberOfElements="{}" NodesPerElement="{}">
          {}
        </Topology>
)",
      points ? "particles" : "network", moment.time_s, moment.step, points ? "Polyvertex" : "Polyline",
      file().layout().cells.global_count, points ? 1 : 2, item(connectivity(), "Int", 8));
  if (!points)
    text += fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n", reals(fixed_positions()));
  for (const StoredField& field : fields()) {
    const std::string values = reals(place_of(field, moment.step, planned, 0));
    text += points && field.name == position_field
                ? fmt::format("        <Geometry GeometryType=\"XYZ\">{}</Geometry>\n", values)
                : fmt::format(
                      "        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                      field.name, field.components == 3 ? "Vector" : "Scalar",
                      field.centring == Centring::point ? "Node" : "Cell", values);
  }
  for (const Annotation& note : moment.annotations) {
    text += fmt::format(
        R"(        <Attribute Name="{}" AttributeType="Scalar" Center="Grid">
          <DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">{}</DataItem>
        </Attribute>
)",
        note.name, note.value);
  }
  return text + "      </Grid>\n";
}

}  // namespace rhexis::output
