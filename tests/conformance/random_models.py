"""Random models and options for `bspc encode`, the same for the same seed."""

from __future__ import annotations

import math
import random
import struct

import random_meshes

PLY_TYPES = {
    "char": ("b", -128, 127),
    "uchar": ("B", 0, 255),
    "short": ("h", -32768, 32767),
    "ushort": ("H", 0, 65535),
    "int": ("i", -(1 << 31), (1 << 31) - 1),
    "uint": ("I", 0, (1 << 32) - 1),
    "float": ("f", 0, 0),
    "double": ("d", 0, 0),
}
METHODS = ("kd", "fast", "fast", "fast", "octree", "gencode", "bsp", "predictive")
Point = tuple[float, float, float]


def _shape(rng: random.Random, n: int) -> list[Point]:
    kind = rng.randrange(8)
    size = rng.choice((1, 3, 12, 100, 1000, 30000))
    if kind == 0:  # anywhere
        return [tuple(float(rng.randrange(size)) for _ in range(3)) for _ in range(n)]
    if kind == 1:  # a terrain, row by row
        side = max(1, math.isqrt(n))
        phase = rng.random()
        return [
            (float(i % side), float(i // side), float(round(size / 9 * math.sin(phase + i % side / 9 + i // side / 7))))
            for i in range(n)
        ]
    if kind == 2:  # a sphere
        points = []
        for _ in range(n):
            v = [rng.gauss(0, 1) for _ in range(3)]
            length = math.sqrt(sum(x * x for x in v)) or 1.0
            points.append(tuple(float(round(size * x / length)) for x in v))
        return points
    if kind == 3:  # a line along an axis, in steps that repeat
        axis, step = rng.randrange(3), rng.randrange(1, 9)
        return [tuple(float(i * step if k == axis else 5) for k in range(3)) for i in range(n)]
    if kind == 4:  # clusters
        centres = [[rng.uniform(-size, size) for _ in range(3)] for _ in range(1 + n // 50)]
        return [tuple(float(round(rng.gauss(x, 2))) for x in rng.choice(centres)) for _ in range(n)]
    if kind == 7:  # a smooth surface, in no order
        curve, tilt = rng.uniform(0, 4e-3), rng.uniform(-1, 1)
        places = [(rng.randrange(size), rng.randrange(size)) for _ in range(n)]
        heights = [round(tilt * x + curve * y * y) for x, y in places]
        turn = rng.randrange(3)
        rows = [(float(x), float(y), float(z)) for (x, y), z in zip(places, heights)]
        return [r[turn:] + r[:turn] for r in rows]
    if kind == 5:  # not on a lattice
        return [tuple(rng.uniform(-size, size) for _ in range(3)) for _ in range(n)]
    few = [tuple(rng.randrange(size) / 8 for _ in range(3)) for _ in range(max(1, n // 20))]
    return [rng.choice(few) for _ in range(n)]  # with repetitions


def _mirrored(rng: random.Random) -> list[Point]:
    """Points and their copies in a plane, some of them a step off or missing."""
    points: list[Point] = []
    for _ in range(rng.choice((12, 30, 60))):
        p = [float(rng.randrange(s)) for s in (50, 80, 30)]
        copy = [100 - p[0], p[1] + rng.choice((0, 0, 0, 1)), p[2]]
        points.append((p[0], p[1], p[2]))
        if rng.randrange(8):
            points.append((copy[0], copy[1], copy[2]))
    return points


def _column(rng: random.Random, points: list[Point], kind: str) -> list[float]:
    """Values of an array of a PLY type."""
    letter, low, high = PLY_TYPES[kind]
    way = rng.randrange(5)
    n = len(points)
    if way == 0:
        values = [7.0] * n
    elif way == 1:
        values = [float(i) for i in range(n)]
    elif way == 2:
        scale = rng.choice((0.01, 1, 50))
        values = [scale * (p[0] + 0.5 * p[1] - p[2]) for p in points]
    elif way == 3:
        few = [rng.uniform(-100, 100) for _ in range(rng.randrange(1, 9))]
        values = [rng.choice(few) for _ in range(n)]
    else:
        values = [rng.uniform(-1e6, 1e6) for _ in range(n)]
    if letter in "fd":
        return values
    return [min(max(round(v), low), high) for v in values]


def _normals(rng: random.Random, points: list[Point]) -> list[list[float]]:
    rows = []
    for p in points:
        v = [x + 0.3 * rng.gauss(0, 1) + 0.1 for x in p]
        length = math.sqrt(sum(x * x for x in v)) or 1.0
        rows.append([x / length for x in v])
    return [list(c) for c in zip(*rows)]


def ply(rng: random.Random, points: list[Point], faces: list) -> tuple[bytes, list[str]]:
    """A binary PLY file, and the names of its arrays of floats."""
    coordinate = rng.choice(("float", "double", "float", "int"))
    if coordinate == "int":
        points = [tuple(float(round(x)) for x in p) for p in points]
    columns = [(name, coordinate, [p[k] for p in points]) for k, name in enumerate("xyz")]
    if coordinate == "int":
        columns = [(n, t, [int(v) for v in c]) for n, t, c in columns]
    floats = []
    for a in range(rng.randrange(4)):
        kind = rng.choice(list(PLY_TYPES))
        columns.append((f"a{a}", kind, _column(rng, points, kind)))
        if kind in ("float", "double"):
            floats.append(f"a{a}")
    if rng.randrange(3) == 0:
        kind = rng.choice(("float", "double"))
        columns += [(n, kind, c) for n, c in zip(("nx", "ny", "nz"), _normals(rng, points))]
        floats.append("Normals")
    if rng.randrange(3) == 0:
        columns += [(n, "uchar", _column(rng, points, "uchar")) for n in ("red", "green", "blue")]
    header = ["ply", "format binary_little_endian 1.0", f"element vertex {len(points)}"]
    header += [f"property {kind} {name}" for name, kind, _ in columns]
    if faces:
        header += random_meshes.ply_header(faces)
    row = struct.Struct("<" + "".join(PLY_TYPES[kind][0] for _, kind, _ in columns))
    body = b"".join(row.pack(*values) for values in zip(*(c for _, _, c in columns)))
    if faces:
        body += random_meshes.ply_body(faces)
    return ("\n".join(header) + "\nend_header\n").encode() + body, floats


def _grid_options(rng: random.Random, method: str) -> list[str]:
    wish = rng.randrange(6)
    if method in ("bsp", "octree", "gencode"):
        return ["--bits", str(rng.randrange(1, 21))] if wish < 3 else []
    if wish == 0:
        return ["--bits", str(rng.randrange(1, 33))]
    if wish == 1:
        return ["--precision", str(rng.choice((0.5, 0.01, 3.0)))]
    return ["--exact"] if wish == 2 else []


def _surface(rng: random.Random) -> tuple[bytes, list[str]]:
    """A mesh whose vertices are coded along its faces."""
    points, faces = random_meshes.relief(rng)
    if rng.randrange(4) == 0:  # vertices without faces
        points = points + [tuple(float(rng.randrange(99)) for _ in range(3)) for _ in range(rng.randrange(9))]
    data, _ = ply(rng, points, faces)
    options = ["--method", "surface", *_grid_options(rng, "surface")]
    for chance, more in (
        (4, ["--layers", "3"]),
        (4, ["--layout", "streaming"]),
        (6, ["--keep-order"]),
        (6, ["--tile-points", "30"]),
    ):
        if rng.randrange(chance) == 0:
            options += more
    return data, options


def model(seed: int) -> tuple[bytes, list[str]]:
    """The bytes of a PLY file and options of `bspc encode`."""
    rng = random.Random(seed)
    if seed % 10 == 7:
        return _surface(rng)
    method = rng.choice(METHODS)
    many = {"bsp": (300,), "fast": (600, 3000, 4096, 9000)}.get(method, (600, 1500, 5000))
    n = rng.choice((1, 2, 5, 40, 41, 150, rng.choice(many)))
    if method == "predictive":  # takes the second decoder long
        n = rng.choice((1, 2, 5, 15, 40))
    points, faces = _shape(rng, n), []
    if method != "predictive" and rng.randrange(4) == 0:
        points, faces = random_meshes.mesh(rng)
    if method == "predictive" and rng.randrange(3) == 0:
        points = _mirrored(rng)
        n = len(points)
    data, floats = ply(rng, points, faces)
    options = ["--method", method]
    if method == "fast":
        options = ["--effort", str(rng.randrange(1, 5))]
    if method == "predictive":
        options = ["--effort", str(rng.randrange(5, 10))]
    options += _grid_options(rng, method)
    options += ["--layers", str(rng.choice((1, 1, 2, 3, 7)))]
    if rng.randrange(3) == 0:
        options += ["--tile-points", str(max(1, n // 3))]
    if rng.randrange(3) == 0:
        options += ["--layout", "streaming"]
    if rng.randrange(3) == 0:
        options.append("--keep-order")
    elif rng.randrange(4) == 0:
        options.append("--original-ids")
    for name in floats:
        if rng.randrange(2) == 0:
            options += ["--array-precision", f"{name}={rng.choice((0.5, 0.01, 4.0))}"]
    if method in ("bsp", "kd") and rng.randrange(4) == 0:
        options += rng.choice((["--stop-points", "3"], ["--stop-level", "7"]))
    if rng.randrange(5) == 0:
        options += ["--crs", "EPSG:25832"]
    return data, options
