# SPDX-License-Identifier: BSD-3-Clause
"""What can be told of users' Catalyst scripts without running them; embedded in the plugin at build time.

`rhexis check` and `rhexis run` read the scripts here before anything is written. Scripts are parsed, never executed,
so only literals are seen: what a script computes is checked when it has been imported (guard.py).
"""

import ast
import difflib
import importlib.util
import os
import re

CHANNELS = ["particles", "network"]
FIELD_LISTS = ["fields", "network_fields"]  # what a script calls the fields that it needs of each channel
EXAMPLES = {"fields": "damage", "network_fields": "pressure", "saved_files": "earlier/particles.xdmf"}
FILE_ARGUMENTS = ("FileName", "FileNames", "filename")  # of ParaView's readers and OpenDataFile
POINT_ARRAYS = ("PointArrayStatus", "PointArrays")
CELL_ARRAYS = ("CellArrayStatus", "CellArrays")
NO_WRITERS_OF_POLYGONS = ("VTU", "VTPD", "VTI", "VTR", "VTS")  # extractors that the channels' vtkPolyData does not fit
RESULT_NAME = re.compile(r"(particles|network)(_from_\d+)?\.(xdmf|xmf|h5|vtkhdf)")
RESULT_GRID = re.compile(rb'<Grid Name="(particles|network)"')
XDMF = (".xdmf", ".xmf")
saved_files = {}  # path of an inspected script -> files that it means to read as they are


class ScriptError(Exception):
    """What is wrong with a script: the message names the script, and the line where there is one."""

    def __init__(self, path, line, reason):
        place = f", line {line}" if line else ""
        super().__init__(f"Catalyst script {path}{place}: {reason}")


class Wish:
    """What one script wants of one channel: whether it is lent it, whether it fails without it, which fields (None: all)."""

    def __init__(self):
        self.line = None  # of the first mention of the channel
        self.wanted = False
        self.fields = None


class Image:
    """The name of an extractor's files as the script writes it, e.g. "damage_{timestep:06d}.png"."""

    def __init__(self, path, line, name):
        self.path, self.line, self.name = path, line, name

    def example(self):
        """One file of this name: names that differ only in how they are written give the same."""
        try:
            return os.path.normpath(self.name.format(timestep=123456, time=0.125, camera=""))
        except (IndexError, KeyError, ValueError):
            return os.path.normpath(self.name)


def channel_of_file(name):
    """The channel that a file of results holds, recognised by its name or its contents; None for any other file."""
    match = RESULT_NAME.fullmatch(os.path.basename(name))
    if not match and name.endswith(XDMF):
        try:
            with open(name, "rb") as file:
                match = RESULT_GRID.search(file.read(2000))
        except OSError:
            return None
    found = match and match.group(1)
    return found.decode() if isinstance(found, bytes) else found


def channel_of_results(name, script):
    """As channel_of_file, but None of a saved file that the script means to read as it is."""
    return None if name in saved_files.get(script, []) else channel_of_file(name)


def literal(node):
    """The value of a literal expression, None of any other."""
    try:
        return ast.literal_eval(node)
    except (ValueError, TypeError, SyntaxError):
        return None


def strings(value):
    """The strings in a literal: one alone, or those of a list."""
    values = value if isinstance(value, (list, tuple)) else [value]
    return [item for item in values if isinstance(item, str)]


def called(call):
    """The last name of what is called: "XDMFReader" of simple.XDMFReader(...)."""
    return getattr(call.func, "attr", getattr(call.func, "id", ""))


def argument(call, *names):
    return next((word.value for word in call.keywords if word.arg in names), None)


def plural(names):
    return ", ".join(names)


def suggestion(name, known):
    near = difflib.get_close_matches(name.lower(), known, 1)
    return f"; did you mean '{near[0]}'?" if near else ""


class Script:
    """One script, or package: its syntax trees, and what they say."""

    def __init__(self, path):
        self.path = path
        self.sources = [path]
        if os.path.isdir(path):
            parts = sorted(name for name in os.listdir(path) if name.endswith(".py") and name != "__init__.py")
            self.sources = [os.path.join(path, name) for name in ["__init__.py", *parts]]
        self.trees = [self.parse(source) for source in self.sources]
        saved_files[path] = self.declared_list("saved_files")[0] or []
        self.wishes = {channel: Wish() for channel in CHANNELS}
        self.readers = {}  # name of a variable -> channel that it stands for
        self.images = {}  # expression that stands for an extractor -> its Image
        self.read_sources()
        self.read_arrays()
        self.read_extractors()
        for channel, name in zip(CHANNELS, FIELD_LISTS):
            fields, line = self.declared_list(name)
            if fields is not None:
                self.wishes[channel].fields = [(field, line) for field in fields]
                self.wishes[channel].line = self.wishes[channel].line or line
        named = any(wish.line for wish in self.wishes.values())
        for wish in self.wishes.values():
            wish.wanted = bool(wish.line) or not named  # it says nothing that can be read here: it gets whatever there is

    def fail(self, line, reason, source=None):
        raise ScriptError(source or self.path, line, reason)

    def parse(self, source):
        try:
            with open(source, "rb") as file:
                return ast.parse(file.read(), source)
        except OSError as error:
            raise ScriptError(self.path, None, error.strerror) from None
        except SyntaxError as error:
            raise ScriptError(source, error.lineno, f"{type(error).__name__}: {error.msg}") from None
        except ValueError as error:
            raise ScriptError(source, None, f"ValueError: {error}") from None

    def nodes(self, kind):
        """All nodes of a kind, each with the file that it stands in."""
        for source, tree in zip(self.sources, self.trees):
            for node in ast.walk(tree):
                if isinstance(node, kind):
                    yield node, source

    def declared_list(self, name):
        """The list of strings that a script assigns to `name`, and its line; None where it does not."""
        for node in self.trees[0].body:
            if isinstance(node, ast.Assign) and any(getattr(target, "id", "") == name for target in node.targets):
                value = literal(node.value)
                if isinstance(value, (list, tuple, set)):
                    return [str(item) for item in value], node.lineno
                self.fail(node.lineno, f'{name} must be a list of names, e.g. {name} = ["{EXAMPLES[name]}"]')
        return None, None

    def channel_of_call(self, call, source):
        """The channel that a call makes a source of, None if it does not."""
        name = literal(argument(call, "registrationName", "guiName") or ast.Constant(None))
        if called(call) == "GetTrivialProducer" and call.args:
            name = literal(call.args[0])
        if isinstance(name, str):
            for channel in CHANNELS:
                if name in (channel, channel + ".xdmf"):
                    return channel
            if called(call) in ("PVTrivialProducer", "GetTrivialProducer"):
                hint = suggestion(name, CHANNELS)
                self.fail(call.lineno, f"there is no channel '{name}'; there are: {plural(CHANNELS)}{hint}", source)
        return self.channel_of_files(call, source)

    def channel_of_files(self, call, source):
        files = argument(call, *FILE_ARGUMENTS)
        if files is None and called(call) in ("OpenDataFile", "SetFileName") and call.args:
            files = call.args[0]
        for file in strings(literal(files or ast.Constant(None))):
            channel = channel_of_results(file, self.path)
            if channel and called(call) == "SetFileName":
                self.fail(call.lineno, saved_file_reason(file, channel), source)
            if channel:
                return channel
        return None

    def read_sources(self):
        """Which channels are asked for, and the variables that stand for them."""
        for call, source in self.nodes(ast.Call):
            channel = self.channel_of_call(call, source)
            if channel:
                wish = self.wishes[channel]
                wish.line = wish.line or call.lineno
        for assignment, source in self.nodes(ast.Assign):
            if isinstance(assignment.value, ast.Call) and isinstance(assignment.targets[0], ast.Name):
                channel = self.channel_of_call(assignment.value, source)
                if channel:
                    self.readers[assignment.targets[0].id] = channel

    def read_arrays(self):
        """Fields from what an exported script selects of a file: reader.PointArrayStatus = ["damage"]."""
        selected = {}
        for assignment, _ in self.nodes(ast.Assign):
            target = assignment.targets[0]
            if not (isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name)):
                continue
            if target.attr in POINT_ARRAYS + CELL_ARRAYS and target.value.id in self.readers:
                value = literal(assignment.value)
                centring = "cell" if target.attr in CELL_ARRAYS else "point"
                if isinstance(value, (list, tuple)):
                    selected.setdefault(target.value.id, {})[centring] = [(str(name), assignment.lineno) for name in value]
        for channel, needed in zip(CHANNELS, (["point"], ["point", "cell"])):
            lists = [selected.get(name, {}) for name, of in self.readers.items() if of == channel]
            if lists and all(centring in each for each in lists for centring in needed):
                fields = [field for each in lists for centring in needed for field in each[centring]]
                self.wishes[channel].fields = list(dict(reversed(fields)).items())[::-1]

    def read_extractors(self):
        for call, source in self.nodes(ast.Call):
            if called(call) != "CreateExtractor" or len(call.args) < 2:
                continue
            kind, of = literal(call.args[0]), getattr(call.args[1], "id", None)
            if kind in NO_WRITERS_OF_POLYGONS and of in self.readers:
                self.fail(call.lineno, f"an extractor '{kind}' cannot write {self.readers[of]}, which are points and lines "
                                       "(vtkPolyData); take 'VTP' (or 'CSV')", source)  # fmt: skip
        for assignment, source in self.nodes(ast.Assign):
            target, name = assignment.targets[0], literal(assignment.value)
            if not (isinstance(target, ast.Attribute) and target.attr == "FileName" and isinstance(name, str)):
                continue
            if getattr(target.value, "attr", "") == "Writer":
                image = Image(source, assignment.lineno, name)
                refuse_outside(image)
                self.images[source, ast.unparse(target.value.value)] = image


def saved_file_reason(file, channel):
    return (
        f"'{file}' holds saved results, which would be drawn in place of this run; write "
        f'PVTrivialProducer(registrationName="{channel}") for the run, or, if the saved file is meant, '
        f"name it at the top of the script: saved_files = ['{file}']"
    )


def refuse_outside(image):
    inside = os.path.normpath(image.name)
    if os.path.isabs(inside) or inside.split(os.sep)[0] == os.pardir:
        name = os.path.basename(inside)
        raise ScriptError(image.path, image.line, f"FileName '{image.name}' lies outside of the run's folder of images; "
                                                  f"files go there whatever their name, e.g. '{name}'")  # fmt: skip


def refuse_same_names(images):
    """Throws where files of two extractors, of one script or of two, would have one name."""
    seen = {}
    for image in images:
        other = seen.setdefault(image.example(), image)
        if other is not image:
            also = f"{other.path}, line {other.line}" if other.line else other.path
            raise ScriptError(image.path, image.line,
                              f"files named '{image.name}' are also written by {also}; give one of them another name")


def settle_channel(script, channel, wish, present):
    """The fields that a script gets of a channel, None where it does not want it; `present`: the names of the run's fields, by channel."""
    if channel not in present:
        if not wish.line:
            return None
        others = plural(list(present))
        raise ScriptError(script.path, None, f"asks for the channel '{channel}', which this run does not have; "
                                             f"there are: {others}")  # fmt: skip
    known = present[channel]
    for field, line in wish.fields or []:
        if field not in known:
            raise ScriptError(script.path, line, f"asks for the field '{field}'; "
                                                 f"there are: {plural(known)}{suggestion(field, known)}")  # fmt: skip
    if not wish.wanted:
        return None
    return known if wish.fields is None else [field for field, _ in wish.fields]


def missing_modules():
    """Why no script can run; empty where those can that need no modules but ParaView's and numpy."""
    for module, package in (("paraview", "python3-paraview"), ("numpy", "python3-numpy")):
        if importlib.util.find_spec(module) is None:
            return f"Python finds no module {module} (Debian: {package})"
    return ""


def inspect(paths, present):
    """Of each script a list of what it wants: (channel, names of fields). `present`: the names of the run's fields, by channel."""
    saved_files.clear()
    for path in paths:
        if paths.count(path) > 1:
            raise ScriptError(path, None, "is named twice")
    scripts = [Script(path) for path in paths]
    refuse_same_names([image for script in scripts for image in script.images.values()])
    wanted = []
    for script in scripts:
        fields = {channel: settle_channel(script, channel, wish, present) for channel, wish in script.wishes.items()}
        wanted.append([(channel, names) for channel, names in fields.items() if names is not None])
    return wanted
