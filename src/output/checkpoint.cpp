#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <cassert>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "output/disk_space.hpp"
#include "output/hdf5_file.hpp"
#include "output/temporary_file.hpp"
#include "parallel/together.hpp"

namespace rhexis::output {
namespace {

constexpr const char* format_attribute = "format";
constexpr const char* format_text = "rhexis checkpoint 4";

Slab slab_of(const WordBlock& block) {
  const auto size = [](std::int64_t value) { return static_cast<hsize_t>(value); };
  return {.dimensions = 2,
          .shape = {size(block.rows), size(block.words)},
          .start = {size(block.first_row), size(block.first_word)},
          .stride = {1, 1},
          .count = {size(block.row_count), size(block.word_count)},
          .block = {1, 1}};
}

/// All of them, or none.
Slab slab_of_bytes(std::size_t size, bool all) {
  const auto bytes = static_cast<hsize_t>(size);
  return {.dimensions = 1,
          .shape = {bytes},
          .start = {0},
          .stride = {1},
          .count = {all ? bytes : 0},
          .block = {1}};
}

void read_array(const Hdf5File& file, const parallel::Communicator& communicator, const std::string& name,
                hid_t memory_type, const Slab& slab, void* values) {
  parallel::together<InputError>(communicator, [&] {
    const std::vector<hsize_t> stored = file.shape(name), expected = slab.extent();
    if (stored == expected) return;
    throw InputError(fmt::format("{}: '{}' holds {} values, but this run has {}", file.path().string(), name,
                                 fmt::join(stored, " x "), fmt::join(expected, " x ")));
  });
  parallel::together<InputError>(communicator, [&] { file.read(name, memory_type, slab, values); });
}

}  // namespace

CheckpointWriter::CheckpointWriter(std::filesystem::path path, parallel::Communicator communicator)
    : path_(std::move(path)), communicator_(communicator) {
  std::string name;
  parallel::on_root<RunError>(communicator_, [&] {
    file_ = std::make_unique<TemporaryFile>(path_);
    name = file_->name().string();
  });
  temporary_ = communicator_.broadcast(name);
  parallel::on_root<RunError>(communicator_, [&] {
    change_structure(temporary_, Hdf5File::Mode::create, 0,
                     [](Hdf5File& file) { file.write_text("/", format_attribute, format_text); });
  });
}

CheckpointWriter::~CheckpointWriter() = default;

void CheckpointWriter::write(const std::string& name, const PointLayout& layout,
                             std::span<const double> values) {
  assert(static_cast<std::int64_t>(values.size()) == layout.local_count());
  write_array(name, H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, slab_of(layout, 1), values.data());
}

void CheckpointWriter::write(const std::string& name, const WordBlock& block,
                             std::span<const std::uint16_t> values) {
  assert(static_cast<std::int64_t>(values.size()) == block.local_count());
  write_array(name, H5T_STD_U16LE, H5T_NATIVE_UINT16, slab_of(block), values.data());
}

void CheckpointWriter::write(const std::string& name, std::int64_t value) {
  lay_out([&](Hdf5File& file) { file.write_attribute("/", name, H5T_NATIVE_INT64, &value); });
}

void CheckpointWriter::write(const std::string& name, double value) {
  lay_out([&](Hdf5File& file) { file.write_attribute("/", name, H5T_NATIVE_DOUBLE, &value); });
}

void CheckpointWriter::write(const std::string& name, const std::string& text) {
  // With its terminating zero: HDF5 has no place for nothing.
  write_array(name, H5T_STD_U8LE, H5T_NATIVE_UINT8, slab_of_bytes(text.size() + 1, communicator_.is_root()),
              text.c_str());
}

void CheckpointWriter::close() {
  parallel::together<RunError>(communicator_, [&] { sync_to_disk(temporary_); });
  parallel::on_root<RunError>(communicator_, [&] { file_->put_in_place(); });
}

void CheckpointWriter::lay_out(const std::function<void(Hdf5File&)>& change) {
  parallel::on_root<RunError>(communicator_,
                              [&] { change_structure(temporary_, Hdf5File::Mode::modify, 1, change); });
}

void CheckpointWriter::write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                                   const Slab& slab, const void* values) {
  lay_out([&](Hdf5File& file) {
    file.create_dataset(name, file_type, slab);
    const ByteRange bytes = file.bytes_of(name);
    reserve_space(temporary_, {&bytes, 1});
  });
  std::unique_ptr<Hdf5File> file;
  parallel::together<RunError>(communicator_, [&] {
    file = std::make_unique<Hdf5File>(temporary_, Hdf5File::Mode::modify, communicator_);
  });
  parallel::together<RunError>(communicator_, [&] { file->write(name, memory_type, slab, values); });
}

CheckpointReader::CheckpointReader(std::filesystem::path path, parallel::Communicator communicator)
    : communicator_(communicator) {
  parallel::on_root<InputError>(communicator_, [&] {
    const std::string why_not = !std::filesystem::exists(path)            ? "there is no such file"
                                : !std::filesystem::is_regular_file(path) ? "it is not a file"
                                                                          : "";
    if (!why_not.empty()) throw InputError(fmt::format("{}: cannot open: {}", path.string(), why_not));
  });
  parallel::together<InputError>(
      communicator_, [&] { file_ = std::make_unique<Hdf5File>(path, Hdf5File::Mode::read, communicator_); });
  parallel::together<InputError>(communicator_, [&] {
    if (file_->has_attribute("/", format_attribute) && file_->read_text("/", format_attribute) == format_text)
      return;
    throw InputError(fmt::format("{}: not a checkpoint of this version of Rhexis", path.string()));
  });
}

CheckpointReader::~CheckpointReader() = default;

void CheckpointReader::read(const std::string& name, const PointLayout& layout, std::span<double> values) {
  assert(static_cast<std::int64_t>(values.size()) == layout.local_count());
  read_array(*file_, communicator_, name, H5T_NATIVE_DOUBLE, slab_of(layout, 1), values.data());
}

void CheckpointReader::read(const std::string& name, const WordBlock& block,
                            std::span<std::uint16_t> values) {
  assert(static_cast<std::int64_t>(values.size()) == block.local_count());
  read_array(*file_, communicator_, name, H5T_NATIVE_UINT16, slab_of(block), values.data());
}

void CheckpointReader::read(const std::string& name, std::int64_t& value) {
  parallel::together<InputError>(communicator_,
                                 [&] { file_->read_attribute("/", name, H5T_NATIVE_INT64, &value); });
}

void CheckpointReader::read(const std::string& name, double& value) {
  parallel::together<InputError>(communicator_,
                                 [&] { file_->read_attribute("/", name, H5T_NATIVE_DOUBLE, &value); });
}

void CheckpointReader::read(const std::string& name, std::string& text) {
  parallel::together<InputError>(communicator_, [&] { text.resize(file_->shape(name).at(0)); });
  read_array(*file_, communicator_, name, H5T_NATIVE_UINT8, slab_of_bytes(text.size(), true), text.data());
  if (!text.empty()) text.pop_back();
}

}  // namespace rhexis::output
