"""The places of method surface, docs/format.md, section 16: each predicted from those around it."""

from __future__ import annotations

import math
from collections import deque
from itertools import product

from elementary import require
from lanes import bell_of
from mesh_faces import AdaptiveNumber
from predictive_model import Evidence, LayeredMixer, limited
from predictive_scene import half_octave
from range_coder import RangeDecoder
from reals import Counters, class_of, ln, real

Point = tuple[int, int, int]
Vector = tuple[float, float, float]
GREATEST_AGE = 250
AXES: tuple[Vector, ...] = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
NOTHING: Vector = (0.0, 0.0, 0.0)
GUESSES, VECTORS, CLASSES = 5, 8, 6


def add(a: Vector, b: Vector) -> Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]


def less(a: Vector, b: Vector) -> Vector:
    return a[0] - b[0], a[1] - b[1], a[2] - b[2]


def scaled(factor: float, a: Vector) -> Vector:
    return factor * a[0], factor * a[1], factor * a[2]


def dot(a: Vector, b: Vector) -> float:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def mean(vectors: list[Vector]) -> Vector:
    total = NOTHING
    for v in vectors:
        total = add(total, v)
    return scaled(1.0 / len(vectors), total)


def nearest(x: float) -> int:
    return math.floor(x + 0.5)


class Triangles:
    """Faces cut into triangles: what lies around a vertex, and the sequence of vertices."""

    def __init__(self, faces: list[list[int]], count: int):
        self.third: dict[tuple[int, int], int] = {}
        self.sides: list[list[tuple[int, int]]] = [[] for _ in range(count)]
        around: list[set[int]] = [set() for _ in range(count)]
        for face in faces:
            for j in range(2, len(face)):
                triangle = face[0], face[j - 1], face[j]
                for i in range(3):
                    c, a, b = (triangle[(i + k) % 3] for k in range(3))
                    self.third.setdefault((a, b), c)
                    self.sides[c].append((a, b))
                    around[c] |= {a, b}
        self.neighbours = [sorted(v) for v in around]
        self.known = [False] * count
        self.classes, self.parallelograms = [0] * count, [0] * count
        self.queues: list[deque[int]] = [deque() for _ in range(CLASSES)]
        self.lowest = 0

    def next(self) -> int:
        for of_class in range(CLASSES - 1, 0, -1):
            queue = self.queues[of_class]
            while queue:
                vertex = queue.popleft()
                if not self.known[vertex] and self.classes[vertex] == of_class:
                    return vertex
        while self.known[self.lowest]:
            self.lowest += 1
        return self.lowest

    def _gain(self, vertex: int, opposite: int | None, or_edge: bool) -> None:
        """A parallelogram, if the vertex opposite is known, or else an edge."""
        to = 1
        if opposite is not None and opposite != vertex and self.known[opposite]:
            self.parallelograms[vertex] += 1
            to = 1 + min(self.parallelograms[vertex], 4)
        elif not or_edge:
            return
        if to > self.classes[vertex]:
            self.classes[vertex] = to
            self.queues[to].append(vertex)

    def know(self, w: int) -> None:
        self.known[w] = True
        for a, b in self.sides[w]:
            if self.known[a] and self.known[b]:
                vertex = self.third.get((b, a))
                if vertex is not None and not self.known[vertex]:
                    self._gain(vertex, w, or_edge=False)
            elif self.known[a]:
                self._gain(b, self.third.get((a, w)), or_edge=True)
            elif self.known[b]:
                self._gain(a, self.third.get((w, b)), or_edge=True)


class Stencil:
    """Weights of vectors, fitted to the vertices before."""

    def __init__(self) -> None:
        self.p = [[0.0] * VECTORS for _ in range(VECTORS)]
        self.r = [0.0] * VECTORS

    def estimate(self, vectors: list[Vector]) -> Vector:
        n = VECTORS
        lower = [[0.0] * n for _ in range(n)]
        for i, j in product(range(n), range(n)):
            if j > i:
                continue
            s = self.p[i][j] + (1 + 0.001 * self.p[i][i] if i == j else 0.0)
            for k in range(j):
                s -= lower[i][k] * lower[j][k]
            lower[i][j] = math.sqrt(max(s, 1e-9)) if i == j else s / lower[j][j]
        w = list(self.r)
        for i in range(n):
            for k in range(i):
                w[i] -= lower[i][k] * w[k]
            w[i] /= lower[i][i]
        for i in reversed(range(n)):
            for k in range(i + 1, n):
                w[i] -= lower[k][i] * w[k]
            w[i] /= lower[i][i]
        result = NOTHING
        for weight, v in zip(w, vectors):
            result = add(result, scaled(weight, v))
        return result

    def learn(self, vectors: list[Vector], rest: Vector) -> None:
        for i in range(VECTORS):
            for j in range(VECTORS):
                self.p[i][j] = 0.99 * self.p[i][j] + dot(vectors[i], vectors[j])
            self.r[i] = 0.99 * self.r[i] + dot(vectors[i], rest)


class Prediction:
    """What is expected of a vertex."""

    def __init__(self) -> None:
        self.situation = 6
        self.base, self.middle = NOTHING, NOTHING
        self.neighbours: list[int] = []
        self.longest: list[Vector] = []  # parallelograms, by falling length of their sides
        self.vectors = [NOTHING] * VECTORS
        self.normal = NOTHING
        self.guesses: list[Vector] = []


class Spreads:
    """How far a guess was off in a situation, along the axes of the frames."""

    def __init__(self) -> None:
        self.sums, self.weight = [100.0] * 3, 1.0

    def learn(self, along: list[float]) -> None:
        self.weight = 0.95 * self.weight + 1
        self.sums = [0.95 * s + x * x for s, x in zip(self.sums, along)]


class ExactValues:
    """Nearest integers that a coordinate may equal, and how far they can be trusted."""

    KINDS = 5

    def __init__(self) -> None:
        self.right: dict[int, list[list[bool]]] = {}  # by vertex, by axis, by kind
        self.last = [[[False, False] for _ in range(self.KINDS)] for _ in range(3)]

    def of(self, p: Prediction, axis: int, places: list[Vector]) -> tuple[list[int], int]:
        """The values, and the sharing of the value that most neighbours have."""
        values = [-1] * self.KINDS
        for i, place in enumerate(p.longest[:2]):
            values[i] = nearest(place[axis])
        if p.longest:
            values[2] = nearest(p.base[axis])
        sharing = 0
        if p.neighbours:
            theirs = [nearest(places[v][axis]) for v in p.neighbours]
            most = max(theirs.count(x) for x in theirs)
            values[3] = min(x for x in theirs if theirs.count(x) == most)
            values[4] = theirs[0]
            sharing = limited(most - 1, 0, 2)
        return values, sharing

    def trusts(self, p: Prediction, axis: int) -> list[int]:
        trusts = []
        for kind in range(self.KINDS):
            hits = sum(self.right[v][axis][kind] for v in p.neighbours)
            if not p.neighbours:
                trust = 4
            elif hits == len(p.neighbours):
                trust = 2 if hits == 1 else 3
            else:
                trust = 1 if hits else 0
            before, newest = self.last[axis][kind]
            trusts.append(4 * trust + 2 * before + newest)
        return trusts

    def learn(self, vertex: int, axis: int, values: list[int], value: int) -> None:
        right = [v == value for v in values]
        self.right.setdefault(vertex, []).append(right)
        for history, hit in zip(self.last[axis], right):
            history[:] = [history[1], hit]


class Places:
    def __init__(
        self, coder: RangeDecoder, faces: list[list[int]], vertices: int, points: int, extent: list[int]
    ):
        self.coder, self.extent, self.points = coder, extent, points
        self.vertices = vertices
        self.mesh = Triangles(faces, vertices)
        self.places: list[Vector] = [NOTHING] * vertices
        self.off: dict[int, Vector] = {}  # a vertex with a parallelogram: its place less its base
        self.errors: dict[int, list[Vector]] = {}
        self.last: Vector = (float(extent[0] // 2), float(extent[1] // 2), float(extent[2] // 2))
        self.stencils = [Stencil() for _ in range(7)]
        self.spreads = [[Spreads() for _ in range(GUESSES)] for _ in range(7)]
        self.exact = ExactValues()
        self.counters = Counters()
        self.mixer = LayeredMixer(0.13, (0.02, 200.0, 0.006), 0.001)

    def decode(self) -> list[Point]:
        for _ in range(self.vertices):
            vertex = self.mesh.next()
            self.places[vertex] = self.last = self._vertex(vertex)
            self.mesh.know(vertex)
        points = [(int(x), int(y), int(z)) for x, y, z in self.places]
        numbers = [AdaptiveNumber() for _ in range(3)]
        last = [0, 0, 0]
        while len(points) < self.points:
            for k in range(3):
                last[k] += numbers[k].decode_signed(self.coder)
                require(0 <= last[k] <= self.extent[k], "a point outside of its tile")
            points.append((last[0], last[1], last[2]))
        return points

    def _vertex(self, c: int) -> Vector:
        p = self._prediction(c)
        axes = self._frame(p)
        covariances = [self._covariance(p, guess, axes) for guess in range(GUESSES)]
        coordinates: list[int] = []
        for axis in range(3):
            values, sharing = self.exact.of(p, axis, self.places)
            about = Coordinate(self, p, axis, values, self.exact.trusts(p, axis), sharing)
            for guess, covariance in zip(p.guesses, covariances):
                about.normals.append(conditional(guess, covariance, coordinates))
            coordinates.append(about.decode(self.coder))
            self.exact.learn(c, axis, values, coordinates[-1])
        place = float(coordinates[0]), float(coordinates[1]), float(coordinates[2])
        self._learn(c, p, axes, place)
        return place

    def _learn(self, c: int, p: Prediction, axes: tuple[Vector, ...], place: Vector) -> None:
        rest = less(place, p.base)
        self.stencils[p.situation].learn(p.vectors, rest)
        if p.longest:
            self.off[c] = rest
        self.errors[c] = [less(place, guess) for guess in p.guesses]
        for spreads, error in zip(self.spreads[p.situation], self.errors[c]):
            spreads.learn([dot(error, axis) for axis in axes])

    def _prediction(self, c: int) -> Prediction:
        p, known = Prediction(), self.mesh.known
        p.neighbours = [v for v in self.mesh.neighbours[c] if known[v]]
        p.middle = mean([self.places[v] for v in p.neighbours]) if p.neighbours else self.last
        edges, corners = [], []
        for a, b in self.mesh.sides[c]:
            if known[a] and known[b]:
                d = self.mesh.third.get((b, a))
                if d is not None and d != c and known[d]:
                    corners.append((a, b, d))
                else:
                    edges.append((a, b))
        if corners:
            p.situation = min(len(corners), 4) - 1
            self._from_parallelograms(p, corners)
        elif edges:
            p.situation = 4
            a, b = edges[0]
            p.base = scaled(0.5, add(self.places[a], self.places[b]))
        else:
            p.situation = 5 if p.neighbours else 6
            p.base = p.middle
        p.vectors[0] = less(p.middle, p.base)
        self._from_neighbours(c, p)
        estimate = self.stencils[p.situation].estimate(p.vectors)
        longest = p.longest[0] if p.longest else p.base
        p.guesses = [p.base, longest, p.middle, add(p.base, estimate), add(p.base, p.vectors[1])]
        return p

    def _from_parallelograms(self, p: Prediction, corners: list[tuple[int, int, int]]) -> None:
        places, third, known = self.places, self.mesh.third, self.mesh.known
        s = 1.0 / len(corners)
        sums = [NOTHING] * 5  # of places, of vectors 1, 2, 6 and 3
        by_length = []
        for a, b, d in corners:
            pa, pb, pd = places[a], places[b], places[d]
            place = less(add(pa, pb), pd)
            sums[0] = add(sums[0], place)
            for edge, other, this in (((d, a), pb, pa), ((b, d), pa, pb)):
                far = third.get(edge)
                if far is not None and known[far]:
                    sums[1] = add(sums[1], less(places[far], less(add(pd, this), other)))
            sums[2] = add(sums[2], add(self.off.get(a, NOTHING), self.off.get(b, NOTHING)))
            sums[3] = add(sums[3], self.off.get(d, NOTHING))
            sums[4] = add(sums[4], add(pa, pb))
            side = less(pb, pa)
            by_length.append((-dot(side, side), len(by_length), place))
            p.normal = add(p.normal, cross(less(pd, pa), less(pb, pa)))
        p.base = scaled(s, sums[0])
        p.longest = [place for _, _, place in sorted(by_length)]
        p.vectors[1] = scaled(s, sums[1])
        p.vectors[2], p.vectors[6] = scaled(s, sums[2]), scaled(s, sums[3])
        p.vectors[3] = less(scaled(0.5 * s, sums[4]), p.base)
        p.vectors[4] = less(p.longest[0], p.base)

    def _from_neighbours(self, c: int, p: Prediction) -> None:
        known, places = self.mesh.known, self.places
        second = [
            places[o]
            for v in p.neighbours
            for o in self.mesh.neighbours[v][:16]
            if o != c and known[o]
        ]
        if second:
            p.vectors[5] = less(mean(second), p.base)
        through = []
        for v in p.neighbours:
            o = self._opposite(v, c)
            if o is not None and known[o]:
                through.append(less(scaled(2.0, places[v]), places[o]))
        if through:
            p.vectors[7] = less(mean(through), p.base)

    def _opposite(self, v: int, c: int) -> int | None:
        ring, x = [c], self.mesh.third.get((v, c))
        while x is not None and x != c and len(ring) <= 16:
            ring.append(x)
            x = self.mesh.third.get((v, x))
        return ring[len(ring) // 2] if x == c and len(ring) % 2 == 0 and len(ring) <= 16 else None

    def _frame(self, p: Prediction) -> tuple[Vector, ...]:
        square = dot(p.normal, p.normal)
        if not p.longest or square == 0:
            return AXES
        n = scaled(1.0 / math.sqrt(square), p.normal)

        def beside(g: Vector) -> Vector:
            return less(g, scaled(dot(g, n), n))

        h = beside(less(p.base, p.middle))
        length = math.sqrt(dot(h, h))
        if length <= 1e-9:
            h = beside(AXES[0] if abs(n[0]) < 0.7 else AXES[1])
            length = math.sqrt(dot(h, h))
        h = scaled(1.0 / length, h)
        return n, h, cross(n, h)

    def _covariance(self, p: Prediction, guess: int, axes: tuple[Vector, ...]) -> list[list[float]]:
        spreads = self.spreads[p.situation][guess]
        result = [[0.0] * 3 for _ in range(3)]
        for j, axis in enumerate(axes):
            total = spreads.sums[j] / spreads.weight * 0.5
            for v in p.neighbours:
                along = dot(self.errors[v][guess], axis)
                total += along * along
            variance = total / (0.5 + len(p.neighbours)) + 0.3
            for x in range(3):
                for y in range(3):
                    result[x][y] += variance * axis[x] * axis[y]
        return result


def conditional(guess: Vector, c: list[list[float]], known: list[int]) -> tuple[float, float]:
    """Mean and σ of the next coordinate."""
    e = [value - g for value, g in zip(known, guess)]
    if not e:
        mean_of, variance = guess[0], c[0][0]
    elif len(e) == 1:
        k = c[1][0] / c[0][0]
        mean_of, variance = guess[1] + k * e[0], c[1][1] - k * c[1][0]
    else:
        q = max(c[0][0] * c[1][1] - c[0][1] * c[0][1], 1e-6 * c[0][0] * c[1][1])
        i = (c[1][1] * c[2][0] - c[0][1] * c[2][1]) / q
        j = (c[0][0] * c[2][1] - c[0][1] * c[2][0]) / q
        mean_of = guess[2] + (i * e[0] + j * e[1])
        variance = c[2][2] - (i * c[2][0] + j * c[2][1])
    return mean_of, math.sqrt(max(variance, 0.1))


class Coordinate:
    def __init__(
        self, of: Places, p: Prediction, axis: int, values: list[int], trusts: list[int], sharing: int
    ):
        self.counters, self.mixer, self.situation, self.axis = of.counters, of.mixer, p.situation, axis
        self.extent, self.values, self.trusts, self.sharing = of.extent[axis], values, trusts, sharing
        self.normals: list[tuple[float, float]] = []  # mean and σ of each guess

    def decode(self, coder: RangeDecoder) -> int:
        self.coder, self.low, self.high = coder, 0, self.extent
        middle, sigma = self.normals[3]
        middle = min(max(middle, 0.0), float(self.extent))
        start, unit = nearest(middle), 1
        while 2 * unit < 1.2 * sigma:
            unit *= 2
        self.width = limited(half_octave(real(sigma)) + 4, 0, 15)
        self.phase = class_of(real(middle - start + 0.5), 3, 0, 3)
        up = start == 0 or self._decide(start, 0)
        i, distance = 1, unit
        while True:
            bound = start + distance if up else start - distance
            if bound > self.high if up else bound <= self.low:
                break
            if self._decide(bound, min(i, 10) + (0 if up else 10)) != up:
                break
            i += 1
            distance = i * unit if i <= 3 else 2 * distance
        while self.low < self.high:
            span = self.high - self.low
            self._decide(self.low + (span + 1) // 2, 21 + (span > 3) + (span > 15))
        return self.low

    def _decide(self, bound: int, step: int) -> bool:
        """Whether the value is the bound or more."""
        e = Evidence(self.counters, GREATEST_AGE)
        for mean_of, sigma in self.normals:
            for tau in (0.4 * sigma, 1.3 * sigma):
                below, at, above = (self._share(x, mean_of, tau) for x in (self.low, bound, self.high + 1))
                e.add(ln(real(max(above - at, 1e-7) / max(at - below, 1e-7))))
        e.context("phase", step, self.width, self.phase)
        e.context("situation", step, self.situation, self.width)
        e.add(real(0.3))
        stage = step if step < 4 else 4 if step < 11 else step - 6 if step < 14 else 8 if step < 21 else 9
        for kind, (value, trust) in enumerate(zip(self.values, self.trusts)):
            if not self.low <= value <= self.high:
                relation = 0
            else:
                relation = 1 if value == bound else 2 if value > bound else 3 if value == bound - 1 else 4
            e.context(kind, stage, relation, trust, self.sharing if kind == 3 else 0)
        selected = (step, (self.situation, self.axis), self.width)
        bit = e.learn(self.mixer.decode(self.coder, e.inputs, selected, (self.axis,)))
        if bit:
            self.low = bound
        else:
            self.high = bound - 1
        return bool(bit)

    def _share(self, x: int, mean_of: float, tau: float) -> float:
        if x == 0:
            return 0.0
        if x == self.extent + 1:
            return 1.0
        return 0.5 * (1.0 + bell_of(real((x - 0.5 - mean_of) / tau)))
