// SPDX-License-Identifier: BSD-3-Clause
#include "moment.hpp"

#include <stdexcept>

#include "core/error.hpp"

namespace py = pybind11;

namespace rhexis::python {

PointSource& Moment::source() const {
  if (source_ == nullptr) throw RunError("this moment of the run has passed: keep copies of its arrays");
  return *source_;
}

py::dict Moment::annotations() const {
  py::dict values;
  for (const Annotation& annotation : source().annotations())
    values[py::str(annotation.name.data(), annotation.name.size())] = annotation.value;
  return values;
}

py::dict Moment::fields() const {
  py::dict units;
  units["position"] = "m";
  for (const FieldInfo& field : source().fields())
    units[py::str(field.name.data(), field.name.size())] = py::str(field.unit.data(), field.unit.size());
  return units;
}

py::object Moment::values(const py::object& moment, const std::string& name) {
  PointSource& source = moment.cast<const Moment&>().source();
  FieldView view;
  try {
    view = name == "position" ? source.positions() : source.field(name);
  } catch (const std::out_of_range&) {
    throw py::key_error(name);
  }
  const auto array = [&](std::size_t component) {
    py::array_t<double> values(static_cast<py::ssize_t>(view.count), view.component.at(component), moment);
    values.attr("flags").attr("writeable") = false;
    return values;
  };
  if (view.info.components == 1) return array(0);
  return py::make_tuple(array(0), array(1), array(2));
}

void ProgressCaller::call(PointSource& source) const {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (function_.is_none()) return;
  const py::object moment = py::cast(Moment(source));
  const auto is_kept = [&] { return moment.ref_count() > 1; };
  try {
    function_(moment);
  } catch (const py::error_already_set&) {
    moment.cast<Moment&>().end();
    throw;
  }
  if (is_kept()) py::module_::import("gc").attr("collect")();  // e.g. a figure that nobody holds any more
  const bool kept = is_kept();
  moment.cast<Moment&>().end();
  if (kept)
    throw py::value_error(
        "progress keeps an array of its moment, or the moment, beyond its call: keep copies, "
        "e.g. moment[\"damage\"].copy()");
}

void ProgressCaller::operator()(PointSource& source) {
  std::string failure;
  {
    const py::gil_scoped_acquire lock;
    try {
      call(source);
    } catch (py::error_already_set& error) {
      raised_ = std::make_unique<py::error_already_set>(error);
    } catch (py::builtin_exception& error) {
      error.set_error();
      raised_ = std::make_unique<py::error_already_set>();
    }
    if (raised_)
      failure = "progress raised " + py::str(raised_->type().attr("__name__")).cast<std::string>() + ": " +
                py::str(raised_->value()).cast<std::string>();
  }
  failure = comm_.first_non_empty(failure);
  if (!failure.empty()) throw RunError(failure);
}

void ProgressCaller::raise() const {
  if (raised_) throw py::error_already_set(*raised_);
}

}  // namespace rhexis::python
