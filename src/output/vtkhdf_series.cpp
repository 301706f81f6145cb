// SPDX-License-Identifier: BSD-3-Clause
#include "output/vtkhdf_series.hpp"

#include <fmt/format.h>

#include <bit>
#include <cstring>
#include <fstream>
#include <utility>

#include "core/error.hpp"
#include "output/disk_space.hpp"
#include "output/series_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* step_number = "step";
constexpr const char* times = "/VTKHDF/Steps/Values";

std::string annotation_dataset(const std::string& name) {
  return "/VTKHDF/FieldData/" + name;
}

/// NSteps of a file that is being made; nobody takes it for a number of steps.
constexpr std::int64_t not_yet = -0x52686578'6973'4e53;

static_assert(std::endian::native == std::endian::little, "what is written beside HDF5 is little-endian");

/// The number as it lies in memory, and in the file.
template <class Number>
std::string_view bytes_of(const Number& value) {
  return {reinterpret_cast<const char*>(&value), sizeof(value)};
}

/// Finds the numbers of steps in a file that was just laid out for `room` steps: NSteps, and behind it the
/// extent of Values, now and at most (a dataspace message of one dimension), and the address of its values (a
/// layout message, of contiguous data).
VtkHdfSeries::StepCounts find_step_counts(const std::filesystem::path& path, std::int64_t room) {
  constexpr std::size_t page = 4096;
  std::string beginning(page, '\0');
  std::ifstream(path, std::ios::binary).read(beginning.data(), page);
  const std::string extent =
      std::string("\1\1\1\0\0\0\0\0", 8) + std::string(bytes_of(room)) + std::string(bytes_of(room));
  const std::string contiguous("\3\1", 2);  // version and class of the layout; then come address and size
  const std::int64_t size = room * static_cast<std::int64_t>(sizeof(double));
  std::int64_t address = 0;
  const std::size_t first = beginning.find(bytes_of(not_yet));
  const std::size_t dataspace = beginning.find(extent, first);
  std::size_t layout = beginning.find(contiguous, dataspace);
  while (layout < page && beginning.compare(layout + 2 + sizeof(address), sizeof(size), bytes_of(size)) != 0)
    layout = beginning.find(contiguous, layout + 1);
  if (layout >= page)
    throw RunError(
        fmt::format("{}: HDF5 has not put the numbers of steps into the first page", path.string()));
  const std::size_t end = layout + 2 + sizeof(address);
  std::memcpy(&address, beginning.data() + end - sizeof(address), sizeof(address));
  return {.at = static_cast<std::int64_t>(first),
          .bytes = beginning.substr(first, end - first),
          .extent = dataspace + 8 - first,
          .values_at = address};
}

/// All of a data set, [rows] or [rows, columns].
Slab whole(std::int64_t rows, int columns = 1) {
  IdRanges all{.global_count = rows};
  all.add({0, rows});
  return slab_of(all, columns);
}

/// Creates and fills a table of integers, [rows] or [rows, columns].
void write_table(Hdf5File& h5, const std::string& name, std::int64_t rows, std::int64_t columns,
                 const std::function<std::int64_t(std::int64_t row)>& value) {
  const Slab all = whole(rows, static_cast<int>(columns));
  std::vector<std::int64_t> values;
  for (std::int64_t row = 0; row < rows; ++row)
    values.insert(values.end(), static_cast<std::size_t>(columns), value(row));
  h5.create_dataset(name, H5T_STD_I64LE, all);
  if (rows > 0) h5.write(name, H5T_NATIVE_INT64, all, values.data());
}

void write_number(Hdf5File& h5, const std::string& name, std::int64_t number) {
  write_table(h5, name, 1, 1, [&](std::int64_t) { return number; });
}

}  // namespace

VtkHdfSeries::VtkHdfSeries(const SeriesPlan& plan, const SeriesLayout& layout, SeriesKind kind,
                           std::vector<StoredField> fields, parallel::Communicator communicator)
    : FieldSeries(plan, layout, std::move(fields), ".vtkhdf", communicator),
      kind_(kind),
      room_(static_cast<std::int64_t>(planned().size()) + 1),
      annotations_(plan.annotations) {
  annotations_.push_back(step_number);
  // There are fewer; but the tables of steps, some 30 numbers a step, need room too.
  const std::size_t datasets = 64 + 4 * this->fields().size() + static_cast<std::size_t>(room_) / 2;
  file().create(
      datasets, [&](Hdf5File& h5) { lay_out(h5, plan); },
      [&](const std::filesystem::path& path) {
        counts_ = find_step_counts(path, room_);
        FileInPlace(path).write(counts_.at, counts_of(0));
      });
  parallel::together<RunError>(communicator, [&] {
    numbers_at_[times] = counts_.values_at;
    for (const std::string& name : annotations_)
      numbers_at_[annotation_dataset(name)] = file().offset_of(annotation_dataset(name));
  });
  file().reserve({fixed_positions(), connectivity(), offsets()});
  write_offsets();
}

std::int64_t VtkHdfSeries::count(Centring centring) const {
  return file().layout().of(centring).global_count;
}

std::string VtkHdfSeries::dataset_of(const StoredField& field) const {
  if (kind_ == SeriesKind::points && field.name == position_field) return "/VTKHDF/Points";
  return (field.centring == Centring::point ? "/VTKHDF/PointData/" : "/VTKHDF/CellData/") + field.name;
}

Place VtkHdfSeries::fixed_positions() const {
  return {kind_ == SeriesKind::points ? "/VTKHDF/PointData/reference_position" : "/VTKHDF/Points", 3};
}

Place VtkHdfSeries::connectivity() const {
  return kind_ == SeriesKind::points ? Place{"/VTKHDF/Vertices/Connectivity", 1, Centring::cell}
                                     : Place{"/VTKHDF/Lines/Connectivity", 2, Centring::cell, 0, 0, true};
}

Place VtkHdfSeries::offsets() const {
  return {kind_ == SeriesKind::points ? "/VTKHDF/Vertices/Offsets" : "/VTKHDF/Lines/Offsets", 1,
          Centring::cell, count(Centring::cell) + 1};
}

Place VtkHdfSeries::place_of(const StoredField& field, long, bool, std::size_t entry) const {
  const std::int64_t n = count(field.centring);
  return {dataset_of(field), field.components, field.centring, room_ * n,
          static_cast<std::int64_t>(entry) * n};
}

void VtkHdfSeries::lay_out(Hdf5File& h5, const SeriesPlan& plan) const {
  h5.create_group("/VTKHDF");
  h5.create_group("/VTKHDF/Steps");
  h5.write_attribute("/VTKHDF/Steps", "NSteps", not_yet);
  h5.create_dataset(times, H5T_IEEE_F64LE, whole(room_));
  h5.write_numbers("/VTKHDF", "Version", {2, 2});
  h5.write_ascii("/VTKHDF", "Type", "PolyData");
  h5.write_text("/", "title", plan.title);
  h5.write_text("/", "version", plan.version);
  for (const char* group : {"PointData", "CellData", "FieldData"})
    h5.create_group(fmt::format("/VTKHDF/{}", group));
  lay_out_steps(h5);
  lay_out_cells(h5);
  file().lay_out_reals(h5, fixed_positions());
  h5.write_text(fixed_positions().dataset, "unit", "m");
  for (const StoredField& field : fields()) {
    file().lay_out_reals(h5, place_of(field, 0, true, 0));
    h5.write_text(dataset_of(field), "unit", field.unit);
  }
}

void VtkHdfSeries::lay_out_cells(Hdf5File& h5) const {
  const std::string ours = kind_ == SeriesKind::points ? "Vertices" : "Lines";
  write_number(h5, "/VTKHDF/NumberOfPoints", count(Centring::point));
  for (const std::string group : {"Vertices", "Lines", "Polygons", "Strips"}) {
    const std::string name = "/VTKHDF/" + group;
    h5.create_group(name);
    const std::int64_t cells = group == ours ? count(Centring::cell) : 0;
    const std::int64_t ends = cells * connectivity().components;
    write_number(h5, name + "/NumberOfCells", cells);
    write_number(h5, name + "/NumberOfConnectivityIds", ends);
    if (group == ours) {
      file().lay_out(h5, connectivity(), H5T_STD_I64LE);
      file().lay_out(h5, offsets(), H5T_STD_I64LE);
      const Slab last = slab_of({.global_count = cells + 1, .ranges = {{cells, 1}}},
                                1);  // the only one that belongs to no cell
      h5.write(offsets().dataset, H5T_NATIVE_INT64, last, &ends);
    } else {
      write_table(h5, name + "/Connectivity", 0, 1, {});
      write_number(h5, name + "/Offsets", 0);
    }
  }
}

void VtkHdfSeries::lay_out_steps(Hdf5File& h5) const {
  const auto table = [&](const std::string& name, std::int64_t columns, std::int64_t each_step,
                         std::int64_t first = 0) {
    write_table(h5, "/VTKHDF/Steps/" + name, room_, columns,
                [&](std::int64_t entry) { return first + entry * each_step; });
  };
  for (const char* group : {"PointDataOffsets", "CellDataOffsets", "FieldDataOffsets", "FieldDataSizes"})
    h5.create_group(fmt::format("/VTKHDF/Steps/{}", group));
  const bool moving = kind_ == SeriesKind::points;
  table("PartOffsets", 1, 0);
  table("NumberOfParts", 1, 0, 1);
  table("PointOffsets", 1, moving ? count(Centring::point) : 0);
  table("CellOffsets", 4, 0);  // of vertices, lines, polygons, strips
  table("ConnectivityIdOffsets", 4, 0);
  if (moving) table("PointDataOffsets/reference_position", 1, 0);
  for (const StoredField& field : fields()) {
    if (dataset_of(field) == "/VTKHDF/Points") continue;
    table((field.centring == Centring::point ? "PointDataOffsets/" : "CellDataOffsets/") + field.name, 1,
          count(field.centring));
  }
  for (const std::string& name : annotations_) {
    h5.create_dataset(annotation_dataset(name), name == step_number ? H5T_STD_I64LE : H5T_IEEE_F64LE,
                      whole(room_));
    table("FieldDataOffsets/" + name, 1, 1);
    table("FieldDataSizes/" + name, 2, 0, 1);  // one number of one component
  }
}

void VtkHdfSeries::write_offsets() {
  std::vector<std::int64_t> numbers = numbers_of(file().layout().cells);
  if (kind_ == SeriesKind::points) file().write(connectivity(), numbers);
  for (std::int64_t& number : numbers) number *= connectivity().components;
  file().write(offsets(), numbers);
}

std::function<void()> VtkHdfSeries::prepare(const SeriesStep& moment, bool, std::size_t entry) {
  const FileInPlace h5(file().path());
  const auto write = [&](const std::string& dataset, const auto& number) {
    h5.write(numbers_at_.at(dataset) + static_cast<std::int64_t>(entry * sizeof(number)), bytes_of(number));
  };
  write(times, moment.time_s);
  write(annotation_dataset(step_number), std::int64_t{moment.step});
  for (const Annotation& note : moment.annotations)
    write(annotation_dataset(std::string(note.name)), note.value);
  return [path = file().path(), at = counts_.at, bytes = counts_of(entry + 1)] {
    FileInPlace(path).write(at, bytes);
  };
}

void VtkHdfSeries::unlist(std::size_t entry) {
  FileInPlace(file().path()).write(counts_.at, counts_of(entry));
}

std::string VtkHdfSeries::counts_of(std::size_t steps) const {
  const auto number = static_cast<std::int64_t>(steps);
  // HDF5 1.14 refuses data of no size that have an address.
  const std::int64_t address = steps > 0 ? counts_.values_at : -1;
  std::string bytes = counts_.bytes;
  for (const std::size_t at : {std::size_t{0}, counts_.extent, counts_.extent + sizeof(number)})
    bytes.replace(at, sizeof(number), bytes_of(number));
  bytes.replace(bytes.size() - sizeof(address), sizeof(address), bytes_of(address));
  return bytes;
}

}  // namespace rhexis::output
