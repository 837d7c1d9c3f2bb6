"""Method surface of docs/format.md, section 16: the faces in front, and the points along them."""

from __future__ import annotations

from collections import deque

from elementary import require
from mesh_faces import AdaptiveNumber, CornerNumbers, number
from mesh_front import Edge, Front, Unplaced
from predictive_model import Evidence, LayeredMixer
from range_coder import AdaptiveBits, AdaptiveSymbol, RangeDecoder, stream_of
from reals import Counters, real
from surface_places import Places, Point

GREATEST_AGE = 250
BORDER, NEW, RIGHT, LEFT, NOT_LAST = 0, 1, 2, 3, 4
BORDER_DEED, ANOTHER = 4, 3
NO_VERTEX = 10
MOST_STEPS = 1024


class Questions:
    """Borders, and where the next vertex of a face comes from."""

    def __init__(self, coder: RangeDecoder, front: Front):
        self.coder, self.front = coder, front
        self.counters = Counters()
        self.mixer = LayeredMixer(0.2, (0.02, 60.0, 0.003), 0.001)
        self.deeds = (0, 0)

    def _faces_at(self, vertex: int | None) -> int:
        return NO_VERTEX if vertex is None else min(self.front.valence[vertex], 9)

    def ask(
        self, slot: int, u: int, w: int, right: int | None, left: int | None, across: tuple[int, int]
    ) -> int:
        f, front = self._faces_at, self.front
        borders = [front.border_begins[x] or front.border_ends[x] for x in (u, w)]
        beta = borders[0] + 2 * borders[1]
        gates = 5 * min(front.gates_at(u), 4) + min(front.gates_at(w), 4)
        (l, m), (d, a) = self.deeds, across
        e, s = 11 * f(u) + f(w), 11 * f(right) + f(left)
        numbers = (
            e + 1000 * beta,
            121 * e + s,
            4 * (11 * f(w) + f(right)) + beta,
            4 * (11 * f(u) + f(left)) + beta,
            5 * (16 * e + a) + l,
            5 * (5 * e + l) + m,
            25 * (11 * e + d) + gates,
            25 * (11 * e + f(right)) + gates,
            25 * (11 * e + f(left)) + gates,
            16 * (121 * e + s) + a,
        )
        evidence = Evidence(self.counters, GREATEST_AGE)
        for k, x in enumerate(numbers):
            evidence.context(k, ((8 * x + slot) * 0x9E3779B97F4A7C15 % (1 << 64)) >> 48)
        evidence.add(real(0.3))
        selected = ((slot, f(u)), (slot, f(u), f(w)), (slot, l, m))
        return evidence.learn(self.mixer.decode(self.coder, evidence.inputs, selected, (slot,)))


class Surface:
    """Regular faces, whose vertices are numbered as they appear."""

    def __init__(self, coder: RangeDecoder, points: int):
        self.coder, self.most = coder, points
        self.count = number(coder)
        self.triangles = bool(coder.raw(1)) if self.count else True
        self.front = Front(Unplaced(), self.triangles)
        self.vertices = 0
        self.questions = Questions(coder, self.front)
        self.corners = CornerNumbers(coder, self.front, points)
        self.queues: list[deque[Edge]] = [deque() for _ in range(8)]
        self.bits = AdaptiveBits()
        self.where = AdaptiveSymbol(3)
        self.steps = (AdaptiveNumber(), AdaptiveNumber())
        self.deeds: list[int] = []
        while len(self.front.faces) < self.count:
            self._next()

    def _next(self) -> None:
        gate = self._next_gate()
        if gate is None:
            edge = self._end(), self._end()
            require(self.front.free(*edge), "the first edge of a face has one")
            self._face(*edge)
        elif self._is_border(*gate):
            self.front.mark_border(*gate)
            self._remember(BORDER_DEED)
        else:
            self._face(*gate)

    def _remember(self, deed: int) -> None:
        self.questions.deeds = (deed, self.questions.deeds[0])

    def _class(self, gate: Edge) -> int:
        return min(max(self.front.valence[v] for v in gate), 7)

    def _next_gate(self) -> Edge | None:
        at = 7
        while at >= 0:
            if not self.queues[at]:
                at -= 1
                continue
            gate = self.queues[at].popleft()
            if not self.front.is_open(*gate):
                continue
            now = self._class(gate)
            if now <= at:
                return gate
            self.queues[now].append(gate)
            at = now
        return None

    def _new(self) -> int:
        require(self.vertices < self.most, "a surface has more vertices than there are points")
        self.front.add_vertex()
        self.vertices += 1
        return self.vertices - 1

    def _any(self) -> int:
        require(self.vertices > 0, "a vertex of a surface that has none")
        return self.coder.uniform(self.vertices - 1)

    def _end(self) -> int:
        return self._new() if self.coder.adaptive(self.bits["new"]) else self._any()

    def _across(self, u: int, v: int) -> tuple[int, int]:
        """D and A of the gate u → v."""
        face = self.front.face_at(v, u)
        if face is None:
            return NO_VERTEX, 15
        corners = self.front.faces[face]
        place = corners.index(v)
        return min(self.front.valence[corners[place - 1]], 9), 3 * self.deeds[face] + min(place, 2)

    def _sides(self, u: int, w: int, last: bool) -> tuple[int | None, int | None]:
        """Right and left."""
        front = self.front
        right = front.leaving[w][-1] if front.leaving[w] else None
        if last and right is not None and not front.free(right, u):
            right = None
        left = front.entering[u][-1] if last and front.entering[u] else None
        if left is not None and not front.free(w, left):
            left = None
        return right, left

    def _is_border(self, u: int, v: int) -> int:
        right, left = self._sides(u, v, self.triangles)
        slot = BORDER if self.triangles else BORDER + NOT_LAST
        return self.questions.ask(slot, u, v, right, left, self._across(u, v))

    def _face(self, u: int, v: int) -> None:
        size = 3 if self.triangles else self.corners.decode(self.front.face_at(v, u))
        across = self._across(u, v)
        face = [u, v]
        for i in range(2, size):
            deed, vertex = self._vertex(u, face[-1], i + 1 == size, across)
            face.append(vertex)
            across = NO_VERTEX, 15
        opened = self.front.add(face)
        self.deeds.append(deed)
        self._remember(deed)
        for gate in opened:
            self.queues[self._class(gate)].append(gate)

    def _vertex(self, u: int, w: int, last: bool, across: tuple[int, int]) -> tuple[int, int]:
        """What settles a vertex, and its number."""
        right, left = self._sides(u, w, last)
        more = 0 if last else NOT_LAST

        def ask(question: int) -> int:
            return self.questions.ask(question + more, u, w, right, left, across)

        if ask(NEW):
            return 0, self._new()
        if right is not None and ask(RIGHT):
            return 1, right
        if left is not None and left != right and ask(LEFT):
            return 2, left
        return ANOTHER, self._another(u, w)

    def _another(self, u: int, w: int) -> int:
        where = self.coder.symbol(self.where)
        if where == 2:
            return self._any()
        steps = self.steps[where].decode(self.coder)
        require(steps <= MOST_STEPS, "a vertex is too many steps away")
        gates, vertex = ((self.front.leaving, w), (self.front.entering, u))[where]
        for _ in range(steps + 1):
            require(gates[vertex], "a way along gates ends early")
            vertex = gates[vertex][-1]
        return vertex


class SurfaceMethod:
    def __init__(self, points: int, extent: list[int], version: int):
        require(version == 0, "unknown version of surface", "unsupported")
        require(points <= (1 << 32) - 17, "too many points for method surface")
        self.n, self.extent = points, list(extent)
        self.faces: list[list[int]] = []

    def layer(self, payload: bytes, last: bool) -> tuple[list[Point], list[int]]:
        if not last:
            require(not payload, "a coarse layer of method surface has a payload")
            x, y, z = (e // 2 for e in self.extent)
            return [(x, y, z)], [self.n]
        coder = stream_of(payload)
        surface = Surface(coder, self.n)
        self.faces = surface.front.faces
        points = Places(coder, self.faces, surface.vertices, self.n, self.extent).decode()
        coder.finish()
        return points, [1] * self.n
