#!/usr/bin/env python3
"""Writes the small models of Testing/Data, or checks that they are what this script makes.

usage: generate_test_data.py [--check]

The files are functions of this script alone: its random numbers are its own, and what it computes
with sine and cosine is rounded afterwards, so that the last bit of a mathematics library does not
show.
"""

import argparse
import math
import pathlib
import struct
import sys

DATA = pathlib.Path(__file__).resolve().parent.parent / "Testing" / "Data"


class Random:
    """A linear congruential generator (Knuth's MMIX constants), of which the high bits are used."""

    def __init__(self, seed):
        self.state = seed
        for _ in range(8):
            self._next()

    def _next(self):
        self.state = (self.state * 6364136223846793005 + 1442695040888963407) % 2**64
        return self.state >> 32

    def below(self, n):
        return self._next() * n >> 32

    def uniform(self, low=0.0, high=1.0):
        return low + (high - low) * self._next() / 2**32

    def bell(self):
        """About a normal distribution of deviation 1: twelve uniform numbers less their mean."""
        return sum(self._next() for _ in range(12)) / 2**32 - 6


def signed_power(base, exponent):
    return math.copysign(abs(base) ** exponent, base)


def superquadric_scan():
    """A rounded box, scanned from one side in rows, with noise along the ray."""
    random = Random(1)
    points = []
    rows, columns = 80, 62
    for row in range(rows):
        v = math.pi * ((row + 0.5) / rows - 0.5)
        for column in range(columns):
            u = math.pi * 1.3 * ((column + 0.5) / columns - 0.5)
            noise = 1 + 0.002 * random.bell()
            ring = signed_power(math.cos(v), 0.6)
            points.append(
                (
                    40 * noise * ring * signed_power(math.cos(u), 0.4),
                    30 * noise * ring * signed_power(math.sin(u), 0.4),
                    55 * noise * signed_power(math.sin(v), 0.6),
                )
            )
    return "float", points


def terrain_lines():
    """Hills seen from an aircraft: zigzag scan lines, UTM metres on a lattice of centimetres."""
    random = Random(2)
    points = []
    lines, shots = 72, 60
    for line in range(lines):
        for shot in range(shots):
            if random.below(50) == 0:
                continue  # no echo
            across = shot if line % 2 == 0 else shots - 1 - shot
            x = 90 * (across + 0.5) / shots + 0.02 * random.bell()
            y = 1.4 * (line + shot / shots) + 0.03 * random.bell()
            ground = 112 + 9 * math.sin(x / 31) * math.cos(y / 23) + 2.5 * math.sin(x / 7 + y / 11)
            canopy = random.uniform(3, 11) if x > 50 and random.below(3) == 0 else 0
            z = ground + canopy + 0.03 * random.bell()
            # Division by 100 gives the double nearest to the decimal, as reading text would.
            points.append(
                tuple(round(100 * c) / 100 for c in (500120.37 + x, 7027188.52 + y, z))
            )
    return "double", points


def depth_frame():
    """One frame of a depth camera that sees a floor, a wall and a ball; metres, to the millimetre."""
    random = Random(3)
    width, height, focal = 88, 66, 78.0
    centre, radius = (0.25, 0.1, 2.1), 0.45
    points = []
    for v in range(height):
        for u in range(width):
            ray = ((u - width / 2 + 0.5) / focal, (v - height / 2 + 0.5) / focal, 1.0)
            depth = 3.2 + 0.25 * ray[0]
            if ray[1] > 0:
                depth = min(depth, 1.1 / ray[1])
            a = sum(c * c for c in ray)
            b = sum(c * m for c, m in zip(ray, centre))
            root = b * b - a * (sum(m * m for m in centre) - radius * radius)
            if root > 0:
                depth = min(depth, (b - math.sqrt(root)) / a)
            edge = abs(root) < 0.01
            if random.below(8) == 0 if edge else random.below(60) == 0:
                continue  # the camera has holes, mostly along edges
            z = round(1000 * (depth + 0.002 * depth * random.bell()))
            points.append((round(ray[0] * z) / 1000, round(ray[1] * z) / 1000, z / 1000))
    return "float", points


def cad_symmetric():
    """A flange: plate, hub, bolt holes and ribs, the same on both sides of the plane x = 0."""
    half = []
    for i in range(26):
        for j in range(-12, 13):
            for z in (0.0, 4.0):
                x, y = 2.5 * i, 4.0 * j
                if math.hypot(x, y) > 18:
                    half.append((x, y, z))
    for ring in range(14):
        for step in range(25):
            angle = math.pi * (step / 24 - 0.5)
            for radius in (16.0, 12.0):
                half.append((radius * math.cos(angle), radius * math.sin(angle), 4 + 2.25 * ring))
    for x, y in ((52.5, 36.0), (52.5, -36.0)):
        for step in range(16):
            angle = 2 * math.pi * (step + 0.5) / 16
            for z in (0.0, 1.0, 2.0, 3.0, 4.0):
                half.append((x + 3.5 * math.cos(angle), y + 3.5 * math.sin(angle), z))
    for i in range(18):
        for k in range(10):
            if k <= 10 - i / 2:
                for y in (-1.5, 1.5):
                    half.append((18 + 1.5 * i, y, 5 + 1.5 * k))
    rounded = {tuple(round(1024 * c) / 1024 + 0.0 for c in p) for p in half}
    both = rounded | {(-x + 0.0, y, z) for x, y, z in rounded}
    return "float", sorted(both, key=lambda p: (p[2], p[1], p[0]))


def random_cube():
    """Nothing to find: 12 bits an axis, uniform."""
    random = Random(4)
    return "int", [tuple(random.below(4096) for _ in range(3)) for _ in range(4000)]


def duplicates():
    """Few places and many points: crowds on one spot, repeated lines, single points between."""
    random = Random(5)
    points = []
    for _ in range(12):
        centre = tuple(random.below(256) for _ in range(3))
        points += [centre] * (20 + random.below(150))
        for _ in range(60):
            points.append(tuple(c + random.below(3) for c in centre))
    for _ in range(2):
        points += [(5.0 * i, 64, 128) for i in range(100)]
    points += [tuple(random.below(256) for _ in range(3)) for _ in range(400)]
    # Shuffled, so that equal points are not neighbours in the file.
    for i in range(len(points) - 1, 0, -1):
        j = random.below(i + 1)
        points[i], points[j] = points[j], points[i]
    return "float", [tuple(float(c) for c in p) for p in points]


def line():
    """Points along the x axis at uneven distances; two extents are nothing at all."""
    random = Random(6)
    points, x = [], 0
    for _ in range(2000):
        points.append((x / 4, -7.5, 3.0))
        x += random.below(9)
    return "float", points


MODELS = (
    superquadric_scan,
    terrain_lines,
    depth_frame,
    cad_symmetric,
    random_cube,
    duplicates,
    line,
)
CODES = {"float": "f", "double": "d", "int": "i"}


def ply(scalar, points):
    header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % len(points)
    header += "".join("property %s %s\n" % (scalar, axis) for axis in "xyz") + "end_header\n"
    record = struct.Struct("<3" + CODES[scalar])
    return header.encode("ascii") + b"".join(record.pack(*point) for point in points)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n", maxsplit=1)[0])
    parser.add_argument("--check", action="store_true", help="compare with the files, write nothing")
    check = parser.parse_args().check
    wrong = 0
    for model in MODELS:
        path = DATA / (model.__name__ + ".ply")
        scalar, points = model()
        content = ply(scalar, points)
        if not check:
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(content)
        elif not path.exists() or path.read_bytes() != content:
            print("%s: not what this script makes" % path, file=sys.stderr)
            wrong += 1
        else:
            print("%s: %d points, %d bytes" % (path.name, len(points), len(content)))
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
