# SPDX-License-Identifier: BSD-3-Clause
"""Damage to an HDF5 file: of its bytes, and of what it holds, by h5py. Every function returns the names of what it damaged,
one of which a refusal must tell; none where nobody can say."""

import h5py
import numpy

OF_ATTRIBUTES = ("its numbers", "not a checkpoint")  # they have one checksum together; one says what the file is
NUMBERS = (0, -1, 1, 2, -4_600_000_000_000_000_000, 2**31, 2**62, -(2**63))
REALS = (float("nan"), float("inf"), -float("inf"), 1e308, -1e308, 5e-324, 0.0, -1.0, 1.0, 1e-9, 1e9)


def flip_bits(random, path):
    data = bytearray(path.read_bytes())
    # Half of the damage to where HDF5 keeps what it knows of its data: most of a file is numbers.
    end = len(data) if random.random() < 0.5 else min(len(data), 12000)
    for _ in range(random.choice((1, 1, 3, 10, 50))):
        data[random.randrange(end)] ^= 1 << random.randrange(8)
    path.write_bytes(data)


def overwrite(random, path):
    """A block of zeros, of other bytes, or of another part: a sector that was not written."""
    data = bytearray(path.read_bytes())
    size = random.choice((1, 8, 64, 512, 4096))
    begin, other = random.randrange(len(data)), random.randrange(len(data))
    data[begin: begin + size] = random.choice((bytes(size), b"\xff" * size, random.randbytes(size), data[other: other + size]))
    path.write_bytes(data)


def truncate(random, path):
    data = path.read_bytes()
    path.write_bytes(data[: random.choice((0, 1, 100, len(data) - 1, len(data) // 2, random.randrange(len(data))))])


def extend(random, path):
    with open(path, "ab") as file:
        file.write(random.randbytes(random.choice((1, 100, 5000))))


def datasets(file):
    names = []
    file.visititems(lambda name, item: names.append(name) if isinstance(item, h5py.Dataset) else None)
    return names


def remove_dataset(random, path):
    with h5py.File(path, "r+") as file:
        name = random.choice(datasets(file))
        del file[name]
        return [name]


def rename_dataset(random, path):
    with h5py.File(path, "r+") as file:
        a, b = random.sample(datasets(file), 2)
        if random.random() < 0.5:  # exchanged
            file.move(a, "unused")
            file.move(b, a)
            file.move("unused", b)
        else:
            file.move(a, a + "_old")
        return [a, b]


def replace_dataset(random, path):
    """Other values, another type or another shape under the same name, with the attributes that it had."""
    with h5py.File(path, "r+") as file:
        name = random.choice(datasets(file))
        old, attributes = file[name][()], dict(file[name].attrs)
        new = random.choice((one_value, another_type, another_shape))(random, old)
        del file[name]
        file[name] = new
        for key, value in attributes.items():
            file[name].attrs[key] = value
        return [name]


def one_value(random, old):
    new = old.copy()
    place = random.randrange(new.size)
    if new.dtype.kind == "f":
        new.flat[place] = random.choice(REALS)
    else:
        new.flat[place] ^= 1 << random.randrange(8 * new.dtype.itemsize)
    return new if (new.tobytes() != old.tobytes()) else new[:0]


def another_type(random, old):
    return old.astype(random.choice(("f4", "i1", "S3", "f2", "u8", "c16")))


def another_shape(random, old):
    return random.choice((old[..., None], old[:-1], numpy.concatenate((old, old)), old.reshape(-1)[:1], numpy.array(1.0), old[:0]))


def remove_attribute(random, path):
    with h5py.File(path, "r+") as file:
        place, name = random.choice(attributes(file))
        del file[place].attrs[name]
        return [name, *OF_ATTRIBUTES]


def attributes(file):
    return [("/", name) for name in file.attrs] + [(place, name) for place in datasets(file) for name in file[place].attrs]


def replace_attribute(random, path):
    """Another number, type or shape; a text where there was a number."""
    with h5py.File(path, "r+") as file:
        place, name = random.choice(attributes(file))
        new = random.choice((random.choice(NUMBERS), random.choice(REALS), numpy.ones((3, 3)), numpy.zeros(100000 // 16), "text", "x" * 5000,
                             numpy.array([], "f8"), numpy.float32(1)))
        del file[place].attrs[name]
        file[place].attrs[name] = new
        return [name, *OF_ATTRIBUTES]


def change_text(random, path):
    """A byte of a text that is stored as numbers: the input's record."""
    with h5py.File(path, "r+") as file:
        texts = [name for name in datasets(file) if file[name].dtype == numpy.uint8]
        if not texts:
            return flip_bits(random, path)
        name = random.choice(texts)
        data = file[name][()]
        data[random.randrange(len(data))] = random.choice((0, 34, 44, 48, 57, 58, 91, 93, 123, 125, 255))
        file[name][...] = data
        return [name]


KINDS = (flip_bits, flip_bits, overwrite, overwrite, truncate, extend, remove_dataset, rename_dataset, replace_dataset, replace_dataset,
         remove_attribute, replace_attribute,
         replace_attribute, change_text)
