// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/embedded_python.hpp"

#include <vtkPythonInterpreter.h>

#include "core/error.hpp"

namespace rhexis::insitu {
namespace {

/// The pending Python exception as text, no longer pending.
std::string take_exception() {
  PyObject *type = nullptr, *value = nullptr, *trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  vtkSmartPyObject message(value == nullptr ? nullptr : PyObject_Str(value));
  Py_XDECREF(type);
  Py_XDECREF(value);
  Py_XDECREF(trace);
  return utf8(message);
}

}  // namespace

PyObject* embedded_module(const char* name, const char* source) {
  if (!vtkPythonInterpreter::IsInitialized()) vtkPythonInterpreter::Initialize(/*initsigs=*/0);
  vtkPythonScopeGilEnsurer gil;
  PyObject* module = PyImport_AddModule(name);
  PyObject* names = PyModule_GetDict(module);
  if (PyDict_GetItemString(names, "__builtins__") != nullptr) return module;
  PyDict_SetItemString(names, "__builtins__", PyEval_GetBuiltins());
  const vtkSmartPyObject code = checked(Py_CompileString(source, name, Py_file_input));
  checked(PyEval_EvalCode(code, names, names));
  return module;
}

std::string utf8(PyObject* text) {
  const vtkSmartPyObject bytes(
      text == nullptr ? nullptr : PyUnicode_AsEncodedString(text, "utf-8", "backslashreplace"));
  if (bytes) return PyBytes_AsString(bytes);
  PyErr_Clear();
  return "unknown Python error";
}

vtkSmartPyObject path_object(const std::string& path) {
  return vtkSmartPyObject(PyUnicode_DecodeFSDefault(path.c_str()));
}

vtkSmartPyObject checked(PyObject* result) {
  if (result == nullptr) throw RunError(take_exception());
  return vtkSmartPyObject(result);
}

}  // namespace rhexis::insitu
