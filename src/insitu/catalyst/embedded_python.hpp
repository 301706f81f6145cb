// SPDX-License-Identifier: BSD-3-Clause
/// Python modules whose source is part of the plugin, and calls into them.
#pragma once

#include <vtkPython.h>  // before any other header
#include <vtkSmartPyObject.h>

#include <string>

namespace rhexis::insitu {

/// Starts the interpreter where it does not run yet (without its handler of SIGINT), and makes the module
/// `name` of `source` where it is not there yet. Returns a borrowed reference. Throws RunError.
PyObject* embedded_module(const char* name, const char* source);

/// A Python string; what has no UTF-8 (a stray byte of a file's name) as an escape.
std::string utf8(PyObject* text);

/// A path as a Python string.
vtkSmartPyObject path_object(const std::string& path);

/// `result`, or throws RunError with the pending exception's text if it is null.
vtkSmartPyObject checked(PyObject* result);

}  // namespace rhexis::insitu
