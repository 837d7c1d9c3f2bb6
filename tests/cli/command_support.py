"""What the tests of the `bspc` command share: running it, and model files in plain Python.

The environment variable BSPC names the command.
"""

import os
import random
import struct
import subprocess
import sys
import tempfile
import unittest

BSPC = os.environ.get("BSPC", "")
if not os.access(BSPC, os.X_OK):
    sys.exit("set the environment variable BSPC to the path of the bspc command")
BSPC = os.path.abspath(BSPC)

CODES = {
    "char": "b",
    "uchar": "B",
    "short": "h",
    "ushort": "H",
    "int": "i",
    "uint": "I",
    "float": "f",
    "double": "d",
}
SIZED_NAMES = {
    "int8": "char",
    "uint8": "uchar",
    "int16": "short",
    "uint16": "ushort",
    "int32": "int",
    "uint32": "uint",
    "float32": "float",
    "float64": "double",
}
FORMATS = ("ply", "obj", "off", "xyz", "csv")


def float32(value):
    """The float32 that is nearest, as Python's double."""
    return struct.unpack("<f", struct.pack("<f", value))[0]


def write_ply(path, rows, columns=None, scalar="float", encoding="binary_little_endian", tail=b""):
    """`columns` are (name, type); x, y, z of `scalar` if none are given. `tail` follows the rows."""
    columns = columns or [(axis, scalar) for axis in "xyz"]
    header = "ply\nformat %s 1.0\nelement vertex %d\n" % (encoding, len(rows))
    header += "".join("property %s %s\n" % (kind, name) for name, kind in columns)
    if tail:
        header += "element face 1\nproperty list uchar int vertex_indices\n"
    with open(path, "wb") as file:
        file.write((header + "end_header\n").encode("ascii"))
        if encoding == "ascii":
            for row in rows:
                file.write((" ".join(map(repr, row)) + "\n").encode("ascii"))
        else:
            order = "<" if encoding == "binary_little_endian" else ">"
            record = struct.Struct(order + "".join(CODES[kind] for _, kind in columns))
            for row in rows:
                file.write(record.pack(*row))
        file.write(tail)


def read_ply(path):
    """(columns, rows) of the vertices; columns are (name, type)."""
    with open(path, "rb") as file:
        return parse_ply(file.read())


def parse_ply(data):
    start = data.index(b"end_header\n") + len(b"end_header\n")
    columns, count, encoding, in_vertices = [], 0, "", False
    for words in (line.split() for line in data[:start].decode("ascii").splitlines()):
        if words[0] == "format":
            encoding = words[1]
        elif words[0] == "element":
            in_vertices = words[1] == "vertex"
            count = int(words[2]) if in_vertices else count
        elif words[0] == "property" and in_vertices:
            columns.append((words[-1], SIZED_NAMES.get(words[1], words[1])))
    if encoding == "ascii":
        lines = data[start:].decode("ascii").splitlines()
        return columns, [tuple(map(float, line.split())) for line in lines[:count]]
    order = "<" if encoding == "binary_little_endian" else ">"
    record = struct.Struct(order + "".join(CODES[kind] for _, kind in columns))
    return columns, list(record.iter_unpack(data[start : start + record.size * count]))


def column(path, name):
    columns, rows = read_ply(path)
    at = [column_name for column_name, _ in columns].index(name)
    return [row[at] for row in rows]


def write_text(path, rows, kind):
    lines = [tuple(map(repr, row)) for row in rows]
    if kind == "obj":
        text = "".join("v %s %s %s\n" % line for line in lines)
    elif kind == "off":
        text = "OFF\n%d 0 0\n" % len(rows) + "".join("%s %s %s\n" % line for line in lines)
    elif kind == "xyz":
        text = "".join("%s %s %s\n" % line for line in lines)
    else:
        text = "x,y,z\n" + "".join("%s,%s,%s\n" % line for line in lines)
    with open(path, "w", encoding="ascii") as file:
        file.write(text)


def write_las(path, counts, scale, offset, point_format=0, mark=0, attributes=None):
    """LAS 1.2; `counts` are triples of whole numbers of the scale. `mark` is set by compressors.

    `attributes` are what follows the positions in the records, by default zeros.
    """
    size = (20, 28, 26, 34)[point_format]
    header = struct.pack("<4s20xBB68xHIIBHI20x", b"LASF", 1, 2, 227, 227, 0, point_format | mark,
                         size, len(counts))
    with open(path, "wb") as file:
        file.write(header + struct.pack("<12d", *scale, *offset, *[0.0] * 6))
        for i, count in enumerate(counts):
            further = attributes[i] if attributes else bytes(size - 12)
            file.write(struct.pack("<3i", *count) + further)


def write_pcd(path, rows, height=1):
    """A binary PCD file of float32."""
    header = "VERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    header += "WIDTH %d\nHEIGHT %d\n" % (len(rows) // height, height)
    header += "VIEWPOINT 0 0 0 1 0 0 0\nPOINTS %d\nDATA binary\n" % len(rows)
    with open(path, "wb") as file:
        file.write(header.encode("ascii"))
        for row in rows:
            file.write(struct.pack("<3f", *row))


def read_points(path):
    """The positions of a model file, sorted, as doubles; in decoded files the order is free."""
    kind = os.path.splitext(path)[1][1:]
    if kind == "ply":
        columns, rows = read_ply(path)
        names = [name for name, _ in columns]
        axes = [names.index(axis) for axis in "xyz"]
        return sorted(tuple(float(row[axis]) for axis in axes) for row in rows)
    with open(path, encoding="ascii") as file:
        lines = file.read().splitlines()
    if kind == "csv":
        assert lines[0].split(",")[:3] == ["x", "y", "z"], lines[0]
        words = [line.split(",") for line in lines[1:]]
    elif kind == "obj":
        words = [line.split()[1:] for line in lines if line.startswith("v ")]
    elif kind == "off":
        count = int(lines[1].split()[0])
        words = [line.split() for line in lines[2 : 2 + count]]
    else:
        words = [line.split() for line in lines]
    return sorted(tuple(map(float, word[:3])) for word in words)


def lattice_cloud(count, seed=1, size=4096):
    """Random points with small whole coordinates."""
    source = random.Random(seed)
    return [tuple(float(int(size * source.random())) for _ in range(3)) for _ in range(count)]


def jittered_lattice(side, jitter=0.3, seed=1):
    """One point near every whole position of a cube: round() tells which it was."""
    source = random.Random(seed)
    return [
        tuple(c + jitter * (2 * source.random() - 1) for c in (x, y, z))
        for x in range(side)
        for y in range(side)
        for z in range(side)
    ]


def greatest_error(given, restored):
    """Between points that jittered_lattice() made and what came back of them."""
    by_place = {tuple(map(round, point)): point for point in restored}
    return max(
        abs(a - b) for point in given for a, b in zip(point, by_place[tuple(map(round, point))])
    )


class CommandTest(unittest.TestCase):
    """A test with a folder of its own, where input files are made and the command runs."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = folder.name

    def path(self, name):
        return os.path.join(self.folder, name)

    def files(self):
        return sorted(os.listdir(self.folder))

    def run_bspc(self, *arguments, **options):
        """The finished process; output and errors are bytes."""
        options.setdefault("stdout", subprocess.PIPE)
        options.setdefault("stderr", subprocess.PIPE)
        # A command that waits for input it was not promised fails instead of hanging.
        if "input" not in options:
            options.setdefault("stdin", subprocess.DEVNULL)
        return subprocess.run(
            [BSPC, *arguments], cwd=self.folder, timeout=120, check=False, **options
        )

    def succeed(self, *arguments, **options):
        """What the command wrote to standard output."""
        done = self.run_bspc(*arguments, **options)
        self.assertEqual(done.returncode, 0, (arguments, done.stderr))
        return done.stdout

    def fail_with(self, code, *arguments, **options):
        """The message of a command that must fail and leave the folder as it was."""
        before = self.files()
        done = self.run_bspc(*arguments, **options)
        message = done.stderr.decode("utf-8")
        self.assertEqual(done.returncode, code, (arguments, message))
        self.assertNotEqual(message.strip(), "", arguments)
        self.assertEqual(self.files(), before, arguments)
        return message

    def refuse(self, name, *arguments, **options):
        """The message of a command that must fail on account of the file `name`, in one line."""
        message = self.fail_with(1, *arguments, **options)
        self.assertEqual(message.count("\n"), 1, message)
        self.assertTrue(message.startswith("bspc: "), message)
        self.assertIn(name, message)
        return message

    def write_bytes(self, name, data):
        with open(self.path(name), "wb") as file:
            file.write(data)

    def read_bytes(self, name):
        with open(self.path(name), "rb") as file:
            return file.read()
