"""Random meshes for random_models.py."""

from __future__ import annotations

import math
import random
import struct

Point = tuple[float, float, float]


def patch(rng: random.Random) -> tuple[list[Point], list[list[int]]]:
    """A bumpy patch of triangles and quadrilaterals, maybe closed to a ring."""
    columns, rows = rng.randrange(2, 10), rng.randrange(2, 10)
    quads = rng.choice((0.0, 0.3, 1.0))
    bump = rng.choice((0, 1, 5))
    points = [
        (float(4 * x + rng.randrange(bump + 1)), float(4 * y), float(round(bump * math.sin(x + y))))
        for y in range(rows)
        for x in range(columns)
    ]
    ring = rng.randrange(3) == 0
    faces = []
    for y in range(rows - 1):
        for x in range(columns if ring and columns > 2 else columns - 1):
            a, b = y * columns + x, y * columns + (x + 1) % columns
            c, d = b + columns, a + columns
            if rng.random() < quads:
                faces.append([a, b, c, d])
            elif rng.randrange(2):
                faces += [[a, b, c], [a, c, d]]
            else:
                faces += [[a, b, d], [b, c, d]]
    return points, faces


def spoiled(rng: random.Random, points: list[Point], faces: list[list[int]]) -> tuple[list[Point], list[list[int]]]:
    """With seams, holes, faces turned around, twice or at random, in another order."""
    way = rng.randrange(8)
    if way == 0:  # every face with points of its own
        points = [points[v] for f in faces for v in f]
        starts = [sum(len(f) for f in faces[:i]) for i in range(len(faces))]
        faces = [list(range(s, s + len(f))) for s, f in zip(starts, faces)]
    elif way == 1:  # a seam
        twins = {v: len(points) + i for i, v in enumerate(range(0, len(points), 3))}
        points = points + [points[v] for v in twins]
        faces = [[twins.get(v, v) for v in f] if i % 2 else f for i, f in enumerate(faces)]
    elif way == 2:
        faces = [f[::-1] if rng.randrange(6) == 0 else f for f in faces]
    elif way == 3:
        faces = faces + [rng.choice(faces)] + [[rng.randrange(len(points)) for _ in range(rng.randrange(1, 6))]]
    elif way == 4:
        faces = [f for f in faces if rng.randrange(4)] or faces
    elif way == 5 and len(points) > 13:  # a face of many corners, a vertex without faces
        faces = [list(range(12))] + [f for f in faces if min(f) > 12]
    if rng.randrange(2):
        turns = [rng.randrange(len(f)) for f in faces]
        faces = [f[t:] + f[:t] for f, t in zip(faces, turns)]
        rng.shuffle(faces)
    return points, faces


def mesh(rng: random.Random) -> tuple[list[Point], list[list[int]]]:
    return spoiled(rng, *patch(rng))


def relief(rng: random.Random) -> tuple[list[Point], list[list[int]]]:
    """A patch far from the origin, finely measured: neighbours are many grid steps apart."""
    points, faces = mesh(rng)
    scale, noise = rng.choice((1.0, 40.0, 3000.0)), rng.choice((0.0, 1.0, 30.0))
    tilt, round_off = rng.uniform(-1, 1), rng.choice((0, 0, 2))

    def moved(p: Point) -> Point:
        x, y, z = (scale * v + rng.gauss(0, noise) for v in p)
        return round(x, round_off), round(y, round_off), round(z + tilt * x + 0.001 * y * y, round_off)

    # Points at the same place stay there.
    places = {p: moved(p) for p in points}
    return [places[p] for p in points], faces


def ply_header(faces: list[list[int]]) -> list[str]:
    return [f"element face {len(faces)}", "property list uchar int vertex_indices"]


def ply_body(faces: list[list[int]]) -> bytes:
    return b"".join(struct.pack(f"<B{len(f)}i", len(f), *f) for f in faces)
