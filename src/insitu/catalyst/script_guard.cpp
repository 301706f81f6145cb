// SPDX-License-Identifier: BSD-3-Clause
#include "insitu/catalyst/script_guard.hpp"

#include <csignal>

#include "insitu/catalyst/embedded_python.hpp"  // before any other header
#include "insitu/catalyst/python_sources.hpp"

namespace rhexis::insitu {
namespace {

constexpr const char* module_name = "rhexis_catalyst";
constexpr const char* capsule_name = "rhexis_catalyst.agreement";

/// What Python calls as agree(text); collective, so there is nothing that makes a rank leave it out.
PyObject* agree(PyObject* self, PyObject* text) {
  auto* agreement = static_cast<Agreement*>(PyCapsule_GetPointer(self, capsule_name));
  return PyUnicode_FromString(agreement->agree(utf8(text)).c_str());
}

PyMethodDef agree_definition = {"agree", &agree, METH_O, "first non-empty text of all ranks"};

PyObject* module() {
  return PyImport_AddModule(module_name);
}

void note_message(bool is_error, const std::string& text) {
  const vtkPythonScopeGilEnsurer gil;
  const vtkSmartPyObject words(
      PyUnicode_DecodeUTF8(text.c_str(), static_cast<Py_ssize_t>(text.size()), "replace"));
  checked(
      PyObject_CallMethod(module(), "note_message", "OO", is_error ? Py_True : Py_False, words.GetPointer()));
}

/// While this lives, writing to somebody who has left (a ParaView that watched the run) is an error, not the
/// end.
class NoBrokenPipes {
 public:
  NoBrokenPipes() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGPIPE, &ignore, &before_);
  }
  NoBrokenPipes(const NoBrokenPipes&) = delete;
  NoBrokenPipes& operator=(const NoBrokenPipes&) = delete;
  ~NoBrokenPipes() { sigaction(SIGPIPE, &before_, nullptr); }

 private:
  struct sigaction before_ {};
};

}  // namespace

ScriptGuard::ScriptGuard(Agreement& agreement, const std::string& image_directory, const std::string& live)
    : agreement_(agreement) {
  embedded_module("rhexis_inspection", inspection_source);
  PyObject* names = PyModule_GetDict(embedded_module(module_name, guard_source));
  const vtkPythonScopeGilEnsurer gil;
  const vtkSmartPyObject capsule(PyCapsule_New(&agreement, capsule_name, nullptr));
  const vtkSmartPyObject function(PyCFunction_New(&agree_definition, capsule));
  PyDict_SetItemString(names, "agree", function);
  PyDict_SetItemString(names, "image_directory", path_object(image_directory));
  PyDict_SetItemString(names, "live", path_object(live));
  PyDict_SetItemString(names, "time_limit", path_object(agreement.time_limit().limit()));
  PyDict_SetItemString(names, "is_root", agreement.is_root() ? Py_True : Py_False);
}

void ScriptGuard::call(const std::string& path, const std::function<void()>& work) {
  const vtkPythonScopeGilEnsurer gil;
  std::string failure;
  {
    const NoBrokenPipes pipes;
    const ProcessState before;
    Messages messages(&note_message);
    agreement_.time_limit().begin(path);
    work();
    agreement_.time_limit().end();
    messages.flush();
    failure = utf8(checked(PyObject_CallMethod(module(), "take_noted", "OO", path_object(path).GetPointer(),
                                               agreement_.failure().empty() ? Py_False : Py_True)));
    const std::string changes = before.restore();
    if (failure.empty() && !changes.empty())
      failure = "Catalyst script " + path + ": it " + changes + ", which the program relies on";
  }
  agreement_.agree(failure);
}

void ScriptGuard::forget_scripts() const {
  const vtkPythonScopeGilEnsurer gil;
  checked(PyObject_CallMethod(module(), "forget_scripts", nullptr));
}

}  // namespace rhexis::insitu
