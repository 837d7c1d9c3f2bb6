"""What predicts a question of method predictive, docs/format.md, section 13."""

from __future__ import annotations

from lanes import Row, bell, inverted, less, plus, scaled, shifted, squares, times, total
from predictive_candidates import Candidates, NearPoints
from predictive_surface import FlatBoxes, Neighbourhood, Question, Surface
from reals import Vector, bits_of, dot, ln, real, root

FAR = 1e10


def half_octave(x: float) -> int:
    return (bits_of(x) >> 22) - 254


def distance_class(square: float) -> int:
    return min(max(half_octave(real(square + real(1e-6))), -9), 5) + 9


def to_halves(q: Question, x: Row, y: Row, z: Row) -> tuple[Row, Row]:
    """Square distances to the middles of the halves."""
    d = [shifted(values, -c) for values, c in zip((x, y, z), q.centre)]
    along, quarter = d[q.axis], real(0.25 * q.size[q.axis])
    rest = less(squares(*d), times(along, along))
    up, down = shifted(along, quarter), shifted(along, -quarter)
    return plus(rest, times(up, up)), plus(rest, times(down, down))


class KnownPoint:
    __slots__ = ("position", "nearest", "surface_error", "candidate_error")

    def __init__(self, position: tuple[int, int, int]):
        self.position, self.nearest = position, FAR
        self.surface_error = self.candidate_error = 0.0


class AxisValues:
    def __init__(self, bits: int, points: int):
        self.bits = bits
        self.table_bits = min(bits + 1, min(max(points.bit_length() + 5, 17), 21))
        self.seen: list[dict[int, int]] = [{}, {}, {}]
        self.evidence, self.classes = 0.0, (0, 0)

    def _slot(self, level: int, index: int) -> int:
        place = (1 << (self.bits - level)) + index
        if self.bits < self.table_bits:
            return place
        return (place * 0x9E3779B97F4A7C15 & 0xFFFFFFFFFFFFFFFF) >> (64 - self.table_bits)

    def add(self, point: tuple[int, int, int]) -> None:
        for k in range(3):
            for level in range(min(self.bits, 12) + 1):
                slot = self._slot(level, point[k] >> level)
                self.seen[k][slot] = min(self.seen[k].get(slot, 0) + 1, 65535)

    def ask(self, q: Question) -> None:
        # Levels above the twelfth are never counted, but may share their places.
        index = q.value >> (q.open - 1)
        below, above = (self.seen[q.axis].get(self._slot(q.open - 1, index + i), 0) for i in (0, 1))
        self.evidence = ln(real(real(above + real(0.3)) / real(below + real(0.3))))
        self.classes = _value_class(below), _value_class(above)


def _value_class(n: int) -> int:
    return n if n < 3 else 3 if n < 5 else 4 if n < 9 else 5 if n < 20 else 6 if n < 60 else 7


class Phases:
    """The phases along an axis with a lattice."""

    def __init__(self, frequency: int):
        self.frequency = frequency
        self.weights = [8] * 64
        self.greatest_level = 0
        if frequency:
            folded = min(frequency, (1 << 32) - frequency)
            self.greatest_level = 1
            while self.greatest_level < 7 and folded << self.greatest_level < 1 << 33:
                self.greatest_level += 1

    def weight(self, value: int) -> int:
        return self.weights[(value * self.frequency & 0xFFFFFFFF) >> 26]

    def add(self, value: int) -> None:
        if not self.frequency:
            return
        phase = (value * self.frequency & 0xFFFFFFFF) >> 26
        self.weights[phase] += 32
        if self.weights[phase] >= 1 << 24:
            self.weights = [w // 2 for w in self.weights]

    def evidence(self, value: int, level: int) -> float:
        half = 1 << (level - 1)
        lower = sum(self.weight(value + i) for i in range(half))
        upper = sum(self.weight(value + half + i) for i in range(half))
        tiny = real(0.02)
        return ln(real(real(real(upper) + tiny) / real(real(lower) + tiny)))


class Scene:
    """All predictors over one neighbourhood."""

    def __init__(self, features, bits: int, points: int):
        self.features, self.flags = features, features.flags
        self.near, self.points = Neighbourhood(), NearPoints()
        self.known: list[KnownPoint] = []
        self.in_cell = self.fitted = False
        self.cell_spacing = self.spacing = 1.0
        self.surface_error, self.candidate_error = real(0.2), real(0.15)
        self.surface = Surface()
        self.candidates = Candidates(self.flags, features.pair_reach)
        self.flat = FlatBoxes(features.flat_share, 1 + sum(self.candidates.speaking))
        self.narrow = self.wide = 0.0
        self.faces: dict[int, list[float]] = {}  # of the box, by axis, as coordinates know them
        self.middle = 0.0  # of the last question
        self.density = 0.0
        self.density_distances = self.point_distances = (0, 0)
        self.axis_values = AxisValues(bits, points)
        self.phases = [Phases(f) for f in features.lattices]
        self.plane_evidence = self.quadric_evidence = self.narrow_quadric = 0.0
        self.phase_evidence: float | None = None

    def start_breadth_first(self, side: float) -> None:
        self.in_cell = False
        self.spacing = real(real(0.7) * side)
        self.surface_error, self.candidate_error = real(0.2), real(0.15)
        middle = real(0.5 * side)
        reach = real(real(1.1) / real(0.7))
        self.surface.fit(self.near, (middle,) * 3, self.spacing, reach, "quadric" in self.flags)

    def start_cell(self, side: float, touching: int) -> None:
        """So many entries of the neighbourhood touch the cell; others are near points at most."""
        self.in_cell = True
        middle = real(0.5 * side)
        self.points.gather(self.near, (middle,) * 3, self.features.near_points)
        self.near.shorten(touching)
        distances, seen = self.cell_spacing, 1
        for i in self.points.known[:6]:
            if self.known[i].nearest < 1e9:
                distances = real(distances + self.known[i].nearest)
                seen += 1
        mean = real(distances / seen)
        self.candidates.start_cell(self.points, side, 1.0 if mean < 1 else mean)
        self.fitted = False

    def start_box(self, q: Question, one_point: bool) -> None:
        self._expect(q, one_point)
        self.candidates.start_box(q, self.spacing, self.candidate_error, self.surface)
        self.faces.clear()
        self.flat.start(self.spacing, self.candidate_error, self.surface_error, self.surface.plane)

    def start_residuals(self, q: Question) -> None:
        self._expect(q, True)
        self.candidates.start_residuals(q, self.spacing, self.candidate_error)

    def _expect(self, q: Question, one_point: bool) -> None:
        distances, seen = self.cell_spacing, 1
        surface, candidate = real(0.1), real(0.3)
        six = self.points.nearest_six(q.centre)
        for i in six:
            point = self.known[i]
            if point.nearest < 1e9:
                distances = real(distances + point.nearest)
                seen += 1
            surface = real(surface + point.surface_error)
            candidate = real(candidate + point.candidate_error)
        self.spacing = real(distances / seen)
        if not self.spacing >= 1:
            self.spacing = 1.0
        number = float(1 + len(six))
        self.surface_error = real(real(surface / number) + real(real(0.3) / self.spacing))
        self.candidate_error = real(candidate / number)
        refit = self.features.refit
        if not self.fitted or refit == 2 or (refit == 1 and one_point):
            self.surface.fit(self.near, q.centre, self.spacing, 1.1, "quadric" in self.flags)
            self.fitted = True

    def surface_evidence(self) -> float:
        return self.quadric_evidence if self.surface.quadric else self.plane_evidence

    def distances(self) -> tuple[int, int]:
        return self.point_distances if self.in_cell else self.density_distances

    def ask(self, q: Question) -> None:
        quadric, plane = self.surface.quadric, self.surface.plane
        self.quadric_evidence = quadric.evidence(q, self.surface_error) if quadric else 0.0
        if "narrow quadric" in self.flags:
            error = real(real(0.4) * self.surface_error)
            self.narrow_quadric = quadric.evidence(q, error) if quadric else 0.0
        wanted = not self.in_cell or "plane" in self.flags or not quadric
        self.plane_evidence = plane.evidence(q) if plane and wanted else 0.0
        if self.in_cell:
            self.candidates.ask(q)
            self._ask_coordinates(q)
            kinds = [answers[0].evidence for _, answers in self.candidates.heard()]
            self.flat.remember(q, [self.surface_evidence(), *kinds])
        if not self.in_cell or "density" in self.flags:
            self._ask_density(q, 24 if self.in_cell else Neighbourhood.ROOM)
        self.ask_values(q)

    def skip(self, q: Question, flat: bool) -> None:
        """A half of the box lies outside the tile."""
        if self.in_cell:
            if not flat:
                self.candidates.ask(q)
            self.faces.pop(q.axis, None)

    def take(self, axis: int, upper: int, flat: bool) -> None:
        if not flat:
            self.candidates.take(axis, upper)
        if axis in self.faces:
            self.faces[axis][0 if upper else 1] = self.middle

    def ask_flat(self, q: Question) -> None:
        self._ask_coordinates(q)
        self.ask_values(q)

    def ask_values(self, q: Question) -> None:
        if "axis values" in self.flags:
            self.axis_values.ask(q)
        phases = self.phases[q.axis]
        speaks = q.open <= phases.greatest_level
        self.phase_evidence = phases.evidence(q.value, q.open) if speaks else None

    def _ask_coordinates(self, q: Question) -> None:
        along = (self.points.x, self.points.y, self.points.z)[q.axis]
        low = q.lower[q.axis]
        faces = self.faces.setdefault(q.axis, [low, real(low + q.size[q.axis])])
        self.middle = q.middle
        bounds = (faces[0], q.middle, faces[1])
        reaches = [[bound - x for x in along] for bound in bounds]
        reaches = [shifted(r, 0.0) for r in reaches]

        def evidence(scale: float) -> float:
            at_low, at, at_high = (bell(scaled(r, scale)) for r in reaches)
            tiny = real(0.02)
            lower, upper = total(less(at, at_low)), total(less(at_high, at))
            return ln(real(real(upper + tiny) / real(lower + tiny)))

        self.narrow = evidence(real(1.6))
        self.wide = 0.0
        if "wide coordinates" in self.flags:
            scale = real(1.0 / real(real(real(0.1) * self.spacing) + real(0.6)))
            self.wide = evidence(scale)
        self.point_distances = (0, 0)
        if "nearest" in self.flags:
            self.point_distances = self._classes(*to_halves(q, self.points.x, self.points.y, self.points.z))

    def _classes(self, lower: Row, upper: Row) -> tuple[int, int]:
        unit = real(1.0 / real(self.spacing * self.spacing))
        # Without points, the entries that fill up eight lanes are far away.
        far = real(1e36)
        first, second = (distance_class(real(min([far, *d]) * unit)) for d in (lower, upper))
        return first, second

    def _ask_density(self, q: Question, most: int) -> None:
        near = self.near
        x, y, z, weight = near.x[:most], near.y[:most], near.z[:most], near.weight[:most]
        side = q.size[0]
        spread = real(real(real(0.3) * self.spacing) * self.spacing)
        scale = real(1.0 / real(real(side * side) + spread))
        halves = to_halves(q, x, y, z)
        sums = []
        for half in halves:
            t = inverted(shifted(scaled(half, scale), 1.0))
            sums.append(total(times(times(weight, t), t)))
        tiny = real(1e-4)
        self.density = ln(real(real(sums[1] + tiny) / real(sums[0] + tiny)))
        self.density_distances = self._classes(*halves)

    def learn(self, position: tuple[int, int, int], at: Vector) -> None:
        point = KnownPoint(position)
        for i, number in enumerate(self.points.known):
            d = [real(a - b) for a, b in zip(self.points.at(i), at)]
            distance = root(real(real(real(d[0] * d[0]) + real(d[1] * d[1])) + real(d[2] * d[2])))
            point.nearest = min(point.nearest, distance)
            other = self.known[number]
            other.nearest = min(other.nearest, distance)
        unit = real(1.0 / self.spacing)
        most = real(real(0.25 * self.spacing) * self.spacing)
        point.candidate_error = real(root(self.candidates.nearest_square(at, most)) * unit)
        plane = self.surface.plane
        if self.surface.quadric:
            height, gradient = self.surface.quadric.at(at)
            steepness = root(real(dot(gradient, gradient) + real(1e-6)))
            point.surface_error = real(abs(height) / steepness)
        elif plane:
            away: Vector = tuple(real(at[k] - plane.through[k]) for k in range(3))
            point.surface_error = real(abs(dot(plane.normal, away)) * unit)
        else:
            point.surface_error = real(0.3)
        index = len(self.known)
        self.known.append(point)
        self.learn_coordinates(position)
        self.near.add(at, 1.0, 1.0, index, Neighbourhood.ROOM - 1)
        if len(self.points.known) < NearPoints.MOST:
            self.points.add(at, index)
            self.candidates.add_point(self.points)

    def learn_coordinates(self, position: tuple[int, int, int]) -> None:
        if "axis values" in self.flags:
            self.axis_values.add(position)
        for k in range(3):
            self.phases[k].add(position[k])
