#include "insitu/catalyst/script_guard.hpp"

#include <vtkPython.h>  // before any other header
#include <vtkPythonInterpreter.h>
#include <vtkSmartPyObject.h>

#include "core/error.hpp"
#include "insitu/catalyst/guard_source.hpp"

namespace rhexis::insitu {
namespace {

constexpr const char* module_name = "rhexis_catalyst";
constexpr const char* capsule_name = "rhexis_catalyst.agreement";

/// A Python string; what has no UTF-8 (a stray byte of a file's name) as an escape.
std::string utf8(PyObject* text) {
  const vtkSmartPyObject bytes(
      text == nullptr ? nullptr : PyUnicode_AsEncodedString(text, "utf-8", "backslashreplace"));
  if (bytes) return PyBytes_AsString(bytes);
  PyErr_Clear();
  return "unknown Python error";
}

/// What Python calls as agree(text); collective, so there is nothing that makes a rank leave it out.
PyObject* agree(PyObject* self, PyObject* text) {
  auto* agreement = static_cast<Agreement*>(PyCapsule_GetPointer(self, capsule_name));
  return PyUnicode_FromString(agreement->agree(utf8(text)).c_str());
}

PyMethodDef agree_definition = {"agree", &agree, METH_O, "first non-empty text of all ranks"};

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

vtkSmartPyObject call(const char* function, const char* argument = nullptr) {
  PyObject* module = PyImport_AddModule(module_name);
  vtkSmartPyObject result(argument == nullptr ? PyObject_CallMethod(module, function, nullptr)
                                              : PyObject_CallMethod(module, function, "s", argument));
  if (!result) throw RunError(take_exception());
  return result;
}

}  // namespace

ScriptGuard::ScriptGuard(Agreement& agreement, const std::string& image_directory) {
  vtkPythonInterpreter::Initialize();
  vtkPythonScopeGilEnsurer gil;
  PyObject* names = PyModule_GetDict(PyImport_AddModule(module_name));
  vtkSmartPyObject capsule(PyCapsule_New(&agreement, capsule_name, nullptr));
  vtkSmartPyObject function(PyCFunction_New(&agree_definition, capsule));
  PyDict_SetItemString(names, "agree", function);
  PyDict_SetItemString(names, "__builtins__", PyEval_GetBuiltins());
  vtkSmartPyObject code(Py_CompileString(guard_source, "rhexis guard.py", Py_file_input));
  vtkSmartPyObject result(code ? PyEval_EvalCode(code, names, names) : nullptr);
  if (!result) throw RunError("ParaView's Python: " + take_exception());
  vtkSmartPyObject directory(PyUnicode_DecodeFSDefault(image_directory.c_str()));
  PyDict_SetItemString(names, "image_directory", directory);
}

PerChannel<Wish> ScriptGuard::wishes(const std::string& script) const {
  vtkPythonScopeGilEnsurer gil;
  const vtkSmartPyObject found = call("inspect", script.c_str());
  PerChannel<Wish> wishes;
  for (std::size_t channel = 0; channel < channel_count; ++channel) {
    PyObject* of_channel = PyList_GetItem(found, static_cast<Py_ssize_t>(channel));
    wishes[channel].wanted = PyTuple_GetItem(of_channel, 0) == Py_True;
    wishes[channel].required = PyTuple_GetItem(of_channel, 1) == Py_True;
    PyObject* names = PyTuple_GetItem(of_channel, 2);
    if (names == Py_None) continue;
    std::vector<std::string>& fields = wishes[channel].fields.emplace();
    for (Py_ssize_t i = 0; i < PyList_Size(names); ++i) {
      fields.push_back(utf8(PyList_GetItem(names, i)));
    }
  }
  return wishes;
}

std::string ScriptGuard::take_noted(const std::string& script) const {
  vtkPythonScopeGilEnsurer gil;
  return utf8(call("take_noted", script.c_str()));
}

void ScriptGuard::forget_scripts() const {
  vtkPythonScopeGilEnsurer gil;
  call("forget_scripts");
}

}  // namespace rhexis::insitu
