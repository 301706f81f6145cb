// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/inspection.hpp"

#include <optional>
#include <string>

#include "insitu/catalyst/embedded_python.hpp"
#include "insitu/catalyst/python_sources.hpp"

namespace rhexis::insitu {
namespace {

vtkSmartPyObject list_of(const std::vector<std::string>& texts) {
  vtkSmartPyObject list(PyList_New(0));
  for (const std::string& text : texts) PyList_Append(list, path_object(text));
  return list;
}

vtkSmartPyObject list_or_none(const std::optional<std::vector<std::string>>& texts) {
  if (texts) return list_of(*texts);
  Py_INCREF(Py_None);
  return vtkSmartPyObject(Py_None);
}

/// From (wanted, [field, ...]).
Wish wish_of(PyObject* tuple) {
  Wish wish;
  wish.wanted = PyObject_IsTrue(PyTuple_GetItem(tuple, 0)) == 1;
  PyObject* fields = PyTuple_GetItem(tuple, 1);
  for (Py_ssize_t i = 0; i < PyList_Size(fields); ++i) wish.fields.push_back(utf8(PyList_GetItem(fields, i)));
  return wish;
}

}  // namespace

std::vector<PerChannel<Wish>> inspect(const Settings& settings) {
  PyObject* module = embedded_module("rhexis_inspection", inspection_source);
  vtkPythonScopeGilEnsurer gil;
  const vtkSmartPyObject function = checked(PyObject_GetAttrString(module, "inspect"));
  const vtkSmartPyObject scripts = list_of(settings.scripts);
  const vtkSmartPyObject particles = list_or_none(settings.particle_fields);
  const vtkSmartPyObject network = list_or_none(settings.network_fields);
  const vtkSmartPyObject found = checked(PyObject_CallFunctionObjArgs(
      function, scripts.GetPointer(), particles.GetPointer(), network.GetPointer(), nullptr));
  std::vector<PerChannel<Wish>> wishes(settings.scripts.size());
  for (std::size_t script = 0; script < wishes.size(); ++script) {
    PyObject* of_script = PyList_GetItem(found, static_cast<Py_ssize_t>(script));
    for (std::size_t channel = 0; channel < channel_count; ++channel)
      wishes[script][channel] = wish_of(PyList_GetItem(of_script, static_cast<Py_ssize_t>(channel)));
  }
  return wishes;
}

}  // namespace rhexis::insitu
