#include "output/point_series.hpp"

#include <fmt/format.h>

#include <cstdint>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/disk_space.hpp"
#include "output/hdf5_file.hpp"
#include "output/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* position = "position";
constexpr const char* unplanned_place = "unplanned";

std::string dataset_name(const std::string& field, const std::string& place) {
  return "/" + field + "/" + place;
}

/// Structure of arrays to array of structures, in the precision of the file.
template <class Real>
void interleave(const FieldView& view, Real* out) {
  const auto width = static_cast<std::size_t>(view.info.components);
  for (std::size_t c = 0; c < width; ++c) {
    const double* values = view.component[c];
    for (std::size_t i = 0; i < view.count; ++i) out[i * width + c] = static_cast<Real>(values[i]);
  }
}

}  // namespace

PointSeries::PointSeries(const PointSeriesPlan& plan, const PointLayout& layout,
                         parallel::Communicator communicator)
    : layout_(layout),
      fields_{{position, "m", 3}},
      precision_(plan.precision),
      xdmf_path_(plan.directory / (plan.basename + ".xdmf")),
      hdf5_name_(plan.basename + ".h5"),
      communicator_(communicator) {
  for (const FieldInfo& field : plan.fields) {
    fields_.push_back({std::string(field.name), std::string(field.unit), field.components});
  }
  for (const long step : plan.steps) planned_places_[step] = fmt::format("{:06}", step);
  const std::filesystem::path path = plan.directory / hdf5_name_;
  on_root<RunError>(communicator_, [&] {
    const std::size_t datasets = fields_.size() * (planned_places_.size() + 1) + 2;
    change_structure(path, Hdf5File::Mode::create, datasets, [&](Hdf5File& file) { lay_out(file, plan); });
    sync_to_disk(path);
  });
  together<RunError>(communicator_, [&] {
    file_ = std::make_unique<Hdf5File>(path, Hdf5File::Mode::modify, communicator_);
  });
  reserve({"/connectivity", "/reference_position"});
  together<RunError>(communicator_, [&] { write_connectivity(); });
}

PointSeries::~PointSeries() = default;

void PointSeries::lay_out(Hdf5File& file, const PointSeriesPlan& plan) const {
  const hid_t type = precision_ == Precision::single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  file.write_text("/", "title", plan.title);
  file.write_text("/", "version", plan.version);
  for (const StoredField& field : fields_) {
    const Slab slab = slab_of(layout_, field.components);
    file.create_group("/" + field.name);
    file.write_text("/" + field.name, "unit", field.unit);
    for (const auto& [step, place] : planned_places_) {
      file.create_dataset(dataset_name(field.name, place), type, slab);
    }
    file.create_dataset(dataset_name(field.name, unplanned_place), type, slab);
  }
  file.create_dataset("/reference_position", type, slab_of(layout_, 3));
  file.write_text("/reference_position", "unit", "m");
  file.create_dataset("/connectivity", H5T_STD_I64LE, slab_of(layout_, 1));
}

void PointSeries::write_connectivity() {
  std::vector<std::int64_t> ids(static_cast<std::size_t>(layout_.local_count()));
  for (std::int64_t c = 0; c < layout_.column_count; ++c) {
    const auto column = ids.begin() + c * layout_.row_count;
    std::iota(column, column + layout_.row_count,
              (layout_.first_column + c) * layout_.rows + layout_.first_row);
  }
  file_->write("/connectivity", H5T_NATIVE_INT64, slab_of(layout_, 1), ids.data());
}

const void* PointSeries::packed(const FieldView& view, int components) {
  const auto count = static_cast<std::size_t>(layout_.local_count());
  if (view.count != count || view.info.components != components) {
    throw std::logic_error(fmt::format("{}: {} points of {} components given, {} of {} laid out",
                                       view.info.name, view.count, view.info.components, count, components));
  }
  const std::size_t values = count * static_cast<std::size_t>(components);
  // Converted here, because a conversion by HDF5 would make the write independent instead of collective.
  if (precision_ == Precision::single_precision) {
    singles_.resize(values);
    interleave(view, singles_.data());
    return singles_.data();
  }
  doubles_.resize(values);
  interleave(view, doubles_.data());
  return doubles_.data();
}

void PointSeries::write_values(const std::string& dataset, int components,
                               const std::function<FieldView()>& view) {
  const hid_t type = precision_ == Precision::single_precision ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  const void* values = nullptr;
  together<RunError>(communicator_, [&] { values = packed(view(), components); });
  together<RunError>(communicator_,
                     [&] { file_->write(dataset, type, slab_of(layout_, components), values); });
}

void PointSeries::write_reference(const FieldView& undeformed_positions) {
  write_values("/reference_position", 3, [&] { return undeformed_positions; });
}

void PointSeries::write(PointSource& source) {
  const auto planned = planned_places_.find(source.step());
  const std::string place = planned == planned_places_.end() ? unplanned_place : planned->second;
  if (std::erase_if(listed_, [&](const ListedStep& step) { return step.place == place; }) > 0) write_xdmf();

  std::vector<std::string> datasets;
  for (const StoredField& field : fields_) datasets.push_back(dataset_name(field.name, place));
  reserve(datasets);
  for (const StoredField& field : fields_) {
    write_values(dataset_name(field.name, place), field.components,
                 [&] { return field.name == position ? source.positions() : source.field(field.name); });
  }
  together<RunError>(communicator_, [&] { sync_to_disk(file_->path()); });

  listed_.push_back({place, xdmf_grid(source, place)});
  write_xdmf();
}

void PointSeries::reserve(const std::vector<std::string>& datasets) {
  std::vector<ByteRange> ranges;
  together<RunError>(communicator_, [&] {
    for (const std::string& dataset : datasets) ranges.push_back(file_->bytes_of(dataset));
  });
  on_root<RunError>(communicator_, [&] { reserve_space(file_->path(), ranges); });
}

std::string PointSeries::xdmf_grid(const PointSource& source, const std::string& place) const {
  const std::int64_t points = layout_.global_count();
  const int bytes = precision_ == Precision::single_precision ? 4 : 8;
  const auto values_of = [&](const StoredField& field) {
    return fmt::format(
        R"(<DataItem Dimensions="{}{}" NumberType="Float" Precision="{}" Format="HDF">{}:{}</DataItem>)",
        points, field.components == 3 ? " 3" : "", bytes, hdf5_name_, dataset_name(field.name, place));
  };
  // The Xdmf3 readers show no cells unless the topology lists its points.
  std::string grid = fmt::format(
      R"(      <Grid Name="particles" GridType="Uniform">
        <Time Value="{}"/>
        <Topology TopologyType="Polyvertex" NumberOfElements="{}" NodesPerElement="1">
          <DataItem Dimensions="{}" NumberType="Int" Precision="8" Format="HDF">{}:/connectivity</DataItem>
        </Topology>
        <Geometry GeometryType="XYZ">{}</Geometry>
)",
      source.time_s(), points, points, hdf5_name_, values_of(fields_.front()));
  for (const StoredField& field : std::span(fields_).subspan(1)) {
    grid +=
        fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n",
                    field.name, field.components == 3 ? "Vector" : "Scalar", values_of(field));
  }
  for (const Annotation& note : source.annotations()) {
    grid += fmt::format(
        R"(        <Attribute Name="{}" AttributeType="Scalar" Center="Grid">
          <DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">{}</DataItem>
        </Attribute>
)",
        note.name, note.value);
  }
  return grid + "      </Grid>\n";
}

void PointSeries::write_xdmf() const {
  on_root<RunError>(communicator_, [&] {
    std::string text =
        R"(<?xml version="1.0"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="particles" GridType="Collection" CollectionType="Temporal">
)";
    for (const ListedStep& step : listed_) text += step.grid;
    write_atomically(xdmf_path_, text + "    </Grid>\n  </Domain>\n</Xdmf>\n");
  });
}

}  // namespace rhexis::output
