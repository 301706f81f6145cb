// SPDX-License-Identifier: BSD-3-Clause
#include "output/series_file.hpp"

#include <fmt/format.h>

#include <numeric>
#include <stdexcept>
#include <utility>

#include "core/error.hpp"
#include "output/disk_space.hpp"
#include "output/temporary_file.hpp"
#include "parallel/threads.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

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

/// A message about a file that was to get another name, which is the one that users know.
std::string with_name(std::string message, const std::filesystem::path& temporary,
                      const std::filesystem::path& name) {
  const std::size_t at = message.find(temporary.string());
  return at == std::string::npos ? message : message.replace(at, temporary.string().size(), name.string());
}

}  // namespace

std::vector<std::int64_t> numbers_of(const IdRanges& ids) {
  std::vector<std::int64_t> numbers(static_cast<std::size_t>(ids.local_count()));
  auto next = numbers.begin();
  for (const IdRange& range : ids.ranges) {
    std::iota(next, next + range.count, range.first);
    next += range.count;
  }
  return numbers;
}

SeriesFile::SeriesFile(std::filesystem::path path, Precision precision, const SeriesLayout& layout,
                       parallel::Communicator communicator)
    : path_(std::move(path)), precision_(precision), layout_(layout), communicator_(communicator) {}

void SeriesFile::create(std::size_t datasets, const std::function<void(Hdf5File&)>& lay_out,
                        const std::function<void(const std::filesystem::path&)>& finish) {
  parallel::on_root<RunError>(communicator_, [&] {
    TemporaryFile file(path_);
    try {
      change_structure(file.name(), Hdf5File::Mode::create, datasets, lay_out);
      finish(file.name());
      sync_to_disk(file.name());
    } catch (const std::exception& error) {
      throw RunError(with_name(error.what(), file.name(), path_));
    }
    file.put_in_place();
    identity_.emplace(path_);
  });
  parallel::together<RunError>(communicator_, [&] {
    file_ = std::make_unique<Hdf5File>(path_, Hdf5File::Mode::modify, communicator_);
  });
}

Slab SeriesFile::slab_of(const Place& place) const {
  Slab slab = output::slab_of(layout_.of(place.centring), place.components);
  const hsize_t flat = place.flat ? static_cast<hsize_t>(place.components) : 1;
  if (place.flat) slab.dimensions = 1;
  if (place.rows > 0) slab.shape[0] = static_cast<hsize_t>(place.rows);
  slab.shape[0] *= flat;
  for (Slab::Blocks& part : slab.parts) {
    part.start[0] = (part.start[0] + static_cast<hsize_t>(place.first_row)) * flat;
    part.stride[0] *= flat;
    part.block[0] *= flat;
  }
  return slab;
}

void SeriesFile::lay_out_reals(Hdf5File& file, const Place& place) const {
  lay_out(file, place, precision_ == Precision::single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE);
}

void SeriesFile::lay_out(Hdf5File& file, const Place& place, hid_t type) const {
  file.create_dataset(place.dataset, type, slab_of(place));
}

void SeriesFile::reserve(const std::vector<Place>& places) {
  std::vector<ByteRange> ranges;
  parallel::together<RunError>(communicator_, [&] {
    for (const Place& place : places) {
      const std::int64_t count = layout_.of(place.centring).global_count;
      const ByteRange all = file_->bytes_of(place.dataset);
      const std::int64_t row = all.count / (place.rows > 0 ? place.rows : count);
      ranges.push_back({all.offset + place.first_row * row, count * row});
    }
  });
  parallel::on_root<RunError>(communicator_, [&] {
    identity_->require_unchanged();
    reserve_space(path_, ranges);
  });
}

const void* SeriesFile::packed(const FieldView& view, const Place& place) {
  const auto count = static_cast<std::size_t>(layout_.of(place.centring).local_count());
  if (view.count != count || view.info.components != place.components) {
    throw std::logic_error(fmt::format("{}: {} values of {} components given, {} of {} laid out",
                                       view.info.name, view.count, view.info.components, count,
                                       place.components));
  }
  const std::size_t values = count * static_cast<std::size_t>(place.components);
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

void SeriesFile::write(const Place& place, const std::function<FieldView()>& view) {
  const hid_t type = precision_ == Precision::single_precision ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE;
  const void* values = nullptr;
  parallel::together<RunError>(communicator_, [&] { values = packed(view(), place); });
  parallel::together<RunError>(communicator_,
                               [&] { file_->write(place.dataset, type, slab_of(place), values); });
}

void SeriesFile::write(const Place& place, const std::vector<std::int64_t>& values) {
  parallel::together<RunError>(
      communicator_, [&] { file_->write(place.dataset, H5T_NATIVE_INT64, slab_of(place), values.data()); });
}

}  // namespace rhexis::output
