"""Near points, and the candidates that they make, docs/format.md, section 13."""

from __future__ import annotations

from lanes import Row, bell, less, over, plus, row, scaled, shifted, squares, times, total
from predictive_surface import Neighbourhood, Question, Surface
from reals import Vector, bits_of, ln, real

EXTRAPOLATED, PARALLELOGRAM, PROJECTED = range(3)


def keys(x: Row, y: Row, z: Row, place: Vector) -> list[int]:
    """Of each entry, the bits of its square distance with its index in the lowest seven."""
    distances = squares(shifted(x, -place[0]), shifted(y, -place[1]), shifted(z, -place[2]))
    return [bits_of(d) & ~127 | i for i, d in enumerate(distances)]


class NearPoints:
    MOST = 31

    def __init__(self) -> None:
        self.x, self.y, self.z = row(), row(), row()
        self.known: list[int] = []

    def gather(self, near: Neighbourhood, place: Vector, wanted: int) -> None:
        self.x, self.y, self.z, self.known = row(), row(), row(), []
        found = [k for k in keys(near.x, near.y, near.z, place) if near.known[k & 127] is not None]
        for key in sorted(found)[:wanted]:
            i = key & 127
            self.add((near.x[i], near.y[i], near.z[i]), near.known[i])

    def add(self, at: Vector, known: int) -> None:
        self.x.append(at[0])
        self.y.append(at[1])
        self.z.append(at[2])
        self.known.append(known)

    def nearest_six(self, place: Vector) -> list[int]:
        return [self.known[k & 127] for k in sorted(keys(self.x, self.y, self.z, place))[:6]]

    def at(self, i: int) -> Vector:
        return self.x[i], self.y[i], self.z[i]


class Kernel:
    def __init__(self, inverse_width: float):
        self.scale = inverse_width
        self.low: list[Row] = []
        self.high: list[Row] = []
        self.mass: list[Row] = []
        self.at = row()


class Group:
    """Candidates of a kind for a box."""

    MOST = 512
    WORTH_PACKING = 32

    def __init__(self, scales: list[float]):
        self.place = [row(), row(), row()]
        self.weight = row()
        self.kernels = [Kernel(s) for s in scales]

    def add(self, at: Vector, weight: float) -> None:
        if len(self.weight) < self.MOST:
            for column, x in zip(self.place, at):
                column.append(x)
            self.weight.append(weight)

    def spread(self, q: Question) -> None:
        for kernel in self.kernels:
            for k in range(3):
                low = q.lower[k]
                high = real(low + q.size[k])
                at_low, at_high = self.bells(kernel, k, low), self.bells(kernel, k, high)
                kernel.low.append(at_low)
                kernel.high.append(at_high)
                kernel.mass.append(shifted(less(at_high, at_low), real(1e-7)))

    def bells(self, kernel: Kernel, axis: int, bound: float) -> Row:
        return bell(scaled(row([bound - x for x in self.place[axis]]), kernel.scale))

    def ask(self, kernel: Kernel, q: Question) -> tuple[float, float]:
        """The masses in the lower and the upper half."""
        k = q.axis
        k1, k2 = (j for j in range(3) if j != k)
        kernel.at = self.bells(kernel, k, q.middle)
        across = times(times(kernel.mass[k1], kernel.mass[k2]), self.weight)
        lower = total(times(across, less(kernel.at, kernel.low[k])))
        return lower, total(times(across, less(kernel.high[k], kernel.at)))

    def take(self, axis: int, upper: int) -> None:
        for kernel in self.kernels:
            if upper:
                kernel.low[axis] = kernel.at
            else:
                kernel.high[axis] = kernel.at
            mass = less(kernel.high[axis], kernel.low[axis])
            kernel.mass[axis] = shifted(mass, real(1e-7))

    def pack(self) -> None:
        """Forgets those that have less than a quarter of the mean mass in the box, if a quarter has."""
        if len(self.weight) <= self.WORTH_PACKING:
            return
        masses = self.weight
        for k in range(3):
            masses = times(masses, self.kernels[-1].mass[k])
        least = real(total(masses) / (4 * len(self.weight)))
        kept = [i for i, mass in enumerate(masses) if mass >= least]
        if 4 * len(kept) > 3 * len(self.weight):
            return

        def of_kept(values: Row) -> Row:
            return row([values[i] for i in kept])

        self.weight = of_kept(self.weight)
        self.place = [of_kept(column) for column in self.place]
        for kernel in self.kernels:
            for rows in (kernel.low, kernel.high, kernel.mass):
                rows[:] = [of_kept(values) for values in rows]


class Answer:
    def __init__(self, lower: float = 0.0, upper: float = 0.0):
        tiny = real(3e-3)
        self.lower, self.upper = lower, upper
        self.evidence = ln(real(real(upper + tiny) / real(lower + tiny)))


def square_between(a: Vector, b: Vector) -> float:
    dx, dy, dz = (real(a[k] - b[k]) for k in range(3))
    return real(real(real(dx * dx) + real(dy * dy)) + real(dz * dz))


class Candidates:
    MOST = 2048

    def __init__(self, flags: set[str], pair_reach: int):
        self.flags, self.pair_reach = flags, pair_reach
        self.scales = 2 if "two scales" in flags else 1
        self.speaking = [True, "separate kinds" in flags, "projection" in flags]
        self.halvings = 0
        self.listed: list[tuple[Vector, float, int]] = []  # place, weight, kind
        self.pairs: dict[int, set[int]] = {}
        widths = (self.scales, self.scales, 1)
        self.groups = [Group([1.0] * n) for n in widths]
        self.answers = [[Answer()] * n for n in widths]

    def start_cell(self, near: NearPoints, side: float, spacing: float) -> None:
        self.middle = real(0.5 * side)
        self.reach = real(self.middle + real(real(0.3) * spacing))
        self.pair_square = real(real(float(self.pair_reach) * spacing) * spacing)
        self.minimum = real(real(real(0.22) * spacing) * spacing)
        self.inverse_square = real(1.0 / real(spacing * spacing))
        self.listed, self.pairs = [], {}
        for t in range(len(near.known)):
            self._propose_around(near, t)

    def add_point(self, near: NearPoints) -> None:
        t = len(near.known) - 1
        at = near.at(t)
        self.listed = [c for c in self.listed if square_between(c[0], at) >= self.minimum]
        self._propose_around(near, t)

    def _in_cell(self, at: Vector) -> bool:
        return all(abs(real(x - self.middle)) <= self.reach for x in at)

    def _propose(self, near: NearPoints, kind: int, at: Vector, square: float) -> None:
        if len(self.listed) >= self.MOST:
            return
        distances = squares(shifted(near.x, -at[0]), shifted(near.y, -at[1]), shifted(near.z, -at[2]))
        if any(d < self.minimum for d in distances):
            return
        drop = 8.0 if kind == EXTRAPOLATED else real(1.8)
        weight = real(1.0 / real(1.0 + real(drop * real(square * self.inverse_square))))
        self.listed.append((at, weight, kind))

    def _extrapolate(self, near: NearPoints, a: Vector, b: Vector, square: float) -> None:
        at = _beyond(a, b)
        if "chains" in self.flags:
            before = _beyond(b, a)
            distances = squares(*(shifted(c, -x) for c, x in zip((near.x, near.y, near.z), before)))
            nearest = min(range(len(distances)), key=distances.__getitem__)
            if distances[nearest] < real(real(0.15) * square):
                bend = (real(0.5 * real(c - x)) for c, x in zip(near.at(nearest), before))
                at = tuple(real(x + by) for x, by in zip(at, bend))
                square = real(0.5 * square)
        self._propose(near, EXTRAPOLATED, at, square)

    def _propose_around(self, near: NearPoints, t: int) -> None:
        here = near.at(t)
        places = [near.at(j) for j in range(t)]
        pairs = [j for j in range(t) if square_between(places[j], here) < self.pair_square]
        self.pairs[t] = set(pairs)
        for j in pairs:
            self.pairs[j].add(t)

        for group in _eights(pairs):
            for swapped in (False, True):
                for j in group:
                    a, b = (places[j], here) if swapped else (here, places[j])
                    if self._in_cell(_beyond(a, b)):
                        self._extrapolate(near, a, b, square_between(here, places[j]))
        if "parallelograms" not in self.flags:
            return
        for k in pairs:
            d = tuple(real(here[i] - places[k][i]) for i in range(3))
            side = real(real(real(d[0] * d[0]) + real(d[1] * d[1])) + real(d[2] * d[2]))
            to_k = {j for j in self.pairs[k] if j < t}
            to_t = {j for j in pairs if j < k}
            for group in _eights(sorted(to_k | to_t)):
                for members, sign, other in ((to_k, 1, places[k]), (to_t, -1, here)):
                    for j in group:
                        if j not in members:
                            continue
                        at = tuple(real(places[j][i] + sign * d[i]) for i in range(3))
                        if self._in_cell(at):
                            square = real(side + square_between(places[j], other))
                            self._propose(near, PARALLELOGRAM, at, square)

    def start_box(self, q: Question, spacing: float, error: float, surface: Surface) -> None:
        width = real(real(real(0.6) * error) * spacing)
        if self.scales == 1:
            scales = [real(1.0 / real(real(0.25 * width) + real(0.4)))]
        else:
            scales = [
                real(1.0 / real(real(real(0.12) * width) + 0.5)),
                real(1.0 / real(width + 0.5)),
            ]
        self.groups = [Group(scales), Group(scales), Group(scales[-1:])]
        self.halvings = 0
        margin = real(real(0.3) * spacing)
        half = [real(real(0.5 * q.size[k]) + margin) for k in range(3)]
        separate = "separate kinds" in self.flags
        for at, weight, kind in self.listed:
            if all(abs(real(at[k] - q.centre[k])) <= half[k] for k in range(3)):
                self.groups[kind if separate else EXTRAPOLATED].add(at, weight)
        if "projection" in self.flags and surface.quadric:
            self._project(surface, spacing, self.groups[EXTRAPOLATED])
            if separate:
                self._project(surface, spacing, self.groups[PARALLELOGRAM])
        for group in self.groups:
            group.spread(q)

    def start_residuals(self, q: Question, spacing: float, error: float) -> None:
        """All kinds as one, weighed by their mass in the box."""
        width = real(real(real(0.6) * error) * spacing)
        group = Group([real(1.0 / real(real(0.25 * width) + real(0.4)))])
        self.groups = [group, Group([1.0]), Group([1.0])]
        margin = real(real(0.15) * spacing)
        half = [real(real(0.5 * q.size[k]) + margin) for k in range(3)]
        for kind in (EXTRAPOLATED, PARALLELOGRAM):
            for at, weight, own in self.listed:
                listed = own if "separate kinds" in self.flags else EXTRAPOLATED
                if listed == kind and all(abs(real(at[k] - q.centre[k])) <= half[k] for k in range(3)):
                    group.add(at, weight)
        group.spread(q)
        self.box_mass = group.weight
        for k in range(3):
            self.box_mass = times(self.box_mass, group.kernels[0].mass[k])

    def moments(self, axis: int, origin: float) -> tuple[float, float, float]:
        """Mean and variance along an axis, and how little their whole mass is."""
        place = shifted(self.groups[0].place[axis], -origin)
        weighted = times(self.box_mass, place)
        none = real(2e-3)
        inverse = real(1.0 / real(total(self.box_mass) + none))
        mean = real(total(weighted) * inverse)
        variance = real(real(total(times(weighted, place)) * inverse) - real(mean * mean))
        return mean, variance, real(none * inverse)

    def weigh_at(self, axis: int, place: float) -> None:
        scale = real(0.5 * self.groups[0].kernels[0].scale)
        t = scaled(shifted(self.groups[0].place[axis], -place), scale)
        away = shifted(times(t, t), 1.0)
        self.box_mass = over(self.box_mass, times(away, away))

    def kernel_variance(self) -> float:
        scale = self.groups[0].kernels[0].scale
        return real(0.25 / real(scale * scale))

    def _project(self, surface: Surface, spacing: float, group: Group) -> None:
        s, t = surface.quadric, surface.quadric.term
        px, py, pz = (
            scaled(shifted(group.place[k], -s.centre[k]), s.unit) for k in range(3)
        )

        def along(w: Vector) -> Row:
            return plus(plus(scaled(px, w[0]), scaled(py, w[1])), scaled(pz, w[2]))

        a, b, c = along(s.u), along(s.v), along(s.normal)
        inner = plus(shifted(scaled(a, t[3]), t[1]), scaled(b, t[4]))
        curved = plus(shifted(times(a, inner), t[0]), times(b, shifted(scaled(b, t[5]), t[2])))
        heights = less(c, curved)
        moved = scaled(row([h if -0.5 < h < 0.5 else 0.0 for h in heights]), spacing)
        columns = [less(group.place[k], scaled(moved, s.normal[k])) for k in range(3)]
        for x, y, z, weight in zip(*columns, group.weight):
            self.groups[PROJECTED].add((x, y, z), weight)

    def ask(self, q: Question) -> None:
        self.answers = [
            [Answer(*group.ask(kernel, q)) for kernel in group.kernels] for group in self.groups
        ]

    def take(self, axis: int, upper: int) -> None:
        for group in self.groups:
            group.take(axis, upper)
        self.halvings += 1
        if self.halvings % 3 == 0:
            for group in self.groups:
                group.pack()

    def heard(self) -> list[tuple[int, list[Answer]]]:
        """The kinds that are told apart, and what is said of each."""
        return [(kind, self.answers[kind]) for kind in range(3) if self.speaking[kind]]

    def nearest_square(self, at: Vector, most: float) -> float:
        for kind in (PROJECTED, PARALLELOGRAM, EXTRAPOLATED):
            group = self.groups[kind]
            if len(group.weight) or kind == EXTRAPOLATED:
                found = squares(*(shifted(group.place[k], -at[k]) for k in range(3)))
                return min([most, *found])
        return most


def _beyond(a: Vector, b: Vector) -> Vector:
    return tuple(real(real(2 * a[k]) - b[k]) for k in range(3))


def _eights(numbers: list[int]) -> list[list[int]]:
    """Numbers in groups of the same eighth."""
    groups: dict[int, list[int]] = {}
    for j in numbers:
        groups.setdefault(j // 8, []).append(j)
    return list(groups.values())
