// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/inspection.hpp"

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

/// Names of fields by the name of their channel.
vtkSmartPyObject dict_of(const std::vector<ChannelFields>& channels) {
  vtkSmartPyObject dict(PyDict_New());
  for (const ChannelFields& channel : channels)
    PyDict_SetItemString(dict, channel.name.c_str(), list_of(channel.fields));
  return dict;
}

/// From (channel, [field, ...]).
Wish wish_of(PyObject* tuple) {
  Wish wish{utf8(PyTuple_GetItem(tuple, 0)), {}};
  PyObject* fields = PyTuple_GetItem(tuple, 1);
  for (Py_ssize_t i = 0; i < PyList_Size(fields); ++i) wish.fields.push_back(utf8(PyList_GetItem(fields, i)));
  return wish;
}

}  // namespace

std::string missing_modules() {
  PyObject* module = embedded_module("rhexis_inspection", inspection_source);
  vtkPythonScopeGilEnsurer gil;
  return utf8(checked(PyObject_CallMethod(module, "missing_modules", nullptr)));
}

std::vector<std::vector<Wish>> inspect(const Settings& settings) {
  PyObject* module = embedded_module("rhexis_inspection", inspection_source);
  vtkPythonScopeGilEnsurer gil;
  const vtkSmartPyObject function = checked(PyObject_GetAttrString(module, "inspect"));
  const vtkSmartPyObject scripts = list_of(settings.scripts), channels = dict_of(settings.channels);
  const vtkSmartPyObject found =
      checked(PyObject_CallFunctionObjArgs(function, scripts.GetPointer(), channels.GetPointer(), nullptr));
  std::vector<std::vector<Wish>> wishes(settings.scripts.size());
  for (std::size_t script = 0; script < wishes.size(); ++script) {
    PyObject* of_script = PyList_GetItem(found, static_cast<Py_ssize_t>(script));
    for (Py_ssize_t i = 0; i < PyList_Size(of_script); ++i)
      wishes[script].push_back(wish_of(PyList_GetItem(of_script, i)));
  }
  return wishes;
}

}  // namespace rhexis::insitu
