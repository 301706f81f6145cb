# SPDX-License-Identifier: BSD-3-Clause
"""Lives inside the plugin (embedded at build time): what stands between ParaView and the users' scripts.

ParaView prints a script's exception and goes on, on that rank alone; the other ranks then wait for it for ever.
So every call into a script is followed by `agree` (given by C++: the first non-empty text of all ranks),
and what one rank raised ends the call on all. Exceptions inside filters of a pipeline are noted by `note_exception`,
VTK's own errors by `note_message`. What can be told without running a script is told by inspection.py.
"""

import gc
import importlib
import importlib.util
import os
import re
import signal  # noqa: F401 (its first import may take over SIGINT; C++ undoes this once it has been here)
import sys
import traceback

import rhexis_inspection as inspection

sys.setdlopenflags(os.RTLD_LAZY)  # ParaView's many libraries load in half the time if functions are bound when called

from paraview.catalyst import detail, importers, v2_internals
from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper
from paraview.modules.vtkRemotingServerManager import vtkSMParaViewPipelineController, vtkSMProxyManager

HARMLESS = (
    "New time step is not after last time step",  # a producer gets data at a script's start and again at its first run
    "script may not depend on simulation data",
)
image_directory = ""  # set by C++
live = ""  # host:port of a listening ParaView, set by C++; empty: none
time_limit = ""  # e.g. "600 s", set by C++
is_root = True  # set by C++
scripts = {}  # module name -> path
images = []  # what the extractors of imported scripts write
noted = None  # of this rank: the first exception or error that ParaView swallowed, as (reason, frames of Python)
warnings = {}  # what VTK warned of, each text once -> whether it was told


class ScriptFailed(Exception):
    """All ranks know already: ParaView should stop here and print nothing."""


class TimeIsUp(BaseException):
    """Raised by C++ in a script that takes longer than insitu.time_limit; no `except Exception` catches it."""


def describe(reason, frames, path=""):
    """One line: script, line number and reason; `path` if no frame is of a script."""
    folders = {os.path.dirname(path) for path in scripts.values()}
    own = [frame for frame in frames if os.path.dirname(frame.filename) in folders]
    if not own:
        return f"Catalyst script {path}: {reason}"
    # A helper's line says what is wrong, the script's own line says whose fault it is: name the script's where it has one.
    named = [frame for frame in own if frame.filename in scripts.values()] or own
    return f"Catalyst script {named[-1].filename}, line {named[-1].lineno}: {reason}"


def describe_exception(error):
    if isinstance(error, inspection.ScriptError):
        return str(error)
    reason = traceback.format_exception_only(type(error), error)[-1].strip()
    if isinstance(error, SyntaxError):
        return f"Catalyst script {error.filename}, line {error.lineno}: {reason}"
    if isinstance(error, TimeIsUp):
        reason = f"not done after {time_limit} (insitu.time_limit)"
    return describe(reason, traceback.extract_tb(error.__traceback__))


def note_exception(kind, error, trace):
    """sys.excepthook: for exceptions that ParaView would only print."""
    global noted
    if kind is not ScriptFailed and not noted:
        noted = (traceback.format_exception_only(kind, error)[-1].strip(), traceback.extract_tb(trace))


def note_message(is_error, text):
    """Called by C++ for what VTK and ParaView would print while a script runs."""
    global noted
    text = re.sub(r"^\w+ \(0x\w+\): | \(0x\w+\)", "", text).strip().split("\n")[0]
    if is_error and not noted:
        noted = ("VTK: " + text, traceback.extract_stack())
    elif not is_error and not text.startswith(HARMLESS):
        warnings.setdefault(text, False)


def take_noted(path, failed):
    """What went wrong while the script `path` ran, as text, empty if nothing. Tells of warnings, once, if nothing did."""
    global noted
    text, noted = describe(*noted, path) if noted else "", None
    for warning, told in warnings.items():
        if is_root and not told and not text and not failed:
            print(f"rhexis: warning: Catalyst script {path}: VTK: {warning}", file=sys.stderr, flush=True)
        warnings[warning] = True
    return text


def guarded(function):
    """The same function, but raising on all ranks if it raises (even SystemExit) on any."""

    def call(*arguments):
        failure, result = "", None
        try:
            result = function(*arguments)
        except BaseException as error:
            failure = describe_exception(error)
        failure = agree(failure)
        if failure:
            raise ScriptFailed(failure)
        return result

    return call


def register_script(path):
    """Registers under a name that is no other module's: a script may be called test.py or numpy.py, and so may two."""
    importers.install_pathfinder()
    folder = os.path.dirname(path)
    if folder not in sys.path:
        sys.path.append(folder)  # so that a script can import its neighbours
    stem = os.path.splitext(os.path.basename(path))[0]
    source = os.path.join(path, "__init__.py") if os.path.isdir(path) else path
    name = importers.add_file(source, f"catalyst_script_{len(scripts)}_{stem}")
    scripts[name] = source
    return name


def import_script(name):
    """As ParaView does it, except that a script without `options` is not made to wait for paraview.simple (0.5 s)."""
    module = importlib.import_module(name)
    if hasattr(module, "options"):
        options = module.options.SMProxy
    else:
        proxies = vtkSMProxyManager.GetProxyManager().GetActiveSessionProxyManager()
        options = proxies.NewProxy("coprocessing", "CatalystOptions")
    options.GetProperty("ExtractsOutputDirectory").SetElement(0, image_directory)
    if live and name == next(iter(scripts)):  # one script tells for all: a second connection would take the first one's place
        vtkSMParaViewPipelineController().InitializeProxy(options)  # without a trigger it would never be time
        options.GetProperty("EnableCatalystLive").SetElement(0, 1)
        options.GetProperty("CatalystLiveURL").SetElement(0, live)
    options.UpdateVTKObjects()
    vtkCPPythonScriptV2Helper.GetActiveInstance().SetOptions(options)
    module.image_directory = image_directory  # for scripts that write files themselves
    if "paraview.simple" in sys.modules:
        check_pipeline(scripts[name])
    return module


def line_of(path, text):
    """The first line of a script that holds a text, None where none does."""
    with open(path, encoding="utf-8", errors="replace") as file:
        return next((number for number, line in enumerate(file, 1) if text in line), None)


def check_pipeline(path):
    """What a script has built, where the names in it were computed or belong to data: files' names, colours' arrays."""
    manager = sys.modules["paraview.servermanager"].ProxyManager()
    known = {image.extractor for image in images}
    for (extractor, _), proxy in manager.GetProxiesInGroup("extractors").items():
        if extractor in known or not hasattr(proxy.Writer, "FileName"):
            continue
        image = inspection.Image(path, line_of(path, proxy.Writer.FileName), proxy.Writer.FileName)
        image.extractor = extractor
        inspection.refuse_outside(image)
        images.append(image)
    inspection.refuse_same_names(images)
    for proxy in manager.GetProxiesInGroup("representations").values():
        if hasattr(proxy, "ColorArrayName") and getattr(proxy, "Input", None):
            check_colours(path, proxy)


def check_colours(path, representation):
    """A representation that colours by an array which its data do not have would be drawn in one colour."""
    centring, name = representation.ColorArrayName.GetAssociation(), representation.ColorArrayName.GetArrayName()
    data = {"POINTS": "PointData", "CELLS": "CellData"}.get(centring)
    if not data or not name:
        return
    source = representation.Input
    if name in getattr(source, data).keys():
        return
    source.UpdatePipeline()
    arrays = getattr(source, data).keys()
    if name not in arrays and source.GetDataInformation().GetNumberOfPoints() > 0:
        raise inspection.ScriptError(path, line_of(path, name), f"colours by '{name}', which the data do not have; "
                                     f"there are: {', '.join(arrays)}{inspection.suggestion(name, arrays)}")  # fmt: skip


def channel_of_results(file):
    """Asked while a script is at work."""
    helper = vtkCPPythonScriptV2Helper.GetActiveInstance()
    return inspection.channel_of_results(file, helper.GetScriptFileName() if helper else None)


def channel_read(frame):
    """The channel whose saved results the source being made in ParaView's `_create_func` would read, None of any other."""
    values = frame.f_locals.get("params", {})
    files = [file for name in inspection.FILE_ARGUMENTS for file in inspection.strings(values.get(name))]
    return next(filter(None, map(channel_of_results, files)), None)


def is_insitu_input(name):
    """As ParaView's, but any reader of results is a source of the run, whatever name it is registered under."""
    return original_is_insitu_input(channel_read(sys._getframe(1)) or name)


def create_producer(name):
    return original_create_producer(channel_read(sys._getframe(1)) or name)


class ReaderWatch:
    """Sees paraview.servermanager being imported (0.1 s, which no script is made to wait for), and watches readers from then on."""

    def find_spec(self, name, path=None, target=None):
        if name != "paraview.servermanager":
            return None
        sys.meta_path.remove(self)
        spec = importlib.util.find_spec(name)
        execute = spec.loader.exec_module

        def execute_and_watch(module):
            execute(module)
            watch_readers(module)

        spec.loader.exec_module = execute_and_watch
        return spec


def watch_readers(servermanager):
    """Whatever way a reader is made: it reads no results in place of the run's, and no file that is not there."""
    update = servermanager.FileNameProperty._UpdateProperty

    def update_file_names(self):
        files = inspection.strings(self.GetData()) if self.Proxy.GetXMLGroup() == "sources" else []
        for file in filter(None, files):
            channel = channel_of_results(file)
            if channel:
                raise RuntimeError(inspection.saved_file_reason(file, channel))
            if not os.path.exists(file):
                raise FileNotFoundError(f"there is no file '{file}'; for what the program computes, write "
                                        'PVTrivialProducer(registrationName="particles") or "network"')  # fmt: skip
        update(self)

    servermanager.FileNameProperty._UpdateProperty = update_file_names


def refuse_to_end(name):
    """os._exit and os.abort would end the program without a word, and without its record."""
    end, program = getattr(os, name), os.getpid()

    def refuse(*arguments):
        if os.getpid() == program:
            raise RuntimeError(f"os.{name} would end the program; raise an exception to end the run")
        end(*arguments)

    setattr(os, name, refuse)


def request_data_description(module, description):
    """Asked at every step, so ranks meet only for scripts that have a say in it."""
    return hasattr(module, "RequestDataDescription") and do_request_data_description(module, description)


def forget_scripts():
    """Lets go of all that the scripts made, while ParaView is still there to take it back."""
    for name in scripts:
        module = sys.modules.pop(name, None)
        if module is not None:
            vars(module).clear()
    scripts.clear()
    images.clear()
    gc.collect()


v2_internals.register_module = register_script
v2_internals.import_and_validate = guarded(import_script)
do_request_data_description = guarded(v2_internals.do_request_data_description)
v2_internals.do_request_data_description = request_data_description
for step in ("do_catalyst_initialize", "do_catalyst_execute", "do_catalyst_finalize"):
    setattr(v2_internals, step, guarded(getattr(v2_internals, step)))
original_is_insitu_input, original_create_producer = detail.IsInsituInput, detail.CreateProducer
detail.IsInsituInput, detail.CreateProducer = is_insitu_input, create_producer
for name in ("_exit", "abort"):
    refuse_to_end(name)
sys.meta_path.insert(0, ReaderWatch())
sys.excepthook = note_exception
