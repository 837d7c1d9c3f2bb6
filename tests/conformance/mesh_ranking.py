"""Candidates at a gate and their ranking, docs/format.md, section 15."""

from __future__ import annotations

import math

from mesh_front import Front, Gate, Position
from reals import LOG2_E, Vector, clamp, cross, dot, exp2, ln, minus, real, root

FEATURES = 24
# Of each feature, for the kinds of candidates.
FIRST_WEIGHTS = {
    0: (0.8, 1.2, 1.2, -1.4),
    1: (-2.8, -2.8, -2.8, -2.8),
    2: (-0.2, -0.2, 0, 0),
    3: (-2.2, -2, -2, -2),
    7: (-0.2, 0, 0, -0.2),
    8: (-0.4, -0.2, 0, -0.2),
    9: (0.2, 0, 0, 0.2),
    10: (0, 0.2, -0.2, 0),
    11: (-1.2, -1, -1, -1.2),
    16: (-1, -1, -1, -1),
}


def half(x: int) -> float:
    return min(x, 4) / 2


def turn(x: float, y: float) -> float:
    total = real(abs(x) + abs(y))
    if total == 0:
        return 0.0
    r = real(x / total)
    return real(1.0 - r) if y >= 0 else real(3.0 + r)


class Frame:
    """The surroundings of a gate in units of its length."""

    def __init__(self, front: Front, gate: Gate):
        self.front, (u, v) = front, gate.edge
        self.origin, end = front.vertices.places[u], front.vertices.places[v]
        square = 0.0
        for k in range(3):
            square += (end[k] - self.origin[k]) ** 2
        self.length = math.sqrt(square) if square > 0 else 1.0
        self.log_length = ln(real(1 + self.length))
        self.middle: Position = tuple(self.origin[k] + end[k] for k in range(3))
        self.edge = self.to(v)
        self.normal: Vector | None = None
        self.kappa, self.longest = 0.5, False
        self.leaving: tuple[float, int | None] = (4.0, None)  # the smallest turn, and where to
        self.entering: tuple[float, int | None] = (4.0, None)
        self.target: Position | None = None
        if gate.apex is not None:
            self._measure(gate, end)

    def to(self, vertex: int) -> Vector:
        p = self.front.vertices.places[vertex]
        x, y, z = (real((p[k] - self.origin[k]) / self.length) for k in range(3))
        return x, y, z

    def _measure(self, gate: Gate, end: Position) -> None:
        d = self.front.vertices.places[gate.apex]
        if gate.straight:
            self.target = tuple(2 * (2 * end[k] - d[k]) for k in range(3))
        else:
            self.target = tuple(2 * (self.origin[k] + end[k] - d[k]) for k in range(3))
        self.g: Vector = tuple(
            real((0.5 * self.target[k] - self.origin[k]) / self.length) for k in range(3)
        )
        h = self.to(gate.apex)
        f = minus(h, self.edge)
        q = cross(h, self.edge)
        size = root(dot(q, q))
        if size > 0:
            self.normal = (real(q[0] / size), real(q[1] / size), real(q[2] / size))
            self.inward = cross(self.normal, self.edge)
        hh, ff = dot(h, h), dot(f, f)
        self.log_perimeter = ln(real(real(1.0 + root(hh)) + root(ff)))
        product = real(hh * ff)
        self.kappa = real(dot(h, f) / root(product)) if product > 0 else 1.0
        self.longest = hh <= 1 and ff <= 1
        if self.normal:
            self._measure_gates(gate)

    def _measure_gates(self, gate: Gate) -> None:
        u, v = gate.edge
        for w in self.front.leaving[v][:-17:-1]:
            if w != u:
                way = minus(self.to(w), self.edge)
                angle = turn(-dot(way, self.edge), dot(way, self.inward))
                if angle < self.leaving[0]:
                    self.leaving = (angle, w)
        for w in self.front.entering[u][:-17:-1]:
            if w != v:
                way = self.to(w)
                angle = turn(dot(way, self.edge), dot(way, self.inward))
                if angle < self.entering[0]:
                    self.entering = (angle, w)


class Candidate:
    __slots__ = ("vertex", "kind", "cot", "score", "probability", "f")

    def __init__(self, vertex: int):
        self.vertex, self.kind = vertex, 0
        self.cot = self.score = self.probability = 0.0
        self.f = [0.0] * FEATURES
        self.f[0] = 1.0


class Ranking:
    def __init__(self, gate: Gate, frame: Frame, candidates: list[Candidate]):
        self.gate, self.candidates = gate, candidates
        self.kappa, self.longest = frame.kappa, frame.longest


class Ranker:
    def __init__(self, front: Front):
        self.front = front
        self.weights: dict[tuple[int, int], list[float]] = {}
        for gate in range(6):
            for kind in range(4):
                w = [0.0] * FEATURES
                for feature, first in FIRST_WEIGHTS.items():
                    w[feature] = real(first[kind])
                self.weights[gate, kind] = w

    def rank(self, gate: Gate, reach: int, kept: int, everyone: bool = False) -> Ranking:
        frame = Frame(self.front, gate)
        candidates = [self._describe(gate, frame, v) for v in self._gather(gate, frame, reach, everyone)]
        self._compare(candidates)
        for c in candidates:
            score = 0.0
            for w, x in zip(self.weights[gate.kind(), c.kind], c.f):
                score = real(score + real(w * x))
            c.score = score
        candidates.sort(key=lambda c: (-c.score, c.vertex))
        candidates = candidates[:kept]
        total = 0.0
        for c in candidates:
            c.probability = exp2(real(real(c.score - candidates[0].score) * LOG2_E))
            total = real(total + c.probability)
        for c in candidates:
            c.probability = real(c.probability / total)
        return Ranking(gate, frame, candidates)

    def learn(self, ranking: Ranking, chosen: int) -> None:
        for i, c in enumerate(ranking.candidates):
            error = real((1.0 if i == chosen else 0.0) - c.probability)
            if abs(error) < real(0.003):
                continue
            w = self.weights[ranking.gate.kind(), c.kind]
            step = real(real(0.03) * error)
            for f in range(FEATURES):
                w[f] = real(w[f] + real(step * c.f[f]))

    def _gather(self, gate: Gate, frame: Frame, reach: int, everyone: bool) -> list[int]:
        front, (u, v) = self.front, gate.edge
        found: dict[int, None] = {}
        nearest = front.vertices.nearest
        order = front.leaving[v][:-17:-1] + front.entering[u][:-17:-1]
        if frame.target is not None:
            order += nearest(frame.target, reach, everyone)
        order += nearest(frame.middle, reach, everyone)
        for c in order:
            if c in (u, v, gate.apex) or c in found:
                continue
            if front.valence[c]:
                if not front.free(v, c) or (gate.closing and not front.free(c, u)):
                    continue
            found[c] = None
        return list(found)

    def _describe(self, gate: Gate, frame: Frame, vertex: int) -> Candidate:
        c, f = Candidate(vertex), None
        f = c.f
        (u, v), front = gate.edge, self.front
        a = frame.to(vertex)
        b = minus(a, frame.edge)
        m = cross(frame.edge, a)
        s, big_a, big_b = root(dot(m, m)), root(dot(a, a)), root(dot(b, b))
        ab = dot(a, b)
        c.cot = real(ab / s) if s > 0 else (50.0 if ab > 0 else -50.0)
        cosine = real(ab / real(big_a * big_b)) if big_a > 0 and big_b > 0 else 1.0
        phi = real(dot(frame.normal, m) / s) if frame.normal and s > 0 else 1.0
        glues = (False, False)
        if front.valence[vertex]:
            glues = (front.is_open(v, vertex), gate.closing and front.is_open(vertex, u))
            c.kind = sum(glues) or 3
        f[1], f[2] = real(0.5 * clamp(c.cot, -3.0, 8.0)), cosine
        f[3] = real(1.0 - phi)
        f[4] = real(real(0.5 * f[3]) * f[3])
        if any(glues):
            self._describe_folds(gate, frame, a, m, glues, c)
        self._describe_sizes(frame, a, big_a, big_b, c)
        longest = big_a <= 1 and big_b <= 1
        f[20] = abs(real(cosine - frame.kappa))
        f[21] = float(longest == frame.longest)
        f[22] = float(longest and frame.longest and phi > real(0.98))
        f[23] = float(phi > real(0.999))
        if frame.normal:
            self._describe_gaps(frame, a, b, glues, c)
        self._describe_valences(gate, glues, c)
        return c

    def _describe_sizes(self, frame: Frame, a: Vector, big_a: float, big_b: float, c: Candidate) -> None:
        f = c.f
        perimeter = real(real(1.0 + big_a) + big_b)
        log_perimeter = ln(perimeter)
        f[8] = real(log_perimeter - real(1.0986123))
        if frame.target is None:
            return
        f[7] = abs(real(log_perimeter - frame.log_perimeter))
        away = minus(a, frame.g)
        distance = root(dot(away, away))
        f[9] = clamp(real(real(2.0 * distance) / perimeter), 0.0, 4.0)
        steps = real(1 + distance * frame.length)
        f[10] = clamp(real(ln(steps) - frame.log_length), -4.0, 4.0)

    def _describe_folds(
        self, gate: Gate, frame: Frame, a: Vector, m: Vector, glues: tuple[bool, bool], c: Candidate
    ) -> None:
        (u, v), size = gate.edge, root(dot(m, m))
        total, edges = 0.0, 0
        sides = []
        if glues[0]:
            sides.append((v, c.vertex, frame.edge, minus(a, frame.edge)))
        if glues[1]:
            sides.append((c.vertex, u, (0.0, 0.0, 0.0), (-a[0], -a[1], -a[2])))
        for start, end, origin, along in sides:
            to_apex = minus(frame.to(self.front.apex(end, start)), origin)
            across = cross(to_apex, along)
            across_size = root(dot(across, across))
            cosine = 1.0
            if size > 0 and across_size > 0:
                cosine = real(dot(across, m) / real(across_size * size))
            total = real(total + real(1.0 - cosine))
            edges += 1
        c.f[5] = real(total / edges)
        c.f[6] = real(real(0.5 * c.f[5]) * c.f[5])

    def _describe_gaps(
        self, frame: Frame, a: Vector, b: Vector, glues: tuple[bool, bool], c: Candidate
    ) -> None:
        f = c.f
        own = (
            turn(-dot(b, frame.edge), dot(b, frame.inward)),
            turn(dot(a, frame.edge), dot(a, frame.inward)),
        )
        for angle, (gap, vertex), glued in zip(own, (frame.leaving, frame.entering), glues):
            if vertex is None:
                continue
            if vertex == c.vertex:
                if glued:
                    f[13] = real(f[13] + real(1.0 - min(gap, 2.0)))
                continue
            room = real(gap - angle)
            if room < 0:
                f[11] += 1.0
            elif room < 0.5:
                f[12] = real(f[12] + real(real(0.5 - room) * 2.0))

    def _describe_valences(self, gate: Gate, glues: tuple[bool, bool], c: Candidate) -> None:
        front, f = self.front, c.f
        usual = 6 if front.triangles else 4
        for vertex, glued in zip((gate.edge[1], gate.edge[0]), glues):
            y = front.valence[vertex] + 1
            if glued and front.gates_at(vertex) == 2:
                f[14] += half(abs(y - usual))
            elif y >= usual:
                f[15] += half(y + 1 - usual)
        y = front.valence[c.vertex] + 1
        if c.kind == 2 and front.gates_at(c.vertex) == 2:
            f[14] += half(abs(y - usual))
        elif y >= usual:
            f[19] = half(y + 1 - usual)

    @staticmethod
    def _compare(candidates: list[Candidate]) -> None:
        order = sorted(candidates, key=lambda c: (c.cot, c.vertex))
        rank = 0
        for c in order:
            c.f[16] = half(rank)
            c.f[17] = float(rank == 0)
            c.f[18] = real(0.5 * min(3.0, real(c.cot - order[0].cot)))
            if c.f[3] < real(1.2) and c.f[11] < 0.5:
                rank += 1
