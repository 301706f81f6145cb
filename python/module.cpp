// SPDX-License-Identifier: BSD-3-Clause
/// The module `_rhexis` behind `import rhexis` (rhexis/__init__.py): what the program does with an input
/// file, as functions.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <csignal>
#include <functional>
#include <nlohmann/json.hpp>

#include "app/commands.hpp"
#include "core/error.hpp"
#include "core/printable.hpp"
#include "fields.hpp"
#include "host.hpp"
#include "runtime/guarded.hpp"
#include "runtime/interrupt.hpp"
#include "runtime/version.hpp"

namespace py = pybind11;

namespace rhexis::python {
namespace {

/// Does `work` without Python's lock. What is neither InputError nor RunError is one rank's own failure.
void without_lock(const std::function<void()>& work) {
  const py::gil_scoped_release unlocked;
  try {
    work();
  } catch (const InputError&) {
    throw;
  } catch (const RunError&) {
    throw;
  } catch (const std::exception& error) {
    if (parallel::Communicator::world().size() > 1)
      runtime::abort_because_of(error, parallel::Communicator::world());
    throw;
  }
}

app::Command command_of(app::Action action, const std::string& file,
                        const std::vector<std::string>& overrides) {
  app::Command command;
  command.action = action;
  command.file = file;
  command.overrides = overrides;
  command.embedded = true;
  return command;
}

/// A document of JSON.
std::string check(const std::string& file, const std::vector<std::string>& overrides) {
  const Call call;
  const app::Command command = command_of(app::Action::check, file, overrides);
  std::string values;
  without_lock([&] { values = app::checked_values(command, parallel::Communicator::world()).dump(); });
  return values;
}

/// Hands a signal on to Python's handler, which may raise KeyboardInterrupt, or to the system's, which may
/// end Python.
void hand_on(int signal) {
  std::raise(signal);
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// Runs into `directory`, which then has run.json.
void run(const std::string& file, const std::vector<std::string>& overrides, const std::string& directory,
         const std::string& restart, bool overwrite, bool quiet, const py::object& progress) {
  const Call call;
  app::Command command = command_of(app::Action::run, file, overrides);
  command.directory = directory;
  command.restart = restart;
  command.overwrite = overwrite;
  command.quiet = quiet;
  command.arguments = {"rhexis", "run", file};
  for (const std::string& text : overrides)
    command.arguments.insert(command.arguments.end(), {"--set", text});
  ProgressCaller observer(progress, parallel::Communicator::world());
  runtime::Ending ending;
  try {
    without_lock([&] { ending = app::run(command, parallel::Communicator::world(), std::ref(observer)); });
  } catch (const RunError&) {
    observer.raise();
    throw;
  }
  // A run that was nearly done has ended by itself, and Python has still to learn of the signal.
  if (const int signal = ending.interrupted() ? ending.signal : runtime::InterruptGuard::requested())
    hand_on(signal);
  if (ending.interrupted()) throw RunError(runtime::interrupted_by(ending.signal));
}

int rank() {
  start_mpi();
  return parallel::Communicator::world().rank();
}

std::string broadcast(const std::string& text) {
  start_mpi();
  return parallel::Communicator::world().broadcast(text);
}

/// A class of exceptions that stays for ever, because the interpreter ends before what is static.
py::handle new_exception(py::module_& module, const char* name, PyObject* base) {
  py::object type = py::exception<void>(module, name, base);
  type.attr("__module__") = "rhexis";
  return type.release();
}

/// With the text that the program prints.
void raise(const py::handle& type, const char* what) {
  PyErr_SetString(type.ptr(), printable(what, runtime::longest_message).c_str());
}

}  // namespace
}  // namespace rhexis::python

PYBIND11_MODULE(_rhexis, module) {
  using namespace rhexis::python;
  static const py::handle input_error = new_exception(module, "InputError", PyExc_ValueError);
  static const py::handle run_error = new_exception(module, "RunError", PyExc_RuntimeError);
  py::register_exception_translator([](std::exception_ptr thrown) {
    try {
      std::rethrow_exception(std::move(thrown));
    } catch (const rhexis::InputError& error) {
      raise(input_error, error.what());
    } catch (const rhexis::RunError& error) {
      raise(run_error, error.what());
    }
  });
  define_fields(module);
  module.attr("__version__") = rhexis::runtime::version();
  module.def("check", &check);
  module.def("run", &run);
  module.def("broadcast", &broadcast);
  module.def("rank", &rank, "The number of this process among those that mpirun has started, from 0.");
  module.def("end_mpi", &end_mpi);
}
