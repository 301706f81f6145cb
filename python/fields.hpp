// SPDX-License-Identifier: BSD-3-Clause
/// What a run shows, as Python's function `progress` sees it.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <memory>
#include <string>

#include "core/error.hpp"
#include "insitu/pipeline.hpp"
#include "parallel/communicator.hpp"

namespace rhexis::python {

/// The particles of a wall (PointSource) or the vessels of a network (LineSource) at one output, for as long
/// as the function that gets them runs; the members throw RunError after that.
template <class Source>
class Fields {
 public:
  explicit Fields(Source& source) : source_(&source) {}

  Source& source() const {
    if (source_ == nullptr) throw RunError("this moment of the run has passed: keep copies of its arrays");
    return *source_;
  }
  void end() { source_ = nullptr; }

 private:
  Source* source_;
};

using Particles = Fields<PointSource>;
using Vessels = Fields<LineSource>;

/// Names the classes of Python: Particles and Vessels, whose fields are numpy arrays in the solver's own
/// memory.
void define_fields(pybind11::module_& module);

/// Calls a Python function with what a run shows, and lets Python see signals that came before the run took
/// them.
class ProgressCaller {
 public:
  /// `function`: a callable, or None.
  ProgressCaller(pybind11::object function, parallel::Communicator comm)
      : function_(std::move(function)), comm_(comm) {}

  /// Without Python's lock. Throws RunError on all ranks where one of them raised. Collective.
  void operator()(const insitu::Channels& channels);
  /// Raises in Python what this rank's function has raised, if it has.
  void raise() const;

 private:
  void call(const insitu::Channels& channels) const;

  pybind11::object function_;
  parallel::Communicator comm_;
  std::unique_ptr<pybind11::error_already_set> raised_;
};

}  // namespace rhexis::python
