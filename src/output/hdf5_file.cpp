// SPDX-License-Identifier: BSD-3-Clause
#include "output/hdf5_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace rhexis::output {
namespace {

/// The innermost message on HDF5's error stack.
std::string reason() {
  std::string text;
  const auto first_message = [](unsigned, const H5E_error2_t* error, void* out) -> herr_t {
    auto& message = *static_cast<std::string*>(out);
    if (message.empty() && error->desc != nullptr) message = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, first_message, &text);
  return text.empty() ? "HDF5 gives no reason" : text;
}

Hdf5Handle text_type(std::size_t length) {
  // HDF5 has no strings of length 0; the terminating zero makes room for them.
  Hdf5Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  const bool succeeded =
      type >= 0 && H5Tset_size(type, length + 1) >= 0 && H5Tset_cset(type, H5T_CSET_UTF8) >= 0;
  return succeeded ? std::move(type) : Hdf5Handle{};
}

/// HDF5's types of the numbers that an attribute may be, in the order of AttributeValue.
constexpr std::array<hid_t (*)(), 3> number_types = {[]() -> hid_t { return H5T_NATIVE_INT64; },
                                                     []() -> hid_t { return H5T_NATIVE_UINT64; },
                                                     []() -> hid_t { return H5T_NATIVE_DOUBLE; }};

/// Attributes of HDF5 hold no more than this many bytes.
constexpr std::size_t longest_text = 1 << 16;

/// Where the value lies in memory.
template <class Value>
auto number_of(Value& value) {
  return std::visit(
      [](auto& held) {
        return static_cast<std::conditional_t<std::is_const_v<Value>, const void*, void*>>(&held);
      },
      value);
}

}  // namespace

Hdf5Handle::Hdf5Handle(Hdf5Handle&& other) noexcept
    : id_(std::exchange(other.id_, -1)), close_(other.close_) {}

Hdf5Handle& Hdf5Handle::operator=(Hdf5Handle&& other) noexcept {
  std::swap(id_, other.id_);
  std::swap(close_, other.close_);
  return *this;
}

bool Hdf5Handle::reset() {
  const hid_t id = std::exchange(id_, -1);
  return id < 0 || close_(id) >= 0;
}

Slab slab_of(const TablePart& part) {
  const auto size = [](std::int64_t value) { return static_cast<hsize_t>(value); };
  Slab slab{.dimensions = 2, .shape = {size(part.rows.global_count), size(part.width)}};
  if (part.count == 0) return slab;
  std::int64_t next = -1;  // where a range goes on with what is regular so far
  for (const IdRange& range : part.rows.ranges) {
    Slab::Blocks* const last = slab.parts.empty() ? nullptr : &slab.parts.back();
    const bool alike = last != nullptr && last->block[0] == size(range.count);
    if (alike && last->count[0] == 1) last->stride[0] = size(range.first) - last->start[0];
    if (alike && (last->count[0] == 1 || range.first == next)) {
      ++last->count[0];
    } else {
      slab.parts.push_back({.start = {size(range.first), size(part.first)},
                            .stride = {size(range.count), size(part.width)},
                            .count = {1, 1},
                            .block = {size(range.count), size(part.count)}});
    }
    next = range.first + static_cast<std::int64_t>(slab.parts.back().stride[0]);
  }
  return slab;
}

Slab slab_of(const IdRanges& ids, int components) {
  Slab slab = slab_of(TablePart{.rows = ids, .width = components, .count = components});
  if (components == 1) slab.dimensions = 1;
  return slab;
}

void Hdf5File::require(bool succeeded, std::string_view doing, std::string_view object) const {
  if (succeeded) return;
  throw std::runtime_error(fmt::format("{}: cannot {} {}: {}", path_.string(), doing, object, reason()));
}

void Hdf5File::refuse(const std::string& reason) const {
  throw std::runtime_error(fmt::format("{}: {}", path_.string(), reason));
}

Hdf5Handle Hdf5File::own(hid_t id, Hdf5Handle::Close closer, std::string_view doing,
                         std::string_view object) const {
  require(id >= 0, doing, object);
  return Hdf5Handle(id, closer);
}

Hdf5File::Hdf5File(std::filesystem::path path, Mode mode, const parallel::Communicator& communicator)
    : path_(std::move(path)) {
  // Its stack of reasons goes into our messages instead.
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle access = own(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "prepare", "the access");
  require(H5Pset_fapl_mpio(access, communicator.handle(), MPI_INFO_NULL) >= 0, "prepare", "the access");
  collective_ = own(H5Pcreate(H5P_DATASET_XFER), H5Pclose, "prepare", "the transfer");
  require(H5Pset_dxpl_mpio(collective_, H5FD_MPIO_COLLECTIVE) >= 0, "prepare", "the transfer");
  if (mode == Mode::create_checked || mode == Mode::modify_checked)
    require(H5Pset_libver_bounds(access, H5F_LIBVER_V18, H5F_LIBVER_V18) >= 0, "prepare", "the access");
  const std::string name = path_.string();
  if (mode == Mode::create || mode == Mode::create_checked) {
    file_ = own(H5Fcreate(name.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access), H5Fclose, "create", "the file");
  } else {
    const unsigned flags = mode == Mode::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR;
    file_ = own(H5Fopen(name.c_str(), flags, access), H5Fclose, "open", "the file");
  }
}

void Hdf5File::create_group(const std::string& name) {
  own(H5Gcreate2(file_, name.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, "create group", name);
}

void Hdf5File::create_dataset(const std::string& name, hid_t type, const Slab& slab) {
  const Hdf5Handle space =
      own(H5Screate_simple(slab.dimensions, slab.shape.data(), nullptr), H5Sclose, "describe", name);
  const Hdf5Handle layout = own(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "describe", name);
  // Without times, writing values touches no metadata; without filling, creating costs neither time nor disk.
  require(
      H5Pset_layout(layout, H5D_CONTIGUOUS) >= 0 && H5Pset_alloc_time(layout, H5D_ALLOC_TIME_EARLY) >= 0 &&
          H5Pset_fill_time(layout, H5D_FILL_TIME_NEVER) >= 0 && H5Pset_obj_track_times(layout, false) >= 0,
      "describe", name);
  own(H5Dcreate2(file_, name.c_str(), type, space, H5P_DEFAULT, layout, H5P_DEFAULT), H5Dclose,
      "create data set", name);
}

Hdf5Handle Hdf5File::open_dataset(const std::string& name) const {
  return own(H5Dopen2(file_, name.c_str(), H5P_DEFAULT), H5Dclose, "open data set", name);
}

Hdf5Handle Hdf5File::select(const Slab& slab, const std::string& name) const {
  Hdf5Handle space =
      own(H5Screate_simple(slab.dimensions, slab.shape.data(), nullptr), H5Sclose, "describe", name);
  bool selected = slab.parts.empty() ? H5Sselect_none(space) >= 0 : true;
  H5S_seloper_t how = H5S_SELECT_SET;
  for (const Slab::Blocks& part : slab.parts) {
    selected = selected && H5Sselect_hyperslab(space, how, part.start.data(), part.stride.data(),
                                               part.count.data(), part.block.data()) >= 0;
    how = H5S_SELECT_OR;
  }
  require(selected, "select this rank's part of", name);
  return space;
}

void Hdf5File::write(const std::string& name, hid_t memory_type, const Slab& slab, const void* values) {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle in_file = select(slab, name);
  const hsize_t count = static_cast<hsize_t>(H5Sget_select_npoints(in_file));
  const Hdf5Handle in_memory = own(H5Screate_simple(1, &count, nullptr), H5Sclose, "describe", name);
  require(H5Dwrite(dataset, memory_type, in_memory, in_file, collective_, values) >= 0, "write", name);
}

void Hdf5File::read(const std::string& name, hid_t memory_type, const Slab& slab, void* values) const {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle in_file = select(slab, name);
  const hsize_t count = static_cast<hsize_t>(H5Sget_select_npoints(in_file));
  const Hdf5Handle in_memory = own(H5Screate_simple(1, &count, nullptr), H5Sclose, "describe", name);
  require(H5Dread(dataset, memory_type, in_memory, in_file, collective_, values) >= 0, "read", name);
}

std::vector<hsize_t> Hdf5File::shape(const std::string& name, hid_t type) const {
  const Hdf5Handle dataset = open_dataset(name);
  const Hdf5Handle stored = own(H5Dget_type(dataset), H5Tclose, "read the type of", name);
  if (H5Tget_class(stored) != H5Tget_class(type) || H5Tget_size(stored) != H5Tget_size(type))
    refuse(fmt::format("data set {} holds values of another type", name));
  const Hdf5Handle space = own(H5Dget_space(dataset), H5Sclose, "read the shape of", name);
  std::vector<hsize_t> extent(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  require(H5Sget_simple_extent_dims(space, extent.data(), nullptr) >= 0, "read the shape of", name);
  return extent;
}

ByteRange Hdf5File::bytes_of(const std::string& name) const {
  const Hdf5Handle dataset = open_dataset(name);
  const haddr_t offset = H5Dget_offset(dataset);
  require(offset != HADDR_UNDEF, "find the place of", name);
  return {static_cast<std::int64_t>(offset), static_cast<std::int64_t>(H5Dget_storage_size(dataset))};
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                               const void* value) {
  const Hdf5Handle attribute = own(H5Acreate_by_name(file_, object.c_str(), name.c_str(), type, space,
                                                     H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                   H5Aclose, "create attribute", name);
  require(H5Awrite(attribute, type, value) >= 0, "write attribute", name);
}

void Hdf5File::write_attribute(const std::string& object, const std::string& name,
                               const AttributeValue& value) {
  const Hdf5Handle space = own(H5Screate(H5S_SCALAR), H5Sclose, "describe attribute", name);
  const auto* text = std::get_if<std::string>(&value);
  const Hdf5Handle type = text != nullptr ? text_type(text->size())
                                          : Hdf5Handle(H5Tcopy(number_types[value.index()]()), H5Tclose);
  require(type >= 0, "describe attribute", name);
  write_attribute(object, name, type, space, text != nullptr ? text->c_str() : number_of(value));
}

void Hdf5File::write_numbers(const std::string& object, const std::string& name,
                             const std::vector<std::int64_t>& numbers) {
  const hsize_t count = numbers.size();
  const Hdf5Handle space = own(H5Screate_simple(1, &count, nullptr), H5Sclose, "describe attribute", name);
  write_attribute(object, name, H5T_NATIVE_INT64, space, numbers.data());
}

void Hdf5File::write_ascii(const std::string& object, const std::string& name, const std::string& text) {
  const Hdf5Handle type = own(H5Tcopy(H5T_C_S1), H5Tclose, "describe attribute", name);
  require(H5Tset_size(type, text.size()) >= 0 && H5Tset_strpad(type, H5T_STR_NULLPAD) >= 0,
          "describe attribute", name);
  const Hdf5Handle space = own(H5Screate(H5S_SCALAR), H5Sclose, "describe attribute", name);
  write_attribute(object, name, type, space, text.data());
}

AttributeValue Hdf5File::read_attribute(const std::string& object, const std::string& name) const {
  const Hdf5Handle attribute =
      own(H5Aopen_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
          "open attribute", name);
  const Hdf5Handle type = own(H5Aget_type(attribute), H5Tclose, "read the type of attribute", name);
  const Hdf5Handle space = own(H5Aget_space(attribute), H5Sclose, "read the shape of attribute", name);
  const H5T_class_t kind = H5Tget_class(type);
  const std::size_t size = H5Tget_size(type);
  const auto read = [&](hid_t memory_type, void* value) {
    require(H5Aread(attribute, memory_type, value) >= 0, "read attribute", name);
  };
  if (H5Sget_simple_extent_npoints(space) != 1) refuse(fmt::format("attribute {} is not one value", name));
  if (kind == H5T_STRING && H5Tis_variable_str(type) == 0 && size <= longest_text) {
    std::string text(size + 1, '\0');
    read(text_type(size), text.data());
    return text.c_str();
  }
  AttributeValue value;
  if (kind == H5T_FLOAT && size == sizeof(double)) {
    value = 0.0;
  } else if (kind == H5T_INTEGER && size == sizeof(std::int64_t)) {
    if (H5Tget_sign(type) == H5T_SGN_NONE) value = std::uint64_t{};
  } else {
    refuse(fmt::format("attribute {} is neither a number of 64 bits nor a text", name));
  }
  read(number_types[value.index()](), number_of(value));
  return value;
}

bool Hdf5File::has_attribute(const std::string& object, const std::string& name) const {
  return H5Aexists_by_name(file_, object.c_str(), name.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> Hdf5File::attribute_names(const std::string& object) const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5A_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  hsize_t from = 0;
  require(H5Aiterate_by_name(file_, object.c_str(), H5_INDEX_NAME, H5_ITER_INC, &from, add, &names,
                             H5P_DEFAULT) >= 0,
          "list the attributes of", object);
  return names;
}

void Hdf5File::close() {
  require(file_.reset(), "close", "the file");
}

void change_structure(const std::filesystem::path& path, Hdf5File::Mode mode, std::size_t datasets,
                      const std::function<void(Hdf5File&)>& change) {
  std::unique_ptr<Hdf5File> file;
  {
    // HDF5 writes metadata when it closes a file; if it cannot, it crashes when the program ends. So room for
    // them is had first, and freed just before, also when `change` fails. More than a data set and all
    // attributes take.
    const SpareSpace room(path, static_cast<std::int64_t>(128 + datasets) * 1024);
    file = std::make_unique<Hdf5File>(path, mode, parallel::Communicator::self());
    change(*file);
  }
  file->close();
}

}  // namespace rhexis::output
