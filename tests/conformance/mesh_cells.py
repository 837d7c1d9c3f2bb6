"""The cells of a Mesh block, docs/format.md, section 15."""

from __future__ import annotations

from bisect import bisect_left

from elementary import require
from grid import AFFINE, RATIONAL, Grid
from mesh_faces import AdaptiveNumber, FaceDecoder, number
from mesh_front import Front, Position, Vertices
from range_coder import AdaptiveBits, AdaptiveSymbol, RangeDecoder, stream_of

Point = tuple[int, ...]
Cells = list[list[int]]


def places_of(points: list[Point], grid: Grid) -> list[Position]:
    steps = [1.0, 1.0, 1.0]
    if grid.form == RATIONAL:
        steps = [float(p) / float(q) for p, q in grid.steps]
    elif grid.form == AFFINE:
        steps = list(grid.steps)
    finest = min(steps)
    scale = [min(s / finest, 1048576.0) for s in steps]
    corner = [min((p[k] for p in points), default=0) for k in range(3)]
    return [tuple(float(p[k] - corner[k]) * scale[k] for k in range(3)) for p in points]


class Welding:
    """Points at the same place as one vertex."""

    def __init__(self, points: list[Point]):
        numbers: dict[Point, int] = {}
        self.members: Cells = []
        for i, p in enumerate(points):
            vertex = numbers.setdefault(p, len(numbers))
            if vertex == len(self.members):
                self.members.append([])
            self.members[vertex].append(i)


class PlainCells:
    """Irregular faces and lines."""

    def __init__(self, coder: RangeDecoder, vertices: Vertices, line: bool):
        self.coder, self.vertices, self.line = coder, vertices, line
        self.sizes, self.bits = AdaptiveNumber(), AdaptiveBits()
        self.last = 0

    def decode(self, count: int) -> Cells:
        return [self._cell() for _ in range(count)]

    def _cell(self) -> list[int]:
        places, doubled = self.vertices.places, self.vertices.doubled
        cell: list[int] = []
        for i in range(self.sizes.decode(self.coder)):
            require(places, "a cell without vertices to have")
            if i == 0:
                at = doubled[self.last]
            elif i == 1:
                at = doubled[cell[0]]
            else:
                x, y, first = places[cell[-2]], places[cell[-1]], places[cell[0]]
                at = tuple(2 * (2 * y[k] - x[k]) if self.line else y[k] + first[k] for k in range(3))
            cell.append(self._vertex(at, min(i, 2)))
        if cell:
            self.last = cell[-1]
        return cell

    def _vertex(self, at: Position, sort: int) -> int:
        for place, vertex in enumerate(self.vertices.nearest(at, 32, everyone=True)):
            if self.coder.adaptive(self.bits[sort, place]):
                return vertex
        return self.coder.uniform(len(self.vertices.places) - 1)


class Corners:
    """Which point of a welded vertex each corner has."""

    def __init__(self, coder: RangeDecoder, welding: Welding):
        self.coder, self.members = coder, welding.members
        self.used: set[int] = set()
        self.bits = AdaptiveBits()

    def of_front(self, front: Front) -> Cells:
        result: Cells = []
        for number_of_face, face in enumerate(front.faces):
            points: list[int] = []
            edge = "unknown"
            for i, vertex in enumerate(face):
                before, after = face[i - 1], face[(i + 1) % len(face)]
                left = self._across(front, result, number_of_face, (vertex, before), vertex)
                right = self._across(front, result, number_of_face, (after, vertex), vertex)
                lone = len(self.members[vertex]) == 1
                point = self.members[vertex][0] if lone else self._beside(vertex, left, right, edge)
                points.append(point)
                edge = "unknown" if right is None or lone else "same" if right == point else "other"
            result.append(points)
        return result

    @staticmethod
    def _across(
        front: Front, result: Cells, face: int, side: tuple[int, int], vertex: int
    ) -> int | None:
        """The point that an earlier face at a directed edge has at a vertex."""
        other = front.face_at(*side)
        if other is None or other >= face:
            return None
        return result[other][front.faces[other].index(vertex)]

    def _beside(self, vertex: int, left: int | None, right: int | None, edge: str) -> int:
        agree = 0 if left is None or right is None else 1 if left == right else 2
        if left is not None and self.coder.adaptive(self.bits["left", edge, agree]):
            return left
        if right is not None and right != left and self.coder.adaptive(self.bits["right", edge, agree]):
            return right
        return self._new(vertex)

    def _new(self, vertex: int) -> int:
        members = self.members[vertex]
        unused = next((m for m in members if m not in self.used), None)
        if unused is not None and self.coder.adaptive(self.bits["new"]):
            point = unused
        else:
            point = members[self.coder.uniform(len(members) - 1)]
        self.used.add(point)
        return point

    def alone(self, vertex: int) -> int:
        members = self.members[vertex]
        return members[0] if len(members) == 1 else self._new(vertex)


class FaceOrder:
    """The kept order of faces, and their first corners."""

    def __init__(self, coder: RangeDecoder, faces: Cells):
        self.coder, self.faces = coder, faces
        self.smallest = [f.index(min(f)) if f else 0 for f in faces]
        keys = [f[s] if f else 0 for f, s in zip(faces, self.smallest)]
        self.sorted = sorted(range(len(faces)), key=lambda i: (keys[i], i))
        self.place = {face: place for place, face in enumerate(self.sorted)}
        self.free = list(range(len(faces)))  # places whose face did not come yet
        self.edges: dict[tuple[int, int], int] = {}
        for i, f in enumerate(faces):
            for u, v in zip(f, f[1:] + f[:1]):
                self.edges[u, v] = i
        self.bits, self.jump = AdaptiveBits(), AdaptiveNumber()
        self.starts = [AdaptiveSymbol(3) for _ in range(3)]
        self.last_start, self.history = 0, 0
        self.used: set[int] = set()

    def decode(self) -> Cells:
        result: Cells = []
        last: int | None = None
        before: int | None = None
        for _ in self.faces:
            face = self._face(last, before)
            start = self._start(face)
            corners = self.faces[face]
            result.append(corners[start:] + corners[:start])
            self.used.add(face)
            del self.free[bisect_left(self.free, self.place[face])]
            before, last = last, face
        return result

    def _face(self, last: int | None, before: int | None) -> int:
        start = 0 if last is None else self.place[last]
        at = bisect_left(self.free, start)
        expected = self.free[at] if at < len(self.free) else self.free[0]
        candidates: list[tuple[int | None, int]] = [(self.sorted[expected], 0)]
        for of, sort in ((last, 1), (before, 5)):
            if of is not None:
                f = self.faces[of]
                for j in range(min(len(f), 4)):
                    i = (self.smallest[of] + j) % len(f)
                    candidates.append((self.edges.get((f[(i + 1) % len(f)], f[i])), sort + j))
        tried: set[int] = set()
        for face, sort in candidates:
            if face is None or face in self.used or face in tried:
                continue
            tried.add(face)
            if self.coder.adaptive(self.bits[sort, self.history]):
                self.history = (self.history << 1 | (sort > 0)) & 3
                return face
        place = expected + self.jump.decode_signed(self.coder)
        require(0 <= place < len(self.faces), "a face beyond the last")
        require(self.sorted[place] not in self.used, "a face comes twice")
        return self.sorted[place]

    def _start(self, face: int) -> int:
        size = len(self.faces[face])
        if size < 2:
            return 0
        if size == 3:
            turn = self.last_start = self.coder.symbol(self.starts[self.last_start])
        else:
            turn = self.coder.uniform(size - 1)
        return (turn + self.smallest[face]) % size


def _faces(coder: RangeDecoder, points: list[Point], places: list[Position]) -> Cells:
    regular, irregular = number(coder), number(coder)
    welded, triangles, flips, surest = (coder.raw(1) for _ in range(4))
    reach = coder.raw(5)
    require(reach >= 1, "faces without neighbours")
    require(regular == 0 or points, "faces without points")
    welding = Welding(points) if welded else None
    vertices = Vertices([places[m[0]] for m in welding.members] if welding else places)
    decoder = FaceDecoder(coder, vertices, bool(triangles), bool(flips), bool(surest))
    decoder.decode(regular, reach)
    others = PlainCells(coder, vertices, line=False).decode(irregular)
    faces = [list(f) for f in decoder.front.faces]
    if welding:
        corners = Corners(coder, welding)
        faces = corners.of_front(decoder.front)
        others = [[corners.alone(v) for v in f] for f in others]
    if flips:
        faces = [f[::-1] if turned else f for f, turned in zip(faces, decoder.flipped)]
    return faces + others


def _vertex_cells(coder: RangeDecoder, count: int, points: int) -> Cells:
    if coder.raw(1):
        require(count == points, "vertex cells are not one for each point")
        return [[i] for i in range(points)]
    sizes, steps = AdaptiveNumber(), AdaptiveNumber()
    expected, cells = 0, []
    for _ in range(count):
        cell = []
        for _ in range(sizes.decode(coder)):
            point = expected + steps.decode_signed(coder)
            require(0 <= point < points, "a vertex cell has a wrong point")
            cell.append(point)
            expected = point + 1
        cells.append(cell)
    return cells


def _faces_around(
    coder: RangeDecoder, surface: Cells, places: list[Position]
) -> Cells:
    """The regular faces, which the points came along, and the irregular ones."""
    irregular, flips = number(coder), coder.raw(1)
    faces, bits, last = [], AdaptiveBits(), 0
    for face in surface:
        last = coder.adaptive(bits[last]) if flips else 0
        faces.append(face[::-1] if last else list(face))
    return faces + PlainCells(coder, Vertices(places), line=False).decode(irregular)


def decode_cells(
    payload: bytes, points: list[Point], grid: Grid, surface: Cells | None
) -> tuple[Cells, Cells, Cells]:
    """Vertex cells, lines and faces over the points of a block. `surface`: the faces that these
    came along, if their only tile is of that method."""
    coder = stream_of(payload)
    version = coder.raw(4)
    require(version <= 1, "an unknown version of the cells of a mesh", "unsupported")
    vertex_count, line_count = number(coder), number(coder)
    has_faces, keeps_order = coder.raw(1), coder.raw(1)
    places = places_of(points, grid)
    faces: Cells = []
    if has_faces:
        if version == 1:
            require(surface is not None, "the faces are those of no surface")
            faces = _faces_around(coder, surface or [], places)
        else:
            faces = _faces(coder, points, places)
        if keeps_order:
            faces = FaceOrder(coder, faces).decode()
    lines = PlainCells(coder, Vertices(places), line=True).decode(line_count)
    vertex_cells = _vertex_cells(coder, vertex_count, len(points)) if vertex_count else []
    coder.finish()
    return vertex_cells, lines, faces


def centres(points: list[Point], cells: Cells) -> list[tuple[int, int, int]]:
    corner = [min((p[k] for p in points), default=0) for k in range(3)]
    result = []
    for cell in cells:
        middle = [sum(points[i][k] - corner[k] for i in cell) // max(len(cell), 1) for k in range(3)]
        result.append((middle[0], middle[1], middle[2]))
    return result
