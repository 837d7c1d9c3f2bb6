"""The advancing front of docs/format.md, section 15: faces, borders, open gates, who is awake."""

from __future__ import annotations

from heapq import nsmallest

from elementary import require

Position = tuple[float, float, float]
Edge = tuple[int, int]
BORDER = -1


class Vertices:
    """Places, and which vertices are awake; buckets of a grid find those near a place."""

    def __init__(self, places: list[Position]):
        self.places = places
        self.doubled = [(2 * p[0], 2 * p[1], 2 * p[2]) for p in places]
        self.awake = [True] * len(places)
        self.upper = [max((p[k] for p in self.doubled), default=0.0) for k in range(3)]
        widest = max(self.upper)
        self.side = max(1.7 * widest / max(len(places) ** 0.5, 1.0), 1.0)
        self.rings = int(widest / self.side) + 1
        self.buckets: dict[tuple[int, ...], list[int]] = {}
        for v, place in enumerate(self.doubled):
            self.buckets.setdefault(self._bucket(place), []).append(v)

    def _bucket(self, place: Position) -> tuple[int, ...]:
        return tuple(int(min(max(x, 0.0), u) / self.side) for x, u in zip(place, self.upper))

    def nearest(self, doubled: Position, count: int, everyone: bool = False) -> list[int]:
        centre = self._bucket(doubled)
        found: list[tuple[float, int]] = []
        for ring in range(self.rings + 1):
            for v in self._ring(centre, ring):
                if everyone or self.awake[v]:
                    p = self.doubled[v]
                    dx, dy, dz = p[0] - doubled[0], p[1] - doubled[1], p[2] - doubled[2]
                    found.append((dx * dx + dy * dy + dz * dz, v))
            # Vertices farther out are at least so far away.
            if len(found) >= count and nsmallest(count, found)[-1][0] < (ring * self.side) ** 2:
                break
        return [v for _, v in nsmallest(count, found)]

    def _ring(self, centre: tuple[int, ...], ring: int) -> list[int]:
        found: list[int] = []
        span = range(-ring, ring + 1)
        for x in span:
            for y in span:
                inside = abs(x) < ring and abs(y) < ring
                for z in (-ring, ring) if inside else span:
                    found += self.buckets.get((centre[0] + x, centre[1] + y, centre[2] + z), ())
        return found


class Unplaced:
    """Vertices that come as faces do, without places yet."""

    def __init__(self) -> None:
        self.awake: dict[int, bool] = {}


class Gate:
    """Where the next vertex of a face is asked for: behind u → v."""

    __slots__ = ("edge", "apex", "diagonal", "closing", "straight")

    def __init__(self, edge: Edge, apex: int | None, straight: bool = False):
        self.edge, self.apex, self.straight = edge, apex, straight
        self.diagonal, self.closing = False, True

    def kind(self) -> int:
        return (1 if self.apex is None else 2 if self.diagonal else 0) + (0 if self.closing else 3)


class Front:
    def __init__(self, vertices: "Vertices | Unplaced", triangles: bool):
        self.vertices, self.triangles = vertices, triangles
        self.faces: list[list[int]] = []
        self.edges: dict[Edge, int] = {}  # the face at a directed edge, or BORDER
        self.leaving: list[list[int]] = []  # open gates of each vertex, the newest last
        self.entering: list[list[int]] = []
        self.valence: list[int] = []
        self.border_begins: list[bool] = []
        self.border_ends: list[bool] = []
        for _ in vertices.awake:
            self.add_vertex()

    def add_vertex(self) -> None:
        self.leaving.append([])
        self.entering.append([])
        self.valence.append(0)
        self.border_begins.append(False)
        self.border_ends.append(False)

    def free(self, u: int, v: int) -> bool:
        return (u, v) not in self.edges

    def is_open(self, u: int, v: int) -> bool:
        return self.free(u, v) and self.edges.get((v, u), BORDER) != BORDER

    def face_at(self, u: int, v: int) -> int | None:
        face = self.edges.get((u, v), BORDER)
        return None if face == BORDER else face

    def apex(self, u: int, v: int) -> int | None:
        """The vertex before u in the face at u → v."""
        face = self.face_at(u, v)
        if face is None:
            return None
        corners = self.faces[face]
        return corners[corners.index(u) - 1]

    def gate_at(self, u: int, v: int) -> Gate:
        across = self.face_at(v, u)
        if across is None:
            return Gate((u, v), None)
        return Gate((u, v), self.apex(v, u), len(self.faces[across]) > 3)

    def gates_at(self, v: int) -> int:
        return len(self.leaving[v]) + len(self.entering[v])

    def add(self, face: list[int]) -> list[Edge]:
        """The gates that the face opens."""
        sides = list(zip(face, face[1:] + face[:1]))
        require(len(set(face)) == len(face), "a vertex stands twice in a face")
        require(all(self.free(u, v) for u, v in sides), "an edge has two faces on the same side")
        opened = []
        for u, v in sides:
            self.valence[u] += 1
            was_open = self.is_open(u, v)
            self.edges[u, v] = len(self.faces)
            if was_open:
                self._close(u, v)
            elif self.free(v, u):
                self.leaving[v].append(u)
                self.entering[u].append(v)
                opened.append((v, u))
        self.faces.append(face)
        for v in face:
            self._settle(v)
        return opened

    def mark_border(self, u: int, v: int) -> None:
        self.edges[u, v] = BORDER
        self._close(u, v)
        self.border_begins[u] = self.border_ends[v] = True
        self._settle(u)
        self._settle(v)

    def _close(self, u: int, v: int) -> None:
        self.leaving[u].remove(v)
        self.entering[v].remove(u)

    def _settle(self, v: int) -> None:
        if self.gates_at(v) or self.valence[v]:
            self.vertices.awake[v] = bool(self.gates_at(v))
