/// The state of a run by name, for a restart on any number of ranks.
///
/// Distributed arrays are stored in the partition-independent numbering (PointLayout) or as a table of words,
/// so ranks that divide the body differently read what they need. What all ranks share: numbers are
/// attributes, text, which may be longer than those can be, data sets.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <span>
#include <string>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

class Hdf5File;
struct Slab;
class TemporaryFile;

/// This rank's part of a table of `rows` x `words` 16-bit words (the bits of the bonds: a row per bond of a
/// column's family, a word per 16 particles along the axis), row by row. Parts of ranks do not overlap.
struct WordBlock {
  std::int64_t rows = 0, words = 0;  ///< of the whole table
  std::int64_t first_row = 0, row_count = 0;
  std::int64_t first_word = 0, word_count = 0;

  std::int64_t local_count() const { return row_count * word_count; }
};

/// Writes a checkpoint. Every call is collective and throws RunError on all ranks if it fails on any. The
/// file has its name only once `close` has succeeded: until then it is a temporary one (temporary_file.hpp),
/// which goes with the writer.
class CheckpointWriter {
 public:
  CheckpointWriter(std::filesystem::path path, parallel::Communicator communicator);
  ~CheckpointWriter();

  void write(const std::string& name, const PointLayout& layout, std::span<const double> values);
  void write(const std::string& name, const WordBlock& block, std::span<const std::uint16_t> values);
  /// The same value on every rank.
  void write(const std::string& name, std::int64_t value);
  void write(const std::string& name, double value);
  void write(const std::string& name, const std::string& text);

  /// Waits until all is on disk and gives the file its name, in place of an earlier one.
  void close();

 private:
  void lay_out(const std::function<void(Hdf5File&)>& change);
  void write_array(const std::string& name, std::int64_t file_type, std::int64_t memory_type,
                   const Slab& slab, const void* values);

  std::filesystem::path path_, temporary_;
  std::unique_ptr<TemporaryFile> file_;  ///< of the root
  parallel::Communicator communicator_;
};

/// Reads a checkpoint. Every call is collective and throws InputError on all ranks, naming the file and what
/// differs, if there is no such file, it is not a checkpoint, or it does not hold what is asked for.
class CheckpointReader {
 public:
  CheckpointReader(std::filesystem::path path, parallel::Communicator communicator);
  ~CheckpointReader();

  void read(const std::string& name, const PointLayout& layout, std::span<double> values);
  void read(const std::string& name, const WordBlock& block, std::span<std::uint16_t> values);
  void read(const std::string& name, std::int64_t& value);
  void read(const std::string& name, double& value);
  void read(const std::string& name, std::string& text);

 private:
  parallel::Communicator communicator_;
  std::unique_ptr<Hdf5File> file_;
};

}  // namespace rhexis::output
