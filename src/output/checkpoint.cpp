// SPDX-License-Identifier: BSD-3-Clause
#include "output/checkpoint.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "output/checksum.hpp"
#include "output/disk_space.hpp"
#include "output/hdf5_file.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* format_name = "format";
constexpr std::string_view format_prefix = "rhexis checkpoint ";
constexpr const char* format_text = "rhexis checkpoint 6";
constexpr const char* version_name = "program_version";
constexpr const char* checksum_name = "checksum";  ///< attribute with the checksum of all other attributes

std::string checksum_name_of(const std::string& dataset) {
  return "checksum_of_" + dataset;
}

/// Checksum of names and values, in the order of the names.
std::uint64_t checksum_of(const CheckpointNumbers& numbers) {
  std::string text;
  for (const auto& [name, value] : numbers) {
    if (name == checksum_name) continue;
    text += name + '=';
    if (const auto* real = std::get_if<double>(&value)) {
      text += fmt::format("{:016x} real", std::bit_cast<std::uint64_t>(*real));
    } else {
      std::visit([&](const auto& held) { text += fmt::format("{}", held); }, value);
    }
    text += '\n';
  }
  return checksum(text);
}

/// All elements of a list, or none.
IdRanges elements_of(std::size_t size, bool all) {
  IdRanges elements{.global_count = static_cast<std::int64_t>(size)};
  if (all) elements.add({0, elements.global_count});
  return elements;
}

Slab slab_of_list(std::size_t size, bool all) {
  return slab_of(elements_of(size, all), 1);
}

std::uint64_t checksum_of_list(const std::string& name, std::span<const double> list) {
  return checksum(TablePart{.rows = elements_of(list.size(), true)}, list, checksum(name));
}

std::uint64_t over_ranks(const parallel::Communicator& communicator, std::uint64_t sum) {
  communicator.all_reduce({&sum, 1}, parallel::Reduce::sum);
  return sum;
}

/// Why the file cannot be opened, where that is not for HDF5 to say; else nothing.
std::string obstacle(const std::filesystem::path& path) {
  std::error_code error;
  const std::filesystem::file_status status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) return "there is no such file";
  return std::filesystem::is_regular_file(status) ? "" : "it is not a file";
}

}  // namespace

CheckpointWriter::CheckpointWriter(std::filesystem::path path, const std::string& program_version,
                                   parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  numbers_[format_name] = format_text;
  numbers_[version_name] = program_version;
  std::string name;
  parallel::on_root<RunError>(communicator_, [&] {
    file_ = std::make_unique<TemporaryFile>(path_);
    name = file_->name().string();
  });
  temporary_ = communicator_.broadcast(name);
  parallel::on_root<RunError>(communicator_, [&] {
    change_structure(temporary_, Hdf5File::Mode::create_checked, 0, [](Hdf5File&) {});
  });
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::write(const std::string& name, const IdRanges& ids, std::span<const double> values) {
  assert(static_cast<std::int64_t>(values.size()) == ids.local_count());
  write_array(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, slab_of(ids, 1), values.data());
  note_checksum(name, checksum(TablePart{.rows = ids}, values, checksum(name)));
}

void CheckpointWriter::write(const std::string& name, const TablePart& part,
                             std::span<const std::uint16_t> values) {
  assert(static_cast<std::int64_t>(values.size()) == part.local_count());
  write_array(name, H5T_STD_U16LE, H5T_NATIVE_UINT16, slab_of(part), values.data());
  note_checksum(name, checksum(part, values, checksum(name)));
}

void CheckpointWriter::write(const std::string& name, const std::string& text) {
  // With its terminating zero: HDF5 has no place for nothing.
  write_array(name, H5T_STD_U8LE, H5T_NATIVE_UINT8, slab_of_list(text.size() + 1, communicator_.is_root()),
              text.c_str());
  note_checksum(name, communicator_.is_root() ? checksum(text, checksum(name)) : 0);
}

void CheckpointWriter::write(const std::string& name, std::span<const double> list) {
  const bool is_root = communicator_.is_root();
  write_array(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, slab_of_list(list.size(), is_root), list.data());
  note_checksum(name, is_root ? checksum_of_list(name, list) : 0);
}

void CheckpointWriter::note_checksum(const std::string& name, std::uint64_t of_this_rank) {
  numbers_[checksum_name_of(name)] = over_ranks(communicator_, of_this_rank);
}

void CheckpointWriter::close() {
  numbers_[checksum_name] = checksum_of(numbers_);
  lay_out(0, [&](Hdf5File& file) {
    for (const auto& [name, value] : numbers_) file.write_attribute("/", name, value);
  });
  parallel::together<RunError>(communicator_, [&] { sync_to_disk(temporary_); });
  parallel::on_root<RunError>(communicator_, [&] { file_->put_in_place(); });
}

void CheckpointWriter::lay_out(std::size_t datasets, const std::function<void(Hdf5File&)>& change) {
  parallel::on_root<RunError>(
      communicator_, [&] { change_structure(temporary_, Hdf5File::Mode::modify_checked, datasets, change); });
}

void CheckpointWriter::write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                                   const Slab& slab, const void* values) {
  lay_out(1, [&](Hdf5File& file) {
    file.create_dataset(name, file_type, slab);
    const ByteRange bytes = file.bytes_of(name);
    reserve_space(temporary_, {&bytes, 1});
  });
  std::unique_ptr<Hdf5File> file;
  parallel::together<RunError>(communicator_, [&] {
    file = std::make_unique<Hdf5File>(temporary_, Hdf5File::Mode::modify_checked, communicator_);
  });
  parallel::together<RunError>(communicator_, [&] { file->write(name, memory_type, slab, values); });
}

CheckpointReader::CheckpointReader(std::filesystem::path path, parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  parallel::on_root<InputError>(communicator_, [&] {
    if (const std::string why_not = obstacle(path_); !why_not.empty()) refuse("cannot open: " + why_not);
  });
  parallel::together<InputError>(communicator_, [&] {
    try {
      file_ = std::make_unique<Hdf5File>(path_, Hdf5File::Mode::read, communicator_);
    } catch (const std::runtime_error& error) {
      throw InputError(std::string(error.what()) + "; a checkpoint that is damaged or cut short?");
    }
  });
  parallel::together<InputError>(communicator_, [&] { read_numbers(); });
}

CheckpointReader::~CheckpointReader() = default;

void CheckpointReader::refuse(const std::string& reason) const {
  throw InputError(fmt::format("{}: {}", path_.string(), reason));
}

void CheckpointReader::require_this_format() const {
  constexpr const char* none =
      "not a checkpoint of Rhexis: its attribute 'format' is missing or says something else";
  if (!file_->has_attribute("/", format_name)) refuse(none);
  const AttributeValue value = file_->read_attribute("/", format_name);
  const auto* format = std::get_if<std::string>(&value);
  if (format == nullptr || !format->starts_with(format_prefix)) refuse(none);
  if (*format == format_text) return;
  std::string writer = "an earlier version";
  if (file_->has_attribute("/", version_name)) {
    const AttributeValue version = file_->read_attribute("/", version_name);
    if (const auto* text = std::get_if<std::string>(&version)) writer = "version " + *text;
  }
  refuse(
      fmt::format("a checkpoint of format {}, which {} of Rhexis wrote; this one reads format {} alone: "
                  "go on with that version, or start anew",
                  format->substr(format_prefix.size()), writer,
                  std::string_view(format_text).substr(format_prefix.size())));
}

void CheckpointReader::read_numbers() {
  require_this_format();
  for (const std::string& name : file_->attribute_names("/"))
    numbers_[name] = file_->read_attribute("/", name);
  const auto stored = numbers_.find(checksum_name);
  if (stored == numbers_.end() || stored->second != CheckpointNumbers::mapped_type(checksum_of(numbers_)))
    refuse("the checkpoint is damaged: its numbers do not have their checksum");
}

bool CheckpointReader::holds(const std::string& name) const {
  return numbers_.contains(name) || numbers_.contains(checksum_name_of(name));
}

void CheckpointReader::compare_checksum(const std::string& name, std::uint64_t of_all_ranks) const {
  const auto stored = numbers_.find(checksum_name_of(name));
  if (stored != numbers_.end() && stored->second == CheckpointNumbers::mapped_type(of_all_ranks)) return;
  refuse(fmt::format("the checkpoint is damaged: '{}' does not have its checksum", name));
}

void CheckpointReader::read_array(const std::string& name, std::int64_t memory_type, const Slab& slab,
                                  void* values) const {
  parallel::together<InputError>(communicator_, [&] {
    const std::vector<hsize_t> stored = file_->shape(name, memory_type), expected = slab.extent();
    if (stored != expected)
      refuse(fmt::format("'{}' holds {} values, but this run has {}", name, fmt::join(stored, " x "),
                         fmt::join(expected, " x ")));
  });
  parallel::together<InputError>(communicator_, [&] { file_->read(name, memory_type, slab, values); });
}

void CheckpointReader::read(const std::string& name, const IdRanges& ids, std::span<double> values) {
  assert(static_cast<std::int64_t>(values.size()) == ids.local_count());
  read_array(name, H5T_NATIVE_DOUBLE, slab_of(ids, 1), values.data());
  compare_checksum(
      name, over_ranks(communicator_,
                       checksum(TablePart{.rows = ids}, std::span<const double>(values), checksum(name))));
  parallel::together<InputError>(communicator_, [&] {
    if (!std::ranges::all_of(values, [](double value) { return std::isfinite(value); }))
      refuse(fmt::format("'{}' holds values that are not finite", name));
  });
}

void CheckpointReader::read(const std::string& name, const TablePart& part, std::span<std::uint16_t> values) {
  assert(static_cast<std::int64_t>(values.size()) == part.local_count());
  read_array(name, H5T_NATIVE_UINT16, slab_of(part), values.data());
  compare_checksum(name, over_ranks(communicator_,
                                    checksum(part, std::span<const std::uint16_t>(values), checksum(name))));
}

void CheckpointReader::read(const std::string& name, std::string& text) {
  parallel::together<InputError>(communicator_, [&] {
    const std::vector<hsize_t> stored = file_->shape(name, H5T_NATIVE_UINT8);
    if (stored.size() != 1 || stored[0] == 0 || stored[0] > std::filesystem::file_size(path_))
      refuse(fmt::format("'{}' is not a text that fits into the file", name));
    text.resize(stored[0]);
  });
  read_array(name, H5T_NATIVE_UINT8, slab_of_list(text.size(), true), text.data());
  parallel::together<InputError>(communicator_, [&] {
    text.pop_back();
    compare_checksum(name, checksum(text, checksum(name)));
  });
}

void CheckpointReader::read(const std::string& name, std::span<double> list, double least, double most) {
  read_array(name, H5T_NATIVE_DOUBLE, slab_of_list(list.size(), true), list.data());
  parallel::together<InputError>(communicator_, [&] {
    compare_checksum(name, checksum_of_list(name, list));
    for (const double value : list)
      if (!std::isnan(value)) require_range(name, value, least, most);
  });
}

template <class Value>
void CheckpointReader::require_range(const std::string& name, Value value, double least, double most) const {
  const auto real = static_cast<double>(value);
  if (!std::isfinite(real) || real < least || real > most)
    refuse(fmt::format("'{}' is {}, which makes no sense ({:.6g} to {:.6g} does)", name, value, least, most));
}

template <class Number>
Number CheckpointReader::number(const std::string& name, double least, double most) const {
  const auto found = numbers_.find(name);
  if (found == numbers_.end()) refuse(fmt::format("it does not hold '{}'", name));
  const auto* value = std::get_if<Number>(&found->second);
  if (value == nullptr) refuse(fmt::format("'{}' is a number of another kind", name));
  require_range(name, *value, least, most);
  return *value;
}

void CheckpointReader::read(const std::string& name, std::int64_t& value, double least, double most) {
  value = number<std::int64_t>(name, least, most);
}

void CheckpointReader::read(const std::string& name, double& value, double least, double most) {
  value = number<double>(name, least, most);
}

void CheckpointReader::read(const std::string& name, std::optional<double>& value, double least,
                            double most) {
  value.reset();
  if (numbers_.contains(name)) value = number<double>(name, least, most);
}

void CheckpointReader::read(const std::string& name, bool& flag) {
  flag = number<std::int64_t>(name, 0, 1) != 0;
}

}  // namespace rhexis::output
