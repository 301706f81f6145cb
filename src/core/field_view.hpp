// SPDX-License-Identifier: BSD-3-Clause
/// Fields as observers see them: name, unit, components and borrowed memory; no physics.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/id_ranges.hpp"

namespace rhexis {

/// What a field's values belong to: the points, or the lines (cells) between them.
enum class Centring { point, cell };

/// What a field is, before anybody pays for its values.
struct FieldInfo {
  std::string_view name;  ///< as in files and pictures, e.g. "displacement"
  std::string_view unit;  ///< SI, UDUNITS spelling, e.g. "m"; "1" for a ratio
  int components = 1;     ///< 1 (scalar) or 3 (vector)
  Centring centring = Centring::point;
};

/// Borrowed values of a field on this rank's points: `components` arrays of `count` doubles each (structure
/// of arrays), contiguous, in the order of the rank's points. Valid until the source advances.
struct FieldView {
  FieldInfo info;
  std::array<const double*, 3> component{};
  std::size_t count = 0;
};

/// A number that goes with a moment: shown in pictures, stored with the step.
struct Annotation {
  std::string_view name;  ///< e.g. "pressure"
  std::string_view unit;  ///< e.g. "Pa"
  double value = 0;
};

/// A body at one moment, offered to observers (HDF5, Catalyst). Fields are computed when first asked for at
/// this moment and kept until the next; asking is local to a rank.
class PointSource {
 public:
  virtual ~PointSource() = default;
  virtual long step() const = 0;
  virtual double time_s() const = 0;
  /// Which of all points are on this rank, in the order of the fields' values.
  virtual const IdRanges& ids() const = 0;
  virtual std::span<const FieldInfo> fields() const = 0;
  /// Deformed positions, named "position", unit m, three components.
  virtual FieldView positions() = 0;
  /// A field by its name; throws std::out_of_range for a name that `fields()` does not list.
  virtual FieldView field(std::string_view name) = 0;
  virtual std::vector<Annotation> annotations() const = 0;
};

/// Straight lines between points at one moment, such as the vessels of a network between their junctions.
/// Every rank has points and lines of its own (perhaps none); lines refer to points of the same rank.
class LineSource {
 public:
  virtual ~LineSource() = default;
  virtual long step() const = 0;
  virtual double time_s() const = 0;
  /// Positions of this rank's points: a field named "position", unit m, three components.
  virtual FieldView positions() = 0;
  /// Two point indices a line: [2 L].
  virtual std::span<const std::int64_t> connectivity() = 0;
  virtual std::span<const FieldInfo> fields() const = 0;
  /// A field by its name, on points or lines as its centring says; throws std::out_of_range for a name that
  /// `fields()` does not list.
  virtual FieldView field(std::string_view name) = 0;
  virtual std::vector<Annotation> annotations() const = 0;
};

}  // namespace rhexis
