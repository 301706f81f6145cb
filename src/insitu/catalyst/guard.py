"""Lives inside the plugin (embedded at build time): what stands between ParaView and the users' scripts.

ParaView prints a script's exception and goes on, on that rank alone; the other ranks then wait for it for ever.
So every call into a script is followed by `agree` (given by C++: the first non-empty text of all ranks),
and what one rank raised ends the call on all. Exceptions inside filters of a pipeline are noted by `note_exception`.
"""

import ast
import gc
import importlib
import os
import sys
import traceback

sys.setdlopenflags(os.RTLD_LAZY)  # ParaView's many libraries load in half the time if functions are bound when called

from paraview.catalyst import importers, v2_internals
from paraview.modules.vtkPVPythonCatalyst import vtkCPPythonScriptV2Helper
from paraview.modules.vtkRemotingServerManager import vtkSMProxyManager

CHANNELS = [("particles", "particles.xdmf"), ("network", "network.xdmf")]
FIELD_LISTS = ["fields", "network_fields"]  # what a script calls the fields that it needs of each channel
EXAMPLES = {"fields": "damage", "network_fields": "pressure"}
image_directory = ""  # set by C++
scripts = {}  # module name -> path
noted = None  # of this rank: the first exception that ParaView swallowed, with its trace


class ScriptFailed(Exception):
    """All ranks know already: ParaView should stop here and print nothing."""


def describe(error, trace, path=""):
    """One line: script, line number and what Python says of the exception; `path` if the trace names no script."""
    reason = traceback.format_exception_only(type(error), error)[-1].strip()
    if isinstance(error, SyntaxError):
        return f"Catalyst script {error.filename}, line {error.lineno}: {reason}"
    frames = [frame for frame in traceback.extract_tb(trace) if os.path.isabs(frame.filename)]
    folders = {os.path.dirname(path) for path in scripts.values()}
    own = [frame for frame in frames if os.path.dirname(frame.filename) in folders]
    if not own:
        return f"Catalyst script {path}: {reason}"
    # A helper's line says what is wrong, the script's own line says whose fault it is: name the script's where it has one.
    named = [frame for frame in own if frame.filename in scripts.values()] or own
    return f"Catalyst script {named[-1].filename}, line {named[-1].lineno}: {reason}"


def note_exception(kind, error, trace):
    """sys.excepthook: for exceptions that ParaView would only print."""
    global noted
    if kind is not ScriptFailed and not noted:
        noted = (error, trace)


def take_noted(path):
    """What happened while the script `path` ran, as text, empty if nothing."""
    global noted
    text, noted = describe(*noted, path) if noted else "", None
    return text


def guarded(function):
    """The same function, but raising on all ranks if it raises (even SystemExit) on any."""

    def call(*arguments):
        failure, result = "", None
        try:
            result = function(*arguments)
        except BaseException as error:
            failure = describe(error, error.__traceback__)
        failure = agree(failure)
        if failure:
            raise ScriptFailed(failure)
        return result

    return call


def register_script(path):
    """Registers under a name that is no other module's: a script may be called test.py or numpy.py."""
    importers.install_pathfinder()
    folder = os.path.dirname(path)
    if folder not in sys.path:
        sys.path.append(folder)  # so that a script can import its neighbours
    stem = os.path.splitext(os.path.basename(path))[0]
    source = os.path.join(path, "__init__.py") if os.path.isdir(path) else path
    name = importers.add_file(source, "catalyst_script_" + stem)
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
    options.UpdateVTKObjects()
    vtkCPPythonScriptV2Helper.GetActiveInstance().SetOptions(options)
    module.image_directory = image_directory  # for scripts that write files themselves
    return module


def request_data_description(module, description):
    """Asked at every step, so ranks meet only for scripts that have a say in it."""
    return hasattr(module, "RequestDataDescription") and do_request_data_description(module, description)


def read_source(source, path):
    try:
        with open(source, encoding="utf-8") as file:
            return ast.parse(file.read(), source)
    except OSError as error:
        raise RuntimeError(f"Catalyst script {path}: {error.strerror}") from None
    except (SyntaxError, ValueError) as error:
        raise RuntimeError(describe(error, None, path)) from None


def declared_list(tree, name, path):
    """The list of strings that a script assigns to `name`, None where it does not."""
    for node in tree.body:
        if isinstance(node, ast.Assign) and any(getattr(target, "id", "") == name for target in node.targets):
            try:
                return [str(item) for item in ast.literal_eval(node.value)]
            except (ValueError, TypeError):
                raise RuntimeError(
                    f"Catalyst script {path}, line {node.lineno}: "
                    f'{name} must be a list of names, e.g. {name} = ["{EXAMPLES[name]}"]'
                ) from None
    return None


def named_channels(tree):
    """The names by which a script asks for sources: registrationName="...", GetTrivialProducer("...")."""
    names = set()
    for call in ast.walk(tree):
        if isinstance(call, ast.Call):
            candidates = [word.value for word in call.keywords if word.arg in ("registrationName", "guiName")]
            if getattr(call.func, "attr", "") == "GetTrivialProducer":
                candidates += call.args
            names |= {node.value for node in candidates if isinstance(node, ast.Constant)}
    return names


def inspect(path):
    """Reads a script without running it: of each channel whether it is wanted, required, and which fields (None: all)."""
    sources = [path]
    if os.path.isdir(path):
        parts = sorted(name for name in os.listdir(path) if name.endswith(".py") and name != "__init__.py")
        sources = [os.path.join(path, name) for name in ["__init__.py", *parts]]
    trees = [read_source(source, path) for source in sources]
    named = set().union(*map(named_channels, trees))
    declared = [declared_list(trees[0], name, path) for name in FIELD_LISTS]
    required = [fields is not None or not named.isdisjoint(names) for fields, names in zip(declared, CHANNELS)]
    anything = not any(required)  # it says nothing that can be read here: it gets whatever there is
    return [(asked or anything, asked, fields) for asked, fields in zip(required, declared)]


def forget_scripts():
    """Lets go of all that the scripts made, while ParaView is still there to take it back."""
    for name in scripts:
        module = sys.modules.pop(name, None)
        if module is not None:
            vars(module).clear()
    scripts.clear()
    gc.collect()


v2_internals.register_module = register_script
v2_internals.import_and_validate = guarded(import_script)
do_request_data_description = guarded(v2_internals.do_request_data_description)
v2_internals.do_request_data_description = request_data_description
for step in ("do_catalyst_initialize", "do_catalyst_execute", "do_catalyst_finalize"):
    setattr(v2_internals, step, guarded(getattr(v2_internals, step)))
sys.excepthook = note_exception
