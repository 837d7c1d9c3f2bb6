"""Regular faces by the advancing front, docs/format.md, section 15."""

from __future__ import annotations

from elementary import require
from mesh_front import Edge, Front, Gate, Vertices
from mesh_ranking import Candidate, Ranker, Ranking
from range_coder import AdaptiveBits, AdaptiveSymbol, RangeDecoder
from reals import Counter, Counters, Mixer, class_of, clamp, ln, real

COT_BOUNDS = [real(b) for b in (0, 0.35, 0.58, 1, 1.7, 3)]


def number(coder: RangeDecoder) -> int:
    length = coder.raw(7)
    return coder.wide(min(length, 64)) if length else 0


class AdaptiveNumber:
    def __init__(self) -> None:
        self.bits = AdaptiveBits()

    def decode(self, coder: RangeDecoder) -> int:
        length = 0
        while length < 64 and coder.adaptive(self.bits[length]):
            length += 1
        return length if length < 2 else 1 << (length - 1) | coder.wide(length - 1)

    def decode_signed(self, coder: RangeDecoder) -> int:
        value = self.decode(coder)
        return -(value >> 1) - 1 if value & 1 else value >> 1


class CornerNumbers:
    """How many corners faces have."""

    def __init__(self, coder: RangeDecoder, front: Front, most: int):
        self.coder, self.front, self.most = coder, front, most
        self.models: dict[tuple[int, int], AdaptiveSymbol] = {}
        self.last = 0

    def decode(self, across: int | None) -> int:
        """Of a face with that one across."""

        def class_of_size(size: int) -> int:
            return 0 if size < 3 else min(size - 2, 5)

        beside = class_of_size(len(self.front.faces[across])) if across is not None else 0
        model = self.models.setdefault((beside, self.last), AdaptiveSymbol(12))
        size = self.coder.symbol(model)
        if size == 11:
            size += number(self.coder)
        self.last = class_of_size(size)
        require(3 <= size <= self.most, "a wrong number of corners")
        return size


class GateSymbols:
    """Borders, and which candidate of a ranking comes."""

    def __init__(self, coder: RangeDecoder, front: Front):
        self.coder, self.front = coder, front
        self.counters = Counters()
        self.border_mixer = Mixer([0.4] * 4, 0.03, 300, 0.01)
        self.mixer = Mixer([0.6] + [0.12] * 10 + [0.0], 0.015, 300, 0.003)
        self.omega, self.any_border = 0, False
        self.places = (0, 0, 0)

    def _inputs(self, contexts: list[tuple], unseen: float) -> tuple[list[float], list[Counter]]:
        counters = [self.counters[c] for c in contexts]
        inputs = [
            real(c.evidence() + real(real(1.0 - c.confidence()) * unseen)) for c in counters
        ]
        return inputs, counters

    def border(self, ranking: Ranking) -> bool:
        u, v = ranking.gate.edge
        beta = int(self.front.border_ends[u]) + int(self.front.border_begins[v])
        score = kind = fold = size = overlap = 0
        if ranking.candidates:
            best = ranking.candidates[0]
            score, kind = 1 + class_of(best.score, 0.5, 3, 7), best.kind
            fold, size = class_of(best.f[3], 2.5, 0, 4), class_of(best.f[8], 3, 2, 8)
            overlap = class_of(best.f[11], 1, 0, 3)
        contexts = [
            ("border", 0, beta, min((self.omega + 2) // 3, 7)),
            ("border", 1, score, kind, beta, fold),
            ("border", 2, size, beta, kind, overlap),
        ]
        inputs, counters = self._inputs(contexts, -2.0)
        selected = 2 * beta + self.any_border
        bit = self.border_mixer.decode(self.coder, inputs + [real(0.3)], selected)
        for counter in counters:
            counter.learn(bit)
        self.omega = 21 if bit else max(self.omega, 1) - 1
        self.any_border = self.any_border or bool(bit)
        return bool(bit)

    def candidate(self, ranking: Ranking) -> int:
        """The place in the ranking; their number if it is none of them."""
        rest, at = 1.0, 0
        while at < len(ranking.candidates):
            if self._is_it(ranking, at, rest):
                break
            rest = real(rest - ranking.candidates[at].probability)
            at += 1
        place = min(at, 2) if at < len(ranking.candidates) else 2
        self.places = (place, *self.places[:2])
        return at

    def _is_it(self, ranking: Ranking, at: int, rest: float) -> int:
        c = ranking.candidates[at]
        last = at + 1 == len(ranking.candidates)
        if last:
            p = real(0.7)
        else:
            p = real(c.probability / rest) if rest > real(1e-9) else 0.5
        p = clamp(p, real(1e-5), real(1 - real(1e-5)))
        prior = real(ln(p) - ln(real(1.0 - p)))
        margin, next_kind = 7, 0
        if not last:
            following = ranking.candidates[at + 1]
            margin = class_of(real(c.score - following.score), 1.5, 0, 8)
            next_kind = following.kind
        contexts = self._contexts(ranking, c, at, prior, margin, next_kind)
        inputs, counters = self._inputs(contexts, real(real(0.8) * prior))
        selected = (min(at, 3), c.kind, ranking.gate.kind(), margin >= 4)
        bit = self.mixer.decode(self.coder, [prior] + inputs + [real(0.3)], selected)
        for counter in counters:
            counter.learn(bit)
        return bit

    def _contexts(
        self, ranking: Ranking, c: Candidate, at: int, prior: float, margin: int, next_kind: int
    ) -> list[tuple]:
        f, (u, v) = c.f, ranking.gate.edge
        kinds = (c.kind, ranking.gate.kind())
        i, j = (min(at, 3), *kinds), (min(at, 1), *kinds)
        eta = class_of(prior, 1.2, 8, 20)
        alpha = next((k for k, bound in enumerate(COT_BOUNDS) if c.cot < bound), 6)
        pi, overlap = class_of(f[9], 8, 0, 8), class_of(f[11], 1, 0, 3)
        theta, chi = class_of(f[3], 4, 0, 6), class_of(f[5], 4, 0, 4)
        kappa = class_of(ranking.kappa, 4, 4, 8)
        valences = [min(self.front.valence[w], 9) for w in (u, v, c.vertex)]
        return [
            (0, i, eta),
            (1, i, margin, next_kind),
            (2, i, alpha, theta, overlap),
            (3, j, *valences),
            (4, i, pi, eta // 4),
            (5, i, class_of(f[16], 2, 0, 5), chi, overlap),
            (6, i, alpha, kappa, ranking.longest, f[21]),
            (7, i, *self.places, eta // 2),
            (8, i, kappa, theta, chi),
            (9, j, alpha, pi, margin),
        ]


class FaceDecoder:
    def __init__(self, coder: RangeDecoder, vertices: Vertices, triangles: bool, flips: bool, surest: bool):
        self.coder, self.vertices, self.flips, self.surest = coder, vertices, flips, surest
        self.front = Front(vertices, triangles)
        self.ranker = Ranker(self.front)
        self.symbols = GateSymbols(coder, self.front)
        self.bits = AdaptiveBits()
        self.corners = CornerNumbers(coder, self.front, len(vertices.places))
        self.flipped: list[int] = []
        self.queue: list[list[Edge]] = [[] for _ in range(24)]

    def decode(self, faces: int, reach: int) -> None:
        self.reach = reach
        n = len(self.vertices.places)
        for seed in range(n):
            if len(self.front.faces) == faces:
                return
            if self.front.valence[seed]:
                continue
            if not self.coder.adaptive(self.bits["seed"]):
                self.vertices.awake[seed] = False
                continue
            self._face(self._rank(self.front.gate_at(seed, self._second(seed))))
            while len(self.front.faces) < faces:
                ranking = self._next_gate()
                if ranking is None:
                    break
                if self.symbols.border(ranking):
                    self.front.mark_border(*ranking.gate.edge)
                else:
                    self._face(ranking)
        require(len(self.front.faces) == faces, "a mesh has fewer faces than it says")

    def _rank(self, gate: Gate) -> Ranking:
        return self.ranker.rank(gate, self.reach, 2 * self.reach)

    def _any(self) -> int:
        return self.coder.uniform(len(self.vertices.places) - 1)

    def _second(self, seed: int) -> int:
        near = self.vertices.nearest(self.vertices.doubled[seed], 25)
        for place, vertex in enumerate([v for v in near if v != seed][:24]):
            if self.coder.adaptive(self.bits["second", place]):
                return vertex
        return self._any()

    def _class(self, ranking: Ranking) -> int:
        if not ranking.candidates:
            return 23
        best = ranking.candidates[0]
        least = real(-13.82)
        rest = clamp(real(1.0 - best.probability), real(1e-6), 1.0)
        doubt = class_of(real(ln(rest) - least), real(22 / -least), 0, 23)
        return min(doubt + (5 if best.score < -3 else 3 if best.score < -1 else 0), 22)

    def _next_gate(self) -> Ranking | None:
        while True:
            priority = next((p for p in range(24) if self.queue[p]), None)
            if priority is None:
                return None
            edge = self.queue[priority].pop()
            if not self.front.is_open(*edge):
                continue
            ranking = self._rank(self.front.gate_at(*edge))
            if self.surest:
                now = self._class(ranking)
                if now > priority:
                    self.queue[now].append(edge)
                    continue
            return ranking

    def _face(self, ranking: Ranking) -> None:
        gate = ranking.gate
        u, v = gate.edge
        across = self.front.face_at(v, u)
        size = 3 if self.front.triangles else self.corners.decode(across)
        face = [u, v]
        for i in range(2, size):
            closing = i + 1 == size
            if i == 2 and closing:
                face.append(self._vertex(ranking))
                continue
            corner = Gate((u, face[-1]), gate.apex, gate.straight)
            corner.closing = closing
            if i > 2:
                corner.apex, corner.diagonal, corner.straight = face[-2], True, False
            face.append(self._vertex(self._rank(corner)))
        if self.flips:
            context = 2 if across is None else self.flipped[across]
            self.flipped.append(self.coder.adaptive(self.bits["flip", context]))
        for edge in self.front.add(face):
            priority = self._class(self._rank(self.front.gate_at(*edge))) if self.surest else 0
            self.queue[priority].append(edge)

    def _vertex(self, ranking: Ranking) -> int:
        at = self.symbols.candidate(ranking)
        if at < len(ranking.candidates):
            vertex = ranking.candidates[at].vertex
            self.ranker.learn(ranking, at)
            return vertex
        refused = {c.vertex for c in ranking.candidates}
        wide = self.ranker.rank(ranking.gate, 64, 300, everyone=True)
        place = 0
        for c in wide.candidates:
            if c.vertex in refused:
                continue
            place_class = min(place if place < 8 else 8 + place // 8, 31)
            if self.coder.adaptive(self.bits["escape", c.kind, place_class]):
                return c.vertex
            place += 1
        return self._any()
