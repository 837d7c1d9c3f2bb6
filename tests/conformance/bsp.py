"""Method bsp of docs/format.md, section 11."""

from __future__ import annotations

from math import isqrt

from elementary import require
from partition_methods import CountModels, StopRule
from range_coder import AdaptiveBit, AdaptiveSymbol, RangeDecoder, stream_of

Vector = tuple[int, int, int]
Edge = tuple[int, int, int, int]  # from, to, face on the left, face on the right
Face = tuple  # plane, whether the cell is in front, whether an axis face

BELL = [1024, 1022, 1016, 1006, 992, 975, 954, 931, 904, 874, 842, 808, 773, 736, 698, 660, 621]
BELL += [582, 544, 506, 469, 433, 398, 364, 332, 302, 273, 247, 221, 198, 177, 157, 139]


def quotient(a: int, b: int) -> int:
    """Towards zero."""
    return a // b if (a >= 0) == (b > 0) else -(-a // b)


def rounded(a: int, b: int) -> int:
    return (2 * a + b) // (2 * b)


def root(v: int) -> int:
    return isqrt(v) if v > 0 else 0


def dot(a: Vector, b: Vector) -> int:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def minus(a: Vector, b: Vector) -> Vector:
    return (a[0] - b[0], a[1] - b[1], a[2] - b[2])


def direction(e: Vector) -> Vector:
    length = root(dot(e, e))
    if length == 0:
        return (1 << 14, 0, 0)
    return tuple(rounded(x << 14, length) for x in e)


class Polyhedron:
    def __init__(self, vertices: list[Vector], edges: list[Edge], faces: dict[int, Face]) -> None:
        self.vertices, self.edges = vertices, edges
        self.faces = faces  # by number: (plane, whether the cell is in front, whether an axis face)

    @classmethod
    def of_box(cls, extent: list[int]) -> "Polyhedron":
        size = [256 * (e + 1) for e in extent]
        vertices = [tuple(size[k] if i >> k & 1 else 0 for k in range(3)) for i in range(8)]
        edges = []
        for k in range(3):
            a, b = (k + 1) % 3, (k + 2) % 3
            for c in range(4):
                at_a, at_b = c % 2, c // 2
                start = at_a << a | at_b << b
                sides = (2 * a + at_a, 2 * b + at_b)
                edges.append((start, start + (1 << k), *(sides if at_a == at_b else sides[::-1])))
        return cls(vertices, edges, {f: (None, False, True) for f in range(6)})

    def oblique(self) -> list[Face]:
        return [f for f in self.faces.values() if not f[2]]

    def too_large(self, crossed: int) -> bool:
        return (
            len(self.vertices) + crossed > 64
            or len(self.edges) + crossed > 128
            or len(self.faces) + 1 > 48
        )


class Plane:
    def __init__(self, normal: Vector, offset: int, axis: int | None = None, at: int | None = None) -> None:
        self.normal, self.offset, self.axis, self.at = normal, offset, axis, at

    @classmethod
    def across(cls, axis: int, at: int) -> "Plane":
        return cls(tuple(int(k == axis) for k in range(3)), 2 * at, axis, at)

    def in_front(self, p: Vector) -> bool:
        return dot(self.normal, (2 * p[0] + 1, 2 * p[1] + 1, 2 * p[2] + 1)) >= self.offset


def crossing(a: Vector, b: Vector, height_a: int, height_b: int, plane: Plane) -> Vector:
    part, whole = abs(height_a), abs(height_a) + abs(height_b)
    shift = max(whole.bit_length() - 32, 0)
    part, whole = part >> shift, whole >> shift
    t = (part << 30) // whole
    point = [a[k] + (((b[k] - a[k]) * t + (1 << 29)) >> 30) for k in range(3)]
    if plane.axis is not None:
        point[plane.axis] = 256 * plane.at
    return tuple(point)


def side_of(polyhedron: Polyhedron, plane: Plane, heights: list[int], front: bool) -> Polyhedron:
    """The polyhedron of a side, and the polyhedron's old vertices in it."""
    number, vertices = {}, []
    for v, vertex in enumerate(polyhedron.vertices):
        if (heights[v] >= 0) == front:
            number[v] = len(vertices)
            vertices.append(vertex)
    edges, exits, entries = [], [], []
    for a, b, left, right in polyhedron.edges:
        if a in number and b in number:
            edges.append((number[a], number[b], left, right))
        elif a in number or b in number:
            new = len(vertices)
            vertices.append(
                crossing(polyhedron.vertices[a], polyhedron.vertices[b], heights[a], heights[b], plane)
            )
            edges.append((number.get(a, new), number.get(b, new), left, right))
            starts = a in number
            exits.append((left if starts else right, new))
            entries.append((right if starts else left, new))
    faces = {f: polyhedron.faces[f] for edge in edges for f in edge[2:]}
    face = max(polyhedron.faces) + 1
    for of, start in exits:
        at = next((i for i, e in enumerate(entries) if e is not None and e[0] == of), None)
        if at is None:
            continue
        edges.append((start, entries[at][1], of, face))
        entries[at] = None
    faces[face] = (plane, front, plane.axis is not None)
    return Polyhedron(vertices, edges, faces)


def volume(side: Polyhedron, bits: int) -> int:
    shift = max(bits - 15, 0)
    first = side.vertices[0]
    at = [tuple(x >> shift for x in minus(v, first)) for v in side.vertices]
    starts = {}
    for a, _, left, right in side.edges:
        starts.setdefault(left, at[a])
        starts.setdefault(right, at[a])
    return abs(sum(dot(minus(starts[l], starts[r]), cross(at[a], at[b])) for a, b, l, r in side.edges))


class Cell:
    __slots__ = ("lower", "upper", "points", "level", "history", "polyhedron")

    def __init__(
        self, lower: Vector, upper: Vector, points: int, level: int, history: int, polyhedron: Polyhedron | None
    ) -> None:
        self.lower, self.upper, self.points = lower, upper, points
        self.level, self.history, self.polyhedron = level, history, polyhedron

    def places(self) -> int:
        return box_places(self.lower, self.upper)

    def small(self) -> bool:
        return self.places() <= 64

    def representative(self) -> Vector:
        return tuple(l + (u - l) // 2 for l, u in zip(self.lower, self.upper))


def box_places(lower: Vector, upper: Vector) -> int:
    product = 1
    for l, u in zip(lower, upper):
        product *= max(u - l + 1, 0)
    return product


class Bsp:
    def __init__(self, points: int, extent: list[int], version: int) -> None:
        require(version == 0, "unknown version of bsp", "unsupported")
        require(all(e < 1 << 21 for e in extent), "extents above 21 bits")
        self.started = False
        self.gaussians = {}
        self.place_counts = CountModels()
        self.share = CountModels()
        self.deeper = AdaptiveBit()
        self.cells = [Cell((0, 0, 0), tuple(extent), points, 0, 0, Polyhedron.of_box(extent))]

    def layer(self, payload: bytes, last: bool) -> tuple[list[Vector], list[int]]:
        coder = stream_of(payload)
        if not self.started:
            self._read_parameters(coder)
        if last:
            points = []
            for cell in self.cells:
                self._finish(coder, cell, points)
            coder.finish()
            return points, [1] * len(points)
        while any(self._divisible(c) for c in self.cells) and coder.adaptive(self.deeper):
            self.cells = [s for c in self.cells for s in self._next(coder, c)]
        coder.finish()
        return [c.representative() for c in self.cells], [c.points for c in self.cells]

    def _read_parameters(self, coder: RangeDecoder) -> None:
        self.started = True
        self.bits_less, self.planes_above, slack_class = (3, 5, 7), 10, 0
        self.stop = StopRule()
        if coder.raw(1):
            self.bits_less = tuple(coder.raw(5) for _ in range(3))
            self.planes_above = coder.raw(5)
            slack_class = coder.raw(3)
            self.stop = StopRule.read(coder)
        self.slack = 1 << 31 if slack_class == 7 else 6 * 8**slack_class

    def _next(self, coder: RangeDecoder, cell: Cell) -> list[Cell]:
        """A cell of the list one level deeper."""
        if self._divisible(cell):
            return self._cut(coder, cell)
        cell.level += 1
        return [cell]

    def _divisible(self, cell: Cell) -> bool:
        return not cell.small() and not self.stop.stops(cell.points, cell.level)

    def _gaussian(self, coder: RangeDecoder, size: int, context: tuple) -> int:
        key = (size, context)
        if key not in self.gaussians:
            start = [
                10 + BELL[32 * abs(2 * i - (size - 1)) // (size - 1)] // 128 for i in range(size)
            ]
            self.gaussians[key] = AdaptiveSymbol(size, start, 16, 32768)
        return coder.symbol(self.gaussians[key])

    def _cut(self, coder: RangeDecoder, cell: Cell) -> list[Cell]:
        polyhedron = cell.polyhedron
        if cell.level >= 160:
            polyhedron = None
        if polyhedron is not None and cell.points >= 2:
            plane = self._coded_plane(coder, cell)
        else:
            plane = self._middle_plane(cell)
        if polyhedron is not None:
            sides, divided, ratio = self._cut_polyhedron(cell, polyhedron, plane)
            if sides is None:
                plane = self._middle_plane(cell)
                polyhedron = None
        if polyhedron is None:
            sides = [(*self._cut_box(cell.lower, cell.upper, plane, front), None) for front in (True, False)]
            divided = True
            ratio = [box_places(s[0], s[1]) for s in sides]
        counts, history = self._share_points(coder, cell, sides, ratio)
        result = []
        for (lower, upper, part), count in zip(sides, counts):
            if count == 0:
                continue
            if count == 1 and divided and part is not None and not part.oblique():
                part = None
            result.append(Cell(lower, upper, count, cell.level + 1, history, part))
        return result

    @staticmethod
    def _middle_plane(cell: Cell) -> Plane:
        lengths = [cell.upper[k] - cell.lower[k] for k in range(3)]
        axis = lengths.index(max(lengths))
        return Plane.across(axis, cell.lower[axis] + lengths[axis] // 2 + 1)

    @staticmethod
    def _cut_box(lower: Vector, upper: Vector, plane: Plane, front: bool) -> tuple[Vector, Vector]:
        lower, upper = list(lower), list(upper)
        if front:
            lower[plane.axis] = max(lower[plane.axis], plane.at)
        else:
            upper[plane.axis] = min(upper[plane.axis], plane.at - 1)
        return tuple(lower), tuple(upper)

    def _cut_polyhedron(
        self, cell: Cell, polyhedron: Polyhedron, plane: Plane
    ) -> tuple[list | None, bool, list[int] | None]:
        heights = [2 * dot(plane.normal, v) - 256 * plane.offset for v in polyhedron.vertices]
        in_front = sum(h >= 0 for h in heights)
        if in_front in (0, len(heights)):
            full = in_front > 0
            sides = []
            for front in (True, False):
                if front != full:
                    sides.append((cell.lower, minus(cell.lower, (1, 1, 1)), None))
                    continue
                box = (cell.lower, cell.upper)
                if plane.axis is not None:
                    box = self._cut_box(*box, plane, front)
                sides.append((*box, polyhedron))
            return sides, False, [0, 0]
        crossed = sum((heights[a] >= 0) != (heights[b] >= 0) for a, b, _, _ in polyhedron.edges)
        if polyhedron.too_large(crossed):
            return None, True, None
        sides, ratio = [], []
        greatest = 0
        for k in range(3):
            along = [v[k] for v in polyhedron.vertices]
            greatest = max(greatest, max(along) - min(along))
        for front in (True, False):
            part = side_of(polyhedron, plane, heights, front)
            sides.append((*self._side_box(cell, part, plane, front), part))
            ratio.append(volume(part, (greatest + 1).bit_length()))
        return sides, True, ratio

    def _side_box(self, cell: Cell, part: Polyhedron, plane: Plane, front: bool) -> tuple[Vector, Vector]:
        lower, upper = cell.lower, cell.upper
        if plane.axis is not None:
            lower, upper = self._cut_box(lower, upper, plane, front)
        lows, highs = [], []
        for k in range(3):
            along = [v[k] for v in part.vertices]
            lows.append(max(lower[k], -((128 + self.slack - min(along)) // 256)))
            highs.append(min(upper[k], (max(along) - 128 + self.slack) // 256))
        return tuple(lows), tuple(highs)

    def _share_points(
        self, coder: RangeDecoder, cell: Cell, sides: list, ratio: list[int]
    ) -> tuple[tuple[int, int], int]:
        n, history = cell.points, cell.history
        empty = [box_places(s[0], s[1]) == 0 for s in sides]
        require(not all(empty), "both sides of a cell are empty")
        if empty[0]:
            return (0, n), history
        if empty[1]:
            return (n, 0), history
        if n == 1:
            f, g = ratio
            while f >= 1 << 40 or g >= 1 << 40:
                f, g = f >> 1, g >> 1
            p = ((f + 1) << 16) // (f + g + 2)
            front = coder.bit(min(max(p, 1536), 64000))
            return (front, 1 - front), history
        if n <= 64:
            front = self._gaussian(coder, n + 1, ("few", n, history))
        else:
            z = n.bit_length()
            b = self._gaussian(coder, 64, ("many", z))
            first, end = -(-b * (n + 1) // 64), -(-(b + 1) * (n + 1) // 64)
            front = first + coder.uniform(end - first - 1)
        return (front, n - front), int(front in (0, n))

    def _parameter(self, coder: RangeDecoder, which: int, bits: int) -> int:
        if bits == 0:
            return 0
        top = min(bits, 6)
        q = self._gaussian(coder, 1 << top, ("parameter", which, top))
        for_rest = bits - top
        if for_rest:
            q = q << for_rest | coder.raw(for_rest)
        t = 2 * q + 1 - (1 << bits)
        x = (t * t << 14) // 4**bits
        return x if t >= 0 else -x

    def _coded_plane(self, coder: RangeDecoder, cell: Cell) -> Plane:
        vertices = cell.polyhedron.vertices
        bits = (0, 0, 0)
        if cell.level < self.planes_above:
            log = cell.points.bit_length() - 1
            bits = tuple(max(0, min(16, log - less)) for less in self.bits_less)
        pairs = [(i, j) for i in range(len(vertices)) for j in range(i + 1, len(vertices))]
        edges = [minus(vertices[j], vertices[i]) for i, j in pairs]
        squares = [dot(e, e) for e in edges]
        best = squares.index(max(squares))
        start, along = vertices[pairs[best][0]], edges[best]
        u = direction(along)
        normal = u
        x_phi = x_psi = 0
        if bits[0] or bits[1]:
            across = []
            for e in edges:
                length = dot(e, u) >> 14
                across.append(tuple(e[k] - (u[k] * length >> 14) for k in range(3)))
            squares = [dot(e, e) for e in across]
            v = direction(across[squares.index(max(squares))])
            w = tuple(x >> 14 for x in cross(u, v))
            x_phi = self._parameter(coder, 0, bits[0])
            x_psi = self._parameter(coder, 1, bits[1])
            sine = quotient(x_phi, 2)
            cosine = quotient(x_psi * abs(sine), 1 << 14)
            f = root((1 << 28) - sine * sine)
            e = root(sine * sine - cosine * cosine)
            e = -e if sine < 0 else e
            normal = tuple((f * u[k] + cosine * v[k] + e * w[k]) >> 14 for k in range(3))
        x_alpha = self._parameter(coder, 2, bits[2])
        a = (1 << 13) + rounded(3 * x_alpha, 10)
        at = tuple(start[k] + (along[k] * a >> 14) for k in range(3))
        normal = tuple((x + 2) >> 2 for x in normal)
        return Plane(normal, rounded(2 * dot(normal, at), 256))

    def _finish(self, coder: RangeDecoder, cell: Cell, points: list[Vector]) -> None:
        stack = [cell]
        while stack:
            cell = stack.pop()
            if self.stop.stops(cell.points, cell.level):
                points += [cell.representative()] * cell.points
            elif cell.points == 1 and cell.polyhedron is None and self.stop.level is None:
                points.append(
                    tuple(l + coder.uniform(u - l) for l, u in zip(cell.lower, cell.upper))
                )
            elif cell.small():
                self._places(coder, cell, points)
            else:
                stack += reversed(self._cut(coder, cell))

    def _places(self, coder: RangeDecoder, cell: Cell, points: list[Vector]) -> None:
        if cell.points == 1 and cell.polyhedron is None:
            points.append(tuple(l + coder.uniform(u - l) for l, u in zip(cell.lower, cell.upper)))
            return
        planes = cell.polyhedron.oblique() if cell.polyhedron else []
        (x0, y0, z0), (x1, y1, z1) = cell.lower, cell.upper
        places = []
        for z in range(z0, z1 + 1):
            for y in range(y0, y1 + 1):
                for x in range(x0, x1 + 1):
                    if all(plane.in_front((x, y, z)) == front for plane, front, _ in planes):
                        places.append((x, y, z))
        require(places, "a cell without places")
        self._share_places(coder, places, cell.points, points)

    def _share_places(self, coder: RangeDecoder, places: list[Vector], n: int, points: list[Vector]) -> None:
        m = len(places)
        if n == 0:
            return
        if m == 1:
            points += places * n
        elif n == 1:
            points.append(places[coder.part(m)])
        else:
            first = self.place_counts.lower_count(coder, n, m.bit_length(), min(3, 4 * n // (m + 1)))
            self._share_places(coder, places[: m // 2], first, points)
            self._share_places(coder, places[m // 2 :], n - first, points)
