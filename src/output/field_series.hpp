// SPDX-License-Identifier: BSD-3-Clause
/// What series of points and series of lines have in common, in whichever format: files laid out once, steps
/// that add values, and a list of complete steps.
///
/// All of an HDF5 file is laid out when it is made, and its structure reaches the disk then: a step adds
/// values and nothing else, so whenever and however the program dies, all earlier steps can be read. A step
/// that was never written takes no disk space. A step is listed once the first rank has it on the disk; what
/// that costs does not depend on how many there are before.
#pragma once

#include <cstdint>
#include <functional>
#include <future>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "core/field_view.hpp"
#include "output/series_plan.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::output {

class SeriesFile;
struct Place;

/// A series in one format. Every call is collective and, if it fails on any rank (disk full), throws RunError
/// on all; what was written before stays readable.
class FieldSeries {
 public:
  virtual ~FieldSeries();

  /// Positions (m) that do not change: undeformed ones of points that move, all there are of points that
  /// stay.
  void write_positions(const FieldView& values);
  /// The points that lines join, two a line, numbered over all ranks. (Points are numbered by the layout.)
  void write_connectivity(const std::vector<std::int64_t>& ends);

  /// Stores the fields of a moment, each by `view_of`, and lists it. Does not wait for the disk but after the
  /// last step of the plan, or one that is not in it; a failure there is thrown by the next call. A step that
  /// was not planned displaces an earlier such step.
  void write(const SeriesStep& moment, const std::function<FieldView(const StoredField&)>& view_of);

  /// Waits until the step that was written last is on the disk; one that cannot get there is listed no
  /// longer.
  void finish() { wait_for_disk(); }

 protected:
  FieldSeries(const SeriesPlan& plan, const SeriesLayout& layout, std::vector<StoredField> fields,
              const std::string& extension, parallel::Communicator communicator);

  /// Where these lie, and the values of a field at a step that becomes the `entry`th of the list.
  virtual Place fixed_positions() const = 0;
  virtual Place connectivity() const = 0;
  virtual Place place_of(const StoredField& field, long step, bool planned, std::size_t entry) const = 0;

  /// On the root: stores what else belongs to a step; what is returned makes it the `entry`th of the list.
  /// That is called from another thread, once all values are on the disk.
  virtual std::function<void()> prepare(const SeriesStep& moment, bool planned, std::size_t entry) = 0;
  /// On the root: takes the `entry`th, the last, from the list.
  virtual void unlist(std::size_t entry) = 0;

  /// Ascending, before anything is written.
  const std::set<long>& planned() const { return planned_; }
  const std::vector<StoredField>& fields() const { return fields_; }
  SeriesFile& file() { return *file_; }
  const SeriesFile& file() const { return *file_; }

 private:
  void wait_for_disk();
  void take_off_last();

  std::vector<StoredField> fields_;
  std::set<long> planned_;                ///< steps that are still to come
  std::size_t entries_ = 0;               ///< entries of the list
  std::optional<std::size_t> unplanned_;  ///< which of them was not planned
  std::unique_ptr<SeriesFile> file_;
  /// The step that was written last, on its way to the disk; whether it was listed here then.
  std::future<bool> saving_;
};

/// A series for each format of the plan.
std::vector<std::unique_ptr<FieldSeries>> open_series(const SeriesPlan& plan, const SeriesLayout& layout,
                                                      SeriesKind kind, std::vector<StoredField> fields,
                                                      parallel::Communicator communicator);

}  // namespace rhexis::output
