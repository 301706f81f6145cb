// SPDX-License-Identifier: BSD-3-Clause
#include "output/field_series.hpp"

#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "output/disk_space.hpp"
#include "output/series_file.hpp"
#include "output/vtkhdf_series.hpp"
#include "output/xdmf_series.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {

SeriesPlan named(SeriesPlan plan, const std::string& basename) {
  if (plan.basename.empty()) plan.basename = basename;
  return plan;
}

std::vector<std::string> series_files(const std::string& basename, const std::vector<SeriesFormat>& formats) {
  std::vector<std::string> names;
  for (const SeriesFormat format : formats) {
    if (format == SeriesFormat::vtkhdf)
      names.push_back(basename + ".vtkhdf");
    else
      names.insert(names.end(), {basename + ".h5", basename + ".xdmf"});
  }
  return names;
}

std::vector<StoredField> stored(const std::vector<FieldInfo>& fields) {
  std::vector<StoredField> result;
  for (const FieldInfo& field : fields)
    result.push_back({std::string(field.name), std::string(field.unit), field.components, field.centring});
  return result;
}

FieldSeries::FieldSeries(const SeriesPlan& plan, const SeriesLayout& layout, std::vector<StoredField> fields,
                         const std::string& extension, parallel::Communicator communicator)
    : fields_(std::move(fields)),
      planned_(plan.steps.begin(), plan.steps.end()),
      file_(std::make_unique<SeriesFile>(plan.directory / (plan.basename + extension), plan.precision, layout,
                                         communicator)) {}

FieldSeries::~FieldSeries() = default;

void FieldSeries::write_positions(const FieldView& values) {
  file_->write(fixed_positions(), [&] { return values; });
}

void FieldSeries::write_connectivity(const std::vector<std::int64_t>& ends) {
  file_->write(connectivity(), ends);
}

void FieldSeries::write(const SeriesStep& moment,
                        const std::function<FieldView(const StoredField&)>& view_of) {
  finish();
  const bool planned = planned_.erase(moment.step) > 0;
  if (!planned && unplanned_) {
    if (*unplanned_ + 1 != entries_) throw std::logic_error("only the last step can be displaced");
    take_off_last();
  }
  std::vector<Place> places;
  for (const StoredField& field : fields_) places.push_back(place_of(field, moment.step, planned, entries_));
  file_->reserve(places);
  for (std::size_t i = 0; i < fields_.size(); ++i)
    file_->write(places[i], [&] { return view_of(fields_[i]); });
  // Waiting for the disk takes no processor, so the run goes on meanwhile.
  parallel::together<RunError>(file_->communicator(), [&] {
    const std::function<void()> list =
        file_->communicator().is_root() ? prepare(moment, planned, entries_) : std::function<void()>();
    saving_ = std::async(std::launch::async, [path = file_->path(), list] {
      sync_to_disk(path);
      if (list) list();
      return static_cast<bool>(list);
    });
  });
  if (!planned) unplanned_ = entries_;
  ++entries_;
  if (!planned || planned_.empty()) wait_for_disk();
}

void FieldSeries::take_off_last() {
  --entries_;
  parallel::on_root<RunError>(file_->communicator(), [&] { unlist(entries_); });
}

void FieldSeries::wait_for_disk() {
  bool listed_here = false;
  try {
    parallel::together<RunError>(file_->communicator(), [&] {
      if (saving_.valid()) listed_here = saving_.get();
    });
  } catch (const RunError&) {
    --entries_;
    try {
      if (listed_here) unlist(entries_);
    } catch (const RunError&) {  // the first reason says more
    }
    throw;
  }
}

std::vector<std::unique_ptr<FieldSeries>> open_series(const SeriesPlan& plan, const SeriesLayout& layout,
                                                      SeriesKind kind, std::vector<StoredField> fields,
                                                      parallel::Communicator communicator) {
  std::vector<std::unique_ptr<FieldSeries>> series;
  for (const SeriesFormat format : plan.formats) {
    if (format == SeriesFormat::xdmf)
      series.push_back(std::make_unique<XdmfSeries>(plan, layout, kind, fields, communicator));
    else
      series.push_back(std::make_unique<VtkHdfSeries>(plan, layout, kind, fields, communicator));
  }
  return series;
}

}  // namespace rhexis::output
