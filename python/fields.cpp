// SPDX-License-Identifier: BSD-3-Clause
#include "fields.hpp"

#include <stdexcept>
#include <vector>

namespace py = pybind11;

namespace rhexis::python {
namespace {

py::str text(std::string_view view) {
  return {view.data(), view.size()};
}

/// Memory of `owner`'s source, not to be written to. It keeps `owner` alive, by which ProgressCaller sees
/// that no array outlives the moment.
template <class Number>
py::array_t<Number> view(const Number* data, std::vector<py::ssize_t> shape, const py::object& owner) {
  py::array_t<Number> values(std::move(shape), data, owner);
  values.attr("flags").attr("writeable") = false;
  return values;
}

/// The field `name` as numpy sees it: an array [n], or a tuple of three for x, y and z. Throws KeyError.
template <class Source>
py::object values(const py::object& owner, const std::string& name) {
  Source& source = owner.cast<const Fields<Source>&>().source();
  FieldView field;
  try {
    field = name == "position" ? source.positions() : source.field(name);
  } catch (const std::out_of_range&) {
    throw py::key_error(name);
  }
  const auto array = [&](std::size_t component) {
    return view(field.component.at(component), {static_cast<py::ssize_t>(field.count)}, owner);
  };
  if (field.info.components == 1) return array(0);
  return py::make_tuple(array(0), array(1), array(2));
}

template <class Source>
py::class_<Fields<Source>> define(py::module_& module, const char* name, const char* meaning) {
  using F = Fields<Source>;
  return py::class_<F>(module, name, meaning)
      .def_property_readonly(
          "step", [](const F& f) { return f.source().step(); }, "Number of the time step.")
      .def_property_readonly(
          "time_s", [](const F& f) { return f.source().time_s(); }, "Simulated time, s.")
      .def_property_readonly(
          "annotations",
          [](const F& f) {
            py::dict numbers;
            for (const Annotation& note : f.source().annotations()) numbers[text(note.name)] = note.value;
            return numbers;
          },
          "Numbers that go with the moment, in SI units, by their names.")
      .def_property_readonly(
          "fields",
          [](const F& f) {
            py::dict units;
            units["position"] = "m";
            for (const FieldInfo& field : f.source().fields()) units[text(field.name)] = text(field.unit);
            return units;
          },
          "Names of the fields, with their units.")
      .def(
          "__getitem__", &values<Source>,
          "The field of this name: an array [n], or a tuple of three for x, y and z; read-only, to be copied "
          "where it is to stay.");
}

template <class Source>
py::object shown(Source* source) {
  return source == nullptr ? py::object(py::none()) : py::cast(Fields<Source>(*source));
}

template <class Source>
void end(const py::object& fields) {
  if (!fields.is_none()) fields.cast<Fields<Source>&>().end();
}

}  // namespace

void define_fields(py::module_& module) {
  define<PointSource>(module, "Particles",
                      "The particles of a vessel's wall at one output, for as long as the call of `progress` "
                      "lasts that gets them.\n\nannotations: \"pressure\", Pa.");
  define<LineSource>(
      module, "Vessels",
      "The shown vessels of a network, for as long as the call of `progress` lasts that gets "
      "them.\n\n\"position\" and \"pressure\" are of the junctions, other fields of the vessels.")
      .def_property_readonly(
          "connectivity",
          [](const py::object& owner) {
            const auto ends = owner.cast<const Vessels&>().source().connectivity();
            return view(ends.data(), {static_cast<py::ssize_t>(ends.size() / 2), 2}, owner);
          },
          "The two junctions of each vessel, as indices: an array [vessels, 2].");
}

void ProgressCaller::call(const insitu::Channels& channels) const {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
  if (function_.is_none()) return;
  const py::object particles = shown(insitu::find_source<PointSource>(channels, "particles")),
                   vessels = shown(insitu::find_source<LineSource>(channels, "network"));
  const auto end_all = [&] {
    end<PointSource>(particles);
    end<LineSource>(vessels);
  };
  const auto is_kept = [&] {
    return (!particles.is_none() && particles.ref_count() > 1) ||
           (!vessels.is_none() && vessels.ref_count() > 1);
  };
  try {
    function_(particles, vessels);
  } catch (const py::error_already_set&) {
    end_all();
    throw;
  }
  if (is_kept()) py::module_::import("gc").attr("collect")();  // e.g. a figure that nobody holds any more
  const bool kept = is_kept();
  end_all();
  if (kept)
    throw py::value_error(
        "progress keeps what it was called with, or an array of it, beyond its call: keep copies, "
        "e.g. particles[\"damage\"].copy()");
}

void ProgressCaller::operator()(const insitu::Channels& channels) {
  std::string failure;
  {
    const py::gil_scoped_acquire lock;
    try {
      call(channels);
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
