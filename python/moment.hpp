// SPDX-License-Identifier: BSD-3-Clause
/// A running vessel as Python's function `progress` sees it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "core/field_view.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::python {

/// A vessel at one of its outputs, for as long as the function that gets it runs; its members throw RunError
/// after that.
class Moment {
 public:
  explicit Moment(PointSource& source) : source_(&source) {}

  PointSource& source() const;
  void end() { source_ = nullptr; }

  pybind11::dict annotations() const;
  /// Names and units.
  pybind11::dict fields() const;
  /// A field of this rank's n particles in SI units, by its name: an array [n], or a tuple of three for x, y
  /// and z. They are the solver's own memory, read-only, and keep `moment` alive, by which ProgressCaller
  /// sees that none outlives it. Throws KeyError.
  static pybind11::object values(const pybind11::object& moment, const std::string& name);

 private:
  PointSource* source_;
};

/// Shows a run's moments to a Python function, and lets Python see signals that came before the run took
/// them.
class ProgressCaller {
 public:
  /// `function`: a callable, or None.
  ProgressCaller(pybind11::object function, parallel::Communicator comm)
      : function_(std::move(function)), comm_(comm) {}

  /// Without Python's lock. Throws RunError on all ranks where one of them raised. Collective.
  void operator()(PointSource& source);
  /// Raises in Python what this rank's function has raised, if it has.
  void raise() const;

 private:
  void call(PointSource& source) const;

  pybind11::object function_;
  parallel::Communicator comm_;
  std::unique_ptr<pybind11::error_already_set> raised_;
};

}  // namespace rhexis::python
