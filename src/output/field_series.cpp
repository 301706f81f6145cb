#include "output/field_series.hpp"

#include <fmt/format.h>

#include <iterator>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "output/atomic_file.hpp"
#include "output/disk_space.hpp"
#include "output/hdf5_file.hpp"
#include "output/temporary_file.hpp"
#include "parallel/threads.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* unplanned_place = "unplanned";

/// Structure of arrays to array of structures, in the precision of the file.
template <class Real>
void interleave(const FieldView& view, Real* out) {
  const auto width = static_cast<std::size_t>(view.info.components);
  const auto part = [&](int, std::size_t begin, std::size_t end) {
    for (std::size_t c = 0; c < width; ++c) {
      const double* values = view.component[c];
      for (std::size_t i = begin; i < end; ++i) out[i * width + c] = static_cast<Real>(values[i]);
    }
  };
  parallel::for_each_share(parallel::thread_count(), view.count, part);
}

std::string xdmf_item(std::int64_t rows, int components, const char* type, int bytes,
                      const std::string& place) {
  const std::string width = components == 1 ? "" : fmt::format(" {}", components);
  return fmt::format(
      R"(<DataItem Dimensions="{}{}" NumberType="{}" Precision="{}" Format="HDF">{}</DataItem>)", rows, width,
      type, bytes, place);
}

}  // namespace

std::string dataset_name(const std::string& field, const std::string& place) {
  return "/" + field + "/" + place;
}

SeriesPlan named(SeriesPlan plan, const std::string& basename) {
  if (plan.basename.empty()) plan.basename = basename;
  return plan;
}

FieldSeries::FieldSeries(const SeriesPlan& plan, const SeriesLayout& layout, std::vector<StoredField> fields,
                         std::vector<FixedDataset> fixed, parallel::Communicator communicator)
    : layout_(layout),
      fields_(std::move(fields)),
      precision_(plan.precision),
      basename_(plan.basename),
      xdmf_path_(plan.directory / (plan.basename + ".xdmf")),
      hdf5_name_(plan.basename + ".h5"),
      communicator_(communicator) {
  for (const FixedDataset& dataset : fixed) fixed_[dataset.name] = dataset;
  for (const long step : plan.steps) planned_places_[step] = fmt::format("{:06}", step);
  const std::filesystem::path path = plan.directory / hdf5_name_;
  parallel::on_root<RunError>(communicator_, [&] {
    const std::size_t datasets = fields_.size() * (planned_places_.size() + 1) + fixed.size();
    TemporaryFile file(path);
    change_structure(file.name(), Hdf5File::Mode::create, datasets,
                     [&](Hdf5File& laid_out) { lay_out(laid_out, plan, fixed); });
    sync_to_disk(file.name());
    file.put_in_place();
  });
  parallel::together<RunError>(communicator_, [&] {
    file_ = std::make_unique<Hdf5File>(path, Hdf5File::Mode::modify, communicator_);
  });
  std::vector<std::string> names;
  for (const FixedDataset& dataset : fixed) names.push_back(dataset.name);
  reserve(names);
}

FieldSeries::~FieldSeries() = default;

void FieldSeries::lay_out(Hdf5File& file, const SeriesPlan& plan,
                          const std::vector<FixedDataset>& fixed) const {
  const hid_t type = precision_ == Precision::single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  file.write_text("/", "title", plan.title);
  file.write_text("/", "version", plan.version);
  for (const StoredField& field : fields_) {
    const Slab slab = slab_of(layout_.of(field.centring), field.components);
    file.create_group("/" + field.name);
    file.write_text("/" + field.name, "unit", field.unit);
    for (const auto& [step, place] : planned_places_) {
      file.create_dataset(dataset_name(field.name, place), type, slab);
    }
    file.create_dataset(dataset_name(field.name, unplanned_place), type, slab);
  }
  for (const FixedDataset& dataset : fixed) {
    file.create_dataset(dataset.name, dataset.type == FixedDataset::Type::integer ? H5T_STD_I64LE : type,
                        slab_of(layout_.of(dataset.centring), dataset.components));
    if (!dataset.unit.empty()) file.write_text(dataset.name, "unit", dataset.unit);
  }
}

const void* FieldSeries::packed(const FieldView& view, int components, Centring centring) {
  const auto count = static_cast<std::size_t>(layout_.of(centring).local_count());
  if (view.count != count || view.info.components != components) {
    throw std::logic_error(fmt::format("{}: {} values of {} components given, {} of {} laid out",
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

void FieldSeries::write_values(const std::string& dataset, int components, Centring centring,
                               const std::function<FieldView()>& view) {
  const hid_t type = precision_ == Precision::single_precision ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  const void* values = nullptr;
  parallel::together<RunError>(communicator_, [&] { values = packed(view(), components, centring); });
  parallel::together<RunError>(
      communicator_, [&] { file_->write(dataset, type, slab_of(layout_.of(centring), components), values); });
}

void FieldSeries::write_fixed(const std::string& name, const FieldView& values) {
  const FixedDataset& dataset = fixed_.at(name);
  write_values(name, dataset.components, dataset.centring, [&] { return values; });
}

void FieldSeries::write_fixed(const std::string& name, const std::vector<std::int64_t>& values) {
  const FixedDataset& dataset = fixed_.at(name);
  parallel::together<RunError>(communicator_, [&] {
    file_->write(name, H5T_NATIVE_INT64, slab_of(layout_.of(dataset.centring), dataset.components),
                 values.data());
  });
}

void FieldSeries::write(long step, const std::function<FieldView(const StoredField&)>& view_of,
                        const std::function<std::string(const std::string& place)>& grid_of) {
  const auto planned = planned_places_.find(step);
  const std::string place = planned == planned_places_.end() ? unplanned_place : planned->second;
  finish();
  if (std::erase_if(listed_, [&](const ListedStep& other) { return other.place == place; }) > 0) write_xdmf();

  std::vector<std::string> datasets;
  for (const StoredField& field : fields_) datasets.push_back(dataset_name(field.name, place));
  reserve(datasets);
  for (const StoredField& field : fields_) {
    write_values(dataset_name(field.name, place), field.components, field.centring,
                 [&] { return view_of(field); });
  }
  listed_.push_back({place, grid_of(place)});
  // Waiting for the disk takes no processor, so the run goes on meanwhile.
  parallel::together<RunError>(communicator_, [&] {
    saving_ = std::async(std::launch::async, [file = file_->path(), list = xdmf_path_,
                                              text = communicator_.is_root() ? xdmf() : ""] {
      sync_to_disk(file);
      if (!text.empty()) write_atomically(list, text);
    });
  });
  const bool more_to_come = planned != planned_places_.end() && std::next(planned) != planned_places_.end();
  if (!more_to_come) finish();
}

void FieldSeries::finish() {
  try {
    parallel::together<RunError>(communicator_, [&] {
      if (saving_.valid()) saving_.get();
    });
  } catch (const RunError&) {
    listed_.pop_back();
    try {
      write_xdmf();
    } catch (const RunError&) {  // the first reason says more
    }
    throw;
  }
}

void FieldSeries::reserve(const std::vector<std::string>& datasets) {
  std::vector<ByteRange> ranges;
  parallel::together<RunError>(communicator_, [&] {
    for (const std::string& dataset : datasets) ranges.push_back(file_->bytes_of(dataset));
  });
  parallel::on_root<RunError>(communicator_, [&] { reserve_space(file_->path(), ranges); });
}

std::string FieldSeries::xdmf_reals(const std::string& dataset, int components, Centring centring) const {
  return xdmf_item(layout_.of(centring).global_count(), components, "Float",
                   precision_ == Precision::single_precision ? 4 : 8, hdf5_name_ + ":" + dataset);
}

std::string FieldSeries::xdmf_integers(const std::string& dataset, int components, Centring centring) const {
  return xdmf_item(layout_.of(centring).global_count(), components, "Int", 8, hdf5_name_ + ":" + dataset);
}

std::string FieldSeries::xdmf_attributes(const std::string& place, const std::string& without) const {
  std::string text;
  for (const StoredField& field : fields_) {
    if (field.name == without) continue;
    text += fmt::format("        <Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"{}\">{}</Attribute>\n",
                        field.name, field.components == 3 ? "Vector" : "Scalar",
                        field.centring == Centring::point ? "Node" : "Cell",
                        xdmf_reals(dataset_name(field.name, place), field.components, field.centring));
  }
  return text;
}

std::string FieldSeries::xdmf_annotations(const std::vector<Annotation>& annotations) {
  std::string text;
  for (const Annotation& note : annotations) {
    text += fmt::format(
        R"(        <Attribute Name="{}" AttributeType="Scalar" Center="Grid">
          <DataItem Dimensions="1" NumberType="Float" Precision="8" Format="XML">{}</DataItem>
        </Attribute>
)",
        note.name, note.value);
  }
  return text;
}

std::string FieldSeries::xdmf() const {
  std::string text = fmt::format(
      R"(<?xml version="1.0"?>
<Xdmf Version="3.0">
  <Domain>
    <Grid Name="{}" GridType="Collection" CollectionType="Temporal">
)",
      basename_);
  for (const ListedStep& step : listed_) text += step.grid;
  return text + "    </Grid>\n  </Domain>\n</Xdmf>\n";
}

void FieldSeries::write_xdmf() const {
  parallel::on_root<RunError>(communicator_, [&] { write_atomically(xdmf_path_, xdmf()); });
}

}  // namespace rhexis::output
