// SPDX-License-Identifier: BSD-3-Clause
/// The state of a run by name, for a restart on any number of ranks.
///
/// Distributed arrays are stored in the order of global numbers (IdRanges), those of 16-bit words as tables
/// (TablePart), so ranks that divide the body differently read what they need. What all ranks share: numbers
/// are attributes, text, which may be longer than those can be, data sets. Every data set has a checksum
/// (checksum.hpp) among the attributes, these have one together, and HDF5's own structures have HDF5's: a
/// file that was damaged, or put together from several, is refused.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <variant>

#include "core/id_ranges.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

class Hdf5File;
struct Slab;
class TemporaryFile;

/// By name; in a checkpoint they are attributes.
using CheckpointNumbers =
    std::map<std::string, std::variant<std::int64_t, std::uint64_t, double, std::string>>;

/// Writes a checkpoint. Every call is collective and throws RunError on all ranks if it fails on any. The
/// file has its name only once `close` has succeeded: until then it is a temporary one (temporary_file.hpp),
/// which goes with the writer.
class CheckpointWriter {
 public:
  /// `program_version` is told where a later version cannot read the file.
  CheckpointWriter(std::filesystem::path path, const std::string& program_version,
                   parallel::Communicator communicator);
  ~CheckpointWriter();

  void write(const std::string& name, const IdRanges& ids, std::span<const double> values);
  void write(const std::string& name, const TablePart& part, std::span<const std::uint16_t> values);
  void write(const std::string& name, const std::string& text);  ///< the same on every rank
  /// A list of at least one number, the root's; not a number stands for one that is missing.
  void write(const std::string& name, std::span<const double> list);
  /// The root's value; what is absent is not written.
  void write(const std::string& name, std::int64_t value) { numbers_[name] = value; }
  void write(const std::string& name, double value) { numbers_[name] = value; }
  void write(const std::string& name, bool flag) { numbers_[name] = std::int64_t{flag}; }
  void write(const std::string& name, std::optional<double> value) {
    if (value) numbers_[name] = *value;
  }
  void write(const std::string& name, const char* text) = delete;  // it would be a flag

  /// Writes the numbers, waits until all is on disk and gives the file its name, in place of an earlier one.
  void close();

 private:
  void lay_out(std::size_t datasets, const std::function<void(Hdf5File&)>& change);
  void write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                   const Slab& slab, const void* values);
  void note_checksum(const std::string& name, std::uint64_t of_this_rank);

  std::filesystem::path path_, temporary_;
  std::unique_ptr<TemporaryFile> file_;  ///< held by the root
  parallel::Communicator communicator_;
  CheckpointNumbers numbers_;
};

/// Reads a checkpoint. Every call is collective and throws InputError on all ranks, naming the file and what
/// is wrong with it, if there is no such file, it is not a checkpoint or of another format, it is damaged, or
/// it does not hold what is asked for. Nothing is trusted before its checksum: neither shapes nor sizes.
class CheckpointReader {
 public:
  static constexpr double largest = std::numeric_limits<double>::max();

  CheckpointReader(std::filesystem::path path, parallel::Communicator communicator);
  ~CheckpointReader();

  bool holds(const std::string& name) const;

  /// Every value must be finite.
  void read(const std::string& name, const IdRanges& ids, std::span<double> values);
  void read(const std::string& name, const TablePart& part, std::span<std::uint16_t> values);
  void read(const std::string& name, std::string& text);
  /// A list of as many numbers, each missing (not a number) or from `least` to `most`.
  void read(const std::string& name, std::span<double> list, double least, double most);
  /// A number from `least` to `most`, finite.
  void read(const std::string& name, std::int64_t& value, double least = -largest, double most = largest);
  void read(const std::string& name, double& value, double least = -largest, double most = largest);
  void read(const std::string& name, std::optional<double>& value, double least = -largest,
            double most = largest);
  void read(const std::string& name, bool& flag);

  /// Throws InputError that names the file. Local: the same on every rank, or see `together`.
  [[noreturn]] void refuse(const std::string& reason) const;

 private:
  void read_numbers();
  void require_this_format() const;
  void compare_checksum(const std::string& name, std::uint64_t of_all_ranks) const;
  template <class Value>
  void require_range(const std::string& name, Value value, double least, double most) const;
  template <class Number>
  Number number(const std::string& name, double least, double most) const;
  void read_array(const std::string& name, std::int64_t memory_type, const Slab& slab, void* values) const;

  std::filesystem::path path_;
  parallel::Communicator communicator_;
  std::unique_ptr<Hdf5File> file_;
  CheckpointNumbers numbers_;
};

}  // namespace rhexis::output
