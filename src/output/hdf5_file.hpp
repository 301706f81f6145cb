// SPDX-License-Identifier: BSD-3-Clause
/// Parallel HDF5 behind a few words: handles that close themselves, calls that throw, and the
/// parts of data sets that ranks have.
#pragma once

#include <hdf5.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/id_ranges.hpp"
#include "output/disk_space.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

/// An HDF5 identifier that is closed with its owner.
class Hdf5Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Hdf5Handle() = default;
  Hdf5Handle(hid_t id, Close close) : id_(id), close_(close) {}
  Hdf5Handle(Hdf5Handle&& other) noexcept;
  Hdf5Handle& operator=(Hdf5Handle&& other) noexcept;
  ~Hdf5Handle() { reset(); }
  operator hid_t() const { return id_; }
  /// Closes now; false if HDF5 reports a failure.
  bool reset();

 private:
  hid_t id_ = -1;
  Close close_ = nullptr;
};

/// This rank's part of a data set of one or two dimensions: regular sets of blocks, each as
/// H5Sselect_hyperslab takes it, in ascending order.
struct Slab {
  struct Blocks {
    std::array<hsize_t, 2> start{}, stride{}, count{}, block{};
  };
  int dimensions = 1;
  std::array<hsize_t, 2> shape{};
  std::vector<Blocks> parts = {};

  std::vector<hsize_t> extent() const { return {shape.begin(), shape.begin() + dimensions}; }
};

/// The rank's items, `components` values each: shape [N] for one component, else [N, components].
Slab slab_of(const IdRanges& ids, int components);
/// The rank's part of a table [rows, width].
Slab slab_of(const TablePart& part);

/// What an attribute holds here.
using AttributeValue = std::variant<std::int64_t, std::uint64_t, double, std::string>;

/// A file open on all ranks of a communicator. Every call is collective and throws std::runtime_error whose
/// text names the file, what was being done and HDF5's reason, possibly on some ranks only: see `together`.
/// HDF5 itself prints nothing.
class Hdf5File {
 public:
  /// Where a file is `checked`, the structures that HDF5 adds to it carry checksums, which HDF5 verifies when
  /// it reads them (file format of HDF5 1.8); without, they are as old as possible.
  enum class Mode { create, create_checked, modify, modify_checked, read };
  Hdf5File(std::filesystem::path path, Mode mode, const parallel::Communicator& communicator);

  const std::filesystem::path& path() const { return path_; }

  void create_group(const std::string& name);
  /// A data set of which `slab` is this rank's part. Its space in the file is laid out now; its values are
  /// whatever the disk holds (zeros in a new file) until they are written.
  void create_dataset(const std::string& name, hid_t type, const Slab& slab);
  /// Every rank writes (reads) its part; `memory_type` of the values in memory, dense, in the order of the
  /// slab.
  void write(const std::string& name, hid_t memory_type, const Slab& slab, const void* values);
  void read(const std::string& name, hid_t memory_type, const Slab& slab, void* values) const;
  /// The extent of a data set; throws if there is none of that name, or if its values are not stored as
  /// `type`.
  std::vector<hsize_t> shape(const std::string& name, hid_t type) const;
  /// Where a data set's values lie in the file.
  ByteRange bytes_of(const std::string& name) const;

  /// Attributes of a group or a data set; the same value on every rank.
  void write_attribute(const std::string& object, const std::string& name, const AttributeValue& value);
  void write_text(const std::string& object, const std::string& name, const std::string& text) {
    write_attribute(object, name, text);
  }
  /// Throws where there is none, or what there is is neither one number of 64 bits nor one text.
  AttributeValue read_attribute(const std::string& object, const std::string& name) const;
  /// As VTKHDF wants them: characters without an end, and numbers in one dimension.
  void write_ascii(const std::string& object, const std::string& name, const std::string& text);
  void write_numbers(const std::string& object, const std::string& name,
                     const std::vector<std::int64_t>& numbers);
  bool has_attribute(const std::string& object, const std::string& name) const;
  /// In the order of their names.
  std::vector<std::string> attribute_names(const std::string& object) const;

  /// Hands everything to the operating system. The destructor does too, but cannot tell of a failure.
  void close();

 private:
  void require(bool succeeded, std::string_view doing, std::string_view object) const;
  [[noreturn]] void refuse(const std::string& reason) const;
  Hdf5Handle own(hid_t id, Hdf5Handle::Close closer, std::string_view doing, std::string_view object) const;
  Hdf5Handle open_dataset(const std::string& name) const;
  void write_attribute(const std::string& object, const std::string& name, hid_t type, hid_t space,
                       const void* value);
  Hdf5Handle select(const Slab& slab, const std::string& name) const;

  std::filesystem::path path_;
  Hdf5Handle file_, collective_;
};

/// Lets `change` add groups, at most `datasets` data sets and attributes to the file, which is created, or
/// opened to be modified, by the calling rank alone. Throws std::runtime_error, before anything is written if
/// the disk is full. All ranks together must not do this: in Open MPI and HDF5 1.10 they wait for each other
/// for ever if one of them fails to write its share of the metadata.
void change_structure(const std::filesystem::path& path, Hdf5File::Mode mode, std::size_t datasets,
                      const std::function<void(Hdf5File&)>& change);

}  // namespace rhexis::output
