# SPDX-License-Identifier: BSD-3-Clause
"""Mutations of inputs: what slips of people, editors and file systems make of a file, and what somebody who means it does.

Every function takes a `random.Random` and a text or bytes, and returns another. They know the shape of lines, numbers
and quoted texts, not what keys mean.
"""

import re

NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:[eE][-+]?\d+)?")
QUANTITY = re.compile(r'"([-+]?\d[\d.eE+-]*) ([^"\n]+)"')
ASSIGNMENT = re.compile(r"^([^\s=#\[]+)\s*=\s*(.*)$")

NUMBERS = ("0", "-0.0", "-1", "1", "2", "0.5", "1e-300", "5e-324", "1e-9", "1e9", "1e18", "1e300", "1.7976931348623157e308", "1e309", "-1e300",
           "nan", "inf", "-inf", "+nan", "2147483647", "2147483648", "4294967296", "9223372036854775807", "9223372036854775808",
           "-9223372036854775808", "18446744073709551616", "0x7fffffff", "0b11", "0o17", "1_000", "1__0", "00", "1.", ".5", "1e", "1,5", "٣", "½")
UNITS = ("m", "mm", "um", "nm", "km", "cm", "s", "ms", "ns", "us", "Pa", "kPa", "MPa", "mmHg", "GPa", "kg", "degC", "%", "", "1", "mm mm", "1/s",
         "m^2",
         "mm2", "m3/s", "Pa s/m3", "kg/m3", "furlong", "mm^999", "m-1", "K @ 273.15", "mm mm^-1 mm", "((((mm))))", "(" * 200 + "m", "lg(re 1 mW)",
         "mm since 2000-01-01", "um\u0000", "µm", "μm", "Ω", "mm;", "e", "m" * 3000, "2 mm", "hm", "Ym", "ym", "Pa-", "--m", "m/0", "m^0.5")
VALUES = ("true", "false", "[]", "[[]]", "[[], []]", '""', "''", '" "', "{}", "{a = 1}", "1979-05-27", "1979-05-27T07:32:00Z", "07:32:00", "nan",
          "-inf",
          "0", "-1", "1e400", '"auto"', '"none"', '"0"', '"nan"', '"nan mm"', '"inf Pa"', '"1e400 mm"', '[1, "a"]', "[1, [2, [3]]]", "[nan]", "[inf, inf]",
          '["0 ms", "0 kPa"]', '[["0 ms", "0 kPa"]]', '[["0 ms", "0 kPa"], ["0 ms", "1 kPa"]]', '[["1 ms", "1 kPa"], ["0 ms", "1 kPa"]]',
          '[["0 ms", "1 kPa", "2 kPa"]]', '[["0 ms"], ["1 ms"]]', '[["nan s", "1 kPa"], ["1 s", "1 kPa"]]', "[" * 300 + "]" * 300, '"' + "x" * 70000 + '"',
          '"\\u0000"', '"\\uD800"', '"""a\nb"""', '"é"', '"\\"', '"../../../etc/passwd"', '"/dev/zero"', '"/dev/null"', '"."', '["."]', '["x.csv", "y.csv"]',
          "9223372036854775807", "-9223372036854775808", '"9e99 m"', '"1e-300 m"')
PIECES = ("é", "\u202e", "\ufeff", "\u0000", "\u2028", "🫀", "\ud7ff", "\x1b[31m", "\r", "\t", "\n",
          "\\", '"', "'", "#", "=", "[", "]", "[[", "}", ",", ";", ".", "\n[", '"""')


def mutate_number(random, text):
    """A number that may stand where `text` stood: one of the odd ones, or the same by a factor, a sign, or in the last digit."""
    if random.random() < 0.5:
        return random.choice(NUMBERS)
    try:
        value = float(text)
    except ValueError:
        return random.choice(NUMBERS)
    factor = random.choice((-1, 10, 0.1, 1000, 1e-3, 1e6, 1e-6, 1e15, 1e-15, 1.5, 0.7, 1 + 2.0**-52, 3))
    whole = re.fullmatch(r"[-+]?\d+", text) and random.random() < 0.7 and abs(value * factor) < 1e18
    return str(int(value * factor)) if whole else repr(value * factor)


def mild_number(random, text):
    """A number somewhat larger or smaller: most of these inputs are valid."""
    def replace(match):
        value = float(match.group()) * random.choice((0.5, 0.8, 0.9, 0.99, 1.01, 1.1, 1.3, 2, 4))
        return str(round(value)) if match.group().isdigit() else repr(value)
    return one_match(random, NUMBER, text, replace)


def without_line(random, text):
    """A key is not given."""
    rows = text.split("\n")
    del rows[random.choice([i for i, row in enumerate(rows) if ASSIGNMENT.match(row)] or [0])]
    return "\n".join(rows)


def one_match(random, pattern, text, replace):
    matches = list(pattern.finditer(text))
    if not matches:
        return text
    match = random.choice(matches)
    return text[: match.start()] + replace(match) + text[match.end():]


def number(random, text):
    return one_match(random, NUMBER, text, lambda match: mutate_number(random, match.group()))


def all_numbers(random, text):
    """Every number by one factor: a file in other units than it says."""
    factor = random.choice((1e-3, 1e3, 1e-6, 1e6, -1, 0, 1e150, 1e-150))
    return NUMBER.sub(lambda match: repr(float(match.group()) * factor), text)


def unit(random, text):
    return one_match(random, QUANTITY, text, lambda match: f'"{match.group(1)} {random.choice(UNITS)}"')


def bracketed_unit(random, text):
    return one_match(random, re.compile(r"\[[^\]\n]*\]"), text, lambda match: f"[{random.choice(UNITS)}]")


def quantity_without_quotes(random, text):
    return one_match(random, QUANTITY, text, lambda match: match.group()[1:-1])


def value(random, text):
    """Another value, of any type, for a key."""
    def replace(line):
        match = ASSIGNMENT.match(line)
        return f"{match.group(1)} = {random.choice(VALUES)}" if match else line
    return one_line(random, text, replace)


def array_for_scalar(random, text):
    def replace(line):
        match = ASSIGNMENT.match(line)
        if not match:
            return line
        key, old = match.groups()
        return f"{key} = " + random.choice((f"[{old}]", f"[{old}, {old}]", f"[[{old}]]", f"{{ value = {old} }}", f'"{old}"'))
    return one_line(random, text, replace)


def one_line(random, text, replace):
    lines = text.split("\n")
    place = random.randrange(len(lines))
    lines[place] = replace(lines[place])
    return "\n".join(lines)


def swap_values(random, text):
    """The values of two keys, exchanged."""
    lines = text.split("\n")
    keys = [i for i, line in enumerate(lines) if ASSIGNMENT.match(line)]
    if len(keys) < 2:
        return text
    a, b = random.sample(keys, 2)
    (key_a, value_a), (key_b, value_b) = (ASSIGNMENT.match(lines[i]).groups() for i in (a, b))
    lines[a], lines[b] = f"{key_a} = {value_b}", f"{key_b} = {value_a}"
    return "\n".join(lines)


def swap_words(random, text):
    """Two quoted texts, exchanged."""
    matches = list(re.finditer(r'"[^"\n]*"', text))
    if len(matches) < 2:
        return text
    a, b = sorted(random.sample(matches, 2), key=lambda match: match.start())
    return text[: a.start()] + b.group() + text[a.end(): b.start()] + a.group() + text[b.end():]


def lines(random, text):
    """A line is lost, repeated or moved, or two are exchanged."""
    rows = text.split("\n")
    place, other = random.randrange(len(rows)), random.randrange(len(rows))
    what = random.randrange(4)
    if what == 0:
        del rows[place]
    elif what == 1:
        rows.insert(other, rows[place])
    elif what == 2:
        rows.insert(other, rows.pop(place))
    else:
        rows[place], rows[other] = rows[other], rows[place]
    return "\n".join(rows)


def header(random, text):
    """A section is named twice, or otherwise, or is a list of sections, or of another section."""
    def replace(match):
        name = match.group(1)
        return random.choice((f"[[{name}]]", f"[{name}.more]", f"[{name}]\n[{name}]", f"[{name.upper()}]", f'["{name}"]', f"[ {name} ]", f"[{name}",
                              f"{name} = 1",
                              f"[[{name}]]\n[[{name}]]", f"[{name}é]", f"[}}{name}]", "[]", f'["{name}.x"]', f"{name}.key = 1\n[{name}]"))
    return one_match(random, re.compile(r"^\[+(\w+)\]+$", re.MULTILINE), text, replace)


def key_name(random, text):
    def replace(match):
        name = match.group(1)
        return random.choice((name + "s", name.upper(), name[:-1], f'"{name}"', f"'{name}'", f"a.{name}", f"{name}.b", "é" + name, name + "é", '""',
                              name.replace("_", "-"),
                              f"{name} {name}", f"{name} = {name}")) + " ="
    return one_match(random, re.compile(r"^(\w+) *=", re.MULTILINE), text, replace)


def piece(random, text):
    """Something odd, anywhere."""
    place = random.randrange(len(text) + 1)
    return text[:place] + random.choice(PIECES) + text[place:]


def csv_cell(random, text):
    """Another field in a table: empty, quoted, an odd number, a name used elsewhere."""
    def replace(line):
        cells = line.split(",")
        place = random.randrange(len(cells))
        anything = [cell for row in text.split("\n") for cell in row.split(",")]
        cells[place] = random.choice(("", '"', '"a""b"', '"a,b"', mutate_number(random, cells[place]), random.choice(anything),
                                      " " + cells[place] + " ", cells[place] + ",",
                                      '"unclosed', "in", "x" * 5000))
        return ",".join(cells)
    return one_line(random, text, replace)


def csv_separator(random, text):
    old, others = random.choice(((",", (";", "\t", " ", "|", ",,")), ("\n", ("\r\n", "\r", "\n\n"))))
    return text.replace(old, random.choice(others))


def json_token(random, text):
    """Another JSON value, or a name lost or doubled."""
    new = random.choice(("null", "true", "[]", "{}", '""', "-1", "1e999", "1e400", "0", '"in"', "[" * 2000, "{", "}", "]", "NaN", "Infinity",
                         '"\\ud800"', '{"a": {"a": {"a": 1}}}'))
    return one_match(random, re.compile(r'"[^"\n]*"|[-\d.]+|[\[\]{},:]|null'), text, lambda match: new)


MANIFEST_LINES = ("file ../scene.toml", "file /tmp/x", "folder ..", "folder .", "file mine.txt/..", "file", "run", "run x", "file a\tb",
                  "file images/../../scene.toml", "rhexis results 2", "folder images/..", "file " + "x" * 5000)


def manifest_line(random, text):
    """A line more, in the manifest of a results folder."""
    rows = text.split("\n")
    rows.insert(random.randrange(len(rows) + 1), random.choice(MANIFEST_LINES))
    return "\n".join(rows)


XML_VALUES = ("0", "-1", "1", "2", "7", "4000000000", "99999999999999", "-2000000000", "Float32", "Int8", "UInt64", "String", "ascii", "binary",
              "appended", "BigEndian", "", "radius", "PolyData", "nan")
XML_TAGS = ("", "<Piece", "</Piece", "<Lines", "</Lines", "<Verts", "<Polys", "<AppendedData", "<DataArray")


def xml_token(random, text):
    """An attribute or a name of VTK's XML, otherwise."""
    if random.random() < 0.6:
        return one_match(random, re.compile(r'="[^"\n]*"'), text, lambda match: f'="{random.choice(XML_VALUES)}"')
    return one_match(random, re.compile(r"</?\w+|/>|>"), text, lambda match: random.choice(XML_TAGS))


def word(random, text):
    """Another word in a line of words: lost, doubled, an odd number, or one from elsewhere."""
    words = re.findall(r"\S+", text)
    replacement = random.choice(("", f"{random.choice(words)} {random.choice(words)}", random.choice(NUMBERS), random.choice(words)))
    return one_match(random, re.compile(r"\S+"), text, lambda match: replacement)


def bytes_anywhere(random, data):
    """Some bytes are lost, changed or added."""
    data = bytearray(data)
    for _ in range(random.choice((1, 1, 2, 4, 16))):
        place = random.randrange(len(data) + 1)
        what = random.randrange(4)
        if what == 0 and place < len(data):
            data[place] ^= 1 << random.randrange(8)
        elif what == 1 and place < len(data):
            data[place] = random.randrange(256)
        elif what == 2:
            data.insert(place, random.choice((0, 10, 34, 39, 44, 91, 93, 123, 127, 128, 192, 237, 255, random.randrange(256))))
        else:
            del data[place: place + random.choice((1, 2, 8, 64))]
    return bytes(data)


def truncated(random, data):
    return data[: random.randrange(len(data) + 1)]


def other_encoding(random, data):
    return data.decode("utf-8", "replace").encode(random.choice(("utf-16", "utf-32", "latin-1", "utf-8-sig")), "replace")


TEXT = (number, number, number, piece, lines)
TOML = (*TEXT, unit, unit, quantity_without_quotes, value, value, array_for_scalar, swap_values, swap_words, header, key_name, all_numbers)
CSV = (*TEXT, csv_cell, csv_cell, csv_cell, csv_separator, bracketed_unit, all_numbers)
JSON = (*TEXT, json_token, json_token, json_token, swap_words, key_name)
WORDS = (*TEXT, word, word, word, all_numbers)
VTP = (number, lines, xml_token, xml_token, xml_token)
BYTES = (bytes_anywhere, bytes_anywhere, truncated, other_encoding)
MANIFEST = (lines, piece, manifest_line, manifest_line)
BY_ENDING = {".txt": MANIFEST, ".toml": TOML, ".csv": CSV, ".json": JSON, ".vtp": VTP, ".graphml": (*VTP, piece), ".dat": WORDS, ".vtk": WORDS,
             ".swc": WORDS}


def other_word(random, text, keys):
    """Another of the words that a key allows, for one that stands in the file."""
    section, places = "", []
    for i, line in enumerate(text.split("\n")):
        section = line.strip("[]") if line.startswith("[") else section
        match = ASSIGNMENT.match(line)
        if match and keys.get(f"{section}.{match.group(1)}"):
            places.append((i, match.group(1), keys[f"{section}.{match.group(1)}"]))
    if not places:
        return text
    place, name, words = random.choice(places)
    rows = text.split("\n")
    rows[place] = f"{name} = {random.choice(words)}"
    return "\n".join(rows)


def new_value(random, words):
    """Anything for a key that has these words: one of them, most often."""
    quantity = f"{random.choice(NUMBERS)} {random.choice(UNITS)}"
    return random.choice((random.choice(VALUES), random.choice(NUMBERS), f'"{quantity}"', *[random.choice(words or VALUES)] * 3))


def add_key(random, text, keys):
    """One of the program's keys, most often of a section that the file has, where that begins or at the end."""
    sections = set(re.findall(r"^\[+(\w+)\]+$", text, re.MULTILINE))
    fitting = [key for key in sorted(keys) if key.split(".")[0] in sections]
    key = random.choice(fitting if fitting and random.random() < 0.7 else sorted(keys))
    section, name = key.split(".")
    new = new_value(random, keys[key])
    place = re.search(rf"^\[\[?{section}\]\]?$", text, re.MULTILINE)
    if place:
        return f"{text[: place.end()]}\n{name} = {new}{text[place.end():]}"
    brackets = ("[[", "]]") if section in ("spot", "condition") else ("[", "]")
    return f"{text}\n{brackets[0]}{section}{brackets[1]}\n{name} = {new}\n"


def mutate_file(random, name, text, keys):
    """A file as bytes, after one to three mutations; the names of those."""
    told = []
    ending = name[name.rindex("."):]
    mild = random.random() < 0.4
    for _ in range(random.choice((1, 1, 1, 2, 3))):
        mutation = random.choice((*[mild_number] * 5, without_line, other_word, add_key) if mild else (*BY_ENDING[ending], add_key, other_word))
        if mutation in (add_key, other_word):
            if ending != ".toml":
                continue
            text = mutation(random, text, keys)
        else:
            text = mutation(random, text)
        told.append(mutation.__name__)
    data = text.encode("utf-8", "surrogatepass")
    if not mild and random.random() < 0.15:
        mutation = random.choice(BYTES)
        data = mutation(random, data)
        told.append(mutation.__name__)
    return data, told


ARGUMENTS = (*["{key}={value}"] * 8, "{key}", "={value}", "{key}=", "{key}=={value}", "{key}={value}={value}", "[{key}]={value}", " {key} = {value}",
             "spot[1].{name}={value}", "spot[99999999999].radius={value}", "{name}={value}", "x.{key}={value}", "{key}\n={value}", "{key}='{value}'",
             '{key}="{value}')


def argument(random, keys):
    """What may follow --set."""
    key = random.choice(sorted(keys))
    text = random.choice(ARGUMENTS).format(key=key, name=key.split(".")[1], value=new_value(random, keys[key]))
    return text.replace("\0", "\\0")[:100000]  # the system passes no NUL
