"""The plane and the quadric around a cell, docs/format.md, section 13."""

from __future__ import annotations

from lanes import Row, bell_of, inverted, plus, row, scaled, shifted, squares, times, total
from reals import Vector, cross, dot, ln, real, root

TWELFTH = real(1 / 12)


class Question:
    """A box of a cell that is halved along an axis."""

    def __init__(self, lower: Vector, size: Vector, axis: int, open_bits: int, value: int):
        self.lower, self.size, self.axis = lower, size, axis
        self.centre: Vector = tuple(real(l + 0.5 * s) for l, s in zip(lower, size))
        self.middle, self.open, self.value = self.centre[axis], open_bits, value


def halves_logit(middle: float, inverse_scale: float, half: float) -> float:
    at = bell_of(real(-middle * inverse_scale))
    low = bell_of(real(real(-half - middle) * inverse_scale))
    high = bell_of(real(real(half - middle) * inverse_scale))
    tiny = real(1e-5)
    return ln(real(real(real(high - at) + tiny) / real(real(at - low) + tiny)))


class FlatBoxes:
    """Boxes so small that what is said of their halves follows from what was said of larger ones."""

    def __init__(self, share: int, sources: int):
        self.share, self.sources = share, sources
        self.largest = [0.0] * 3
        self.forget()

    def forget(self) -> None:
        self.per_step = [[0.0] * self.sources for _ in range(3)]

    def start(self, spacing: float, candidate_error: float, surface_error: float, plane: Plane | None) -> None:
        self.forget()
        width = real(real(real(0.6) * candidate_error) * spacing)
        depth = real(surface_error * spacing)
        for k in range(3):
            along = abs(plane.normal[k]) if plane else 0.0
            least = min(width, real(depth / real(along + real(0.001))))
            self.largest[k] = real(self.share / 8 * least)

    def holds(self, q: Question) -> bool:
        return q.size[q.axis] <= self.largest[q.axis]

    def remember(self, q: Question, said: list[float]) -> None:
        # Sides are powers of two: nothing is rounded.
        self.per_step[q.axis] = [x / q.size[q.axis] for x in said]

    def evidence(self, q: Question) -> list[float]:
        return [x * q.size[q.axis] for x in self.per_step[q.axis]]


class Neighbourhood:
    MOST, ROOM = 104, 120

    def __init__(self) -> None:
        self.clear()

    def clear(self) -> None:
        self.x, self.y, self.z, self.weight, self.size = (row() for _ in range(5))
        self.known: list[int | None] = []  # the known point, None for a cell

    def add(self, at: Vector, points: float, side: float, known: int | None, most: int = MOST) -> None:
        if len(self.known) >= most:
            return
        for column, value in zip((self.x, self.y, self.z, self.weight, self.size), (*at, points, side)):
            column.append(value)
        self.known.append(known)

    def shorten(self, entries: int) -> None:
        for column in (self.x, self.y, self.z, self.weight, self.size, self.known):
            del column[entries:]

    def holds(self, at: Vector) -> bool:
        return any(at == p for p in zip(self.x, self.y, self.z))


class Plane:
    def __init__(self, normal: Vector, through: Vector, variance: float):
        self.normal, self.through, self.variance = normal, through, variance

    def evidence(self, q: Question) -> float:
        along = self.normal[q.axis]
        if real(along * along) < real(1e-4):
            return 0.0
        distance, spread = 0.0, self.variance
        for k in range(3):
            distance = real(distance + real(self.normal[k] * real(q.centre[k] - self.through[k])))
            if k != q.axis:
                square = real(real(self.normal[k] * self.normal[k]) * q.size[k])
                spread = real(spread + real(real(square * q.size[k]) * TWELFTH))
        return halves_logit(
            real(-distance / along), real(abs(along) / root(spread)), real(0.5 * q.size[q.axis])
        )


class Quadric:
    def __init__(self, u: Vector, v: Vector, normal: Vector, centre: Vector, unit: float, term: list[float]):
        self.u, self.v, self.normal, self.centre, self.unit, self.term = u, v, normal, centre, unit, term

    def at(self, place: Vector) -> tuple[float, Vector]:
        """Height above it, and the gradient of that."""
        t = self.term
        p: Vector = tuple(real(real(place[k] - self.centre[k]) * self.unit) for k in range(3))
        a, b = dot(self.u, p), dot(self.v, p)
        inner = real(real(t[1] + real(t[3] * a)) + real(t[4] * b))
        surface = real(real(t[0] + real(a * inner)) + real(b * real(t[2] + real(t[5] * b))))
        height = real(dot(self.normal, p) - surface)
        slope_u = real(real(t[1] + real(real(2 * t[3]) * a)) + real(t[4] * b))
        slope_v = real(real(t[2] + real(t[4] * a)) + real(real(2 * t[5]) * b))
        gradient: Vector = tuple(
            real(real(self.normal[k] - real(slope_u * self.u[k])) - real(slope_v * self.v[k]))
            for k in range(3)
        )
        return height, gradient

    def evidence(self, q: Question, error: float) -> float:
        height, gradient = self.at(q.centre)
        along = gradient[q.axis]
        if not abs(along) >= real(0.02):
            return 0.0
        k1, k2 = (k for k in range(3) if k != q.axis)
        across1 = real(real(gradient[k1] * q.size[k1]) * self.unit)
        across2 = real(real(gradient[k2] * q.size[k2]) * self.unit)
        blur = real(real(real(across1 * across1) + real(across2 * across2)) * TWELFTH)
        variance = real(real(error * error) + blur)
        half = real(real(0.5 * q.size[q.axis]) * self.unit)
        return halves_logit(real(-height / along), real(abs(along) / root(variance)), half)


Symmetric = tuple[float, ...]  # xx, xy, xz, yy, yz, zz


def _adjugate(m: Symmetric) -> Symmetric:
    def minor(a: int, b: int, c: int, d: int) -> float:
        return real(real(m[a] * m[b]) - real(m[c] * m[d]))

    entries = ((3, 5, 4, 4), (2, 4, 1, 5), (1, 4, 2, 3), (0, 5, 2, 2), (1, 2, 0, 4), (0, 3, 1, 1))
    return tuple(minor(*entry) for entry in entries)


def _squared(m: Symmetric) -> Symmetric:
    def three(*pairs: tuple[int, int]) -> float:
        a, b, c = (real(m[i] * m[j]) for i, j in pairs)
        return real(real(a + b) + c)

    return (
        three((0, 0), (1, 1), (2, 2)), three((0, 1), (1, 3), (2, 4)), three((0, 2), (1, 4), (2, 5)),
        three((1, 1), (3, 3), (4, 4)), three((1, 2), (3, 4), (4, 5)), three((2, 2), (4, 4), (5, 5)),
    )  # fmt: skip


def _least_direction(c: Symmetric, trace: float) -> Vector:
    ridge = real(trace * real(1e-3))
    m = _adjugate((real(c[0] + ridge), c[1], c[2], real(c[3] + ridge), c[4], real(c[5] + ridge)))
    for _ in range(3):
        whole = real(real(real(m[0] + m[3]) + m[5]) + real(1e-30))
        scale = real(1.0 / whole)
        m = _squared(tuple(real(x * scale) for x in m))
    if m[0] >= m[3] and m[0] >= m[5]:
        return m[0], m[1], m[2]
    return (m[1], m[3], m[4]) if m[3] >= m[5] else (m[2], m[4], m[5])


class Surface:
    def __init__(self) -> None:
        self.plane: Plane | None = None
        self.quadric: Quadric | None = None

    def fit(self, near: Neighbourhood, centre: Vector, spacing: float, reach: float, quadric: bool) -> None:
        self.plane = self.quadric = None
        if len(near.known) < 3:
            return
        unit = real(1.0 / spacing)
        columns = zip((near.x, near.y, near.z), centre)
        x, y, z = (scaled(shifted(values, -c), unit) for values, c in columns)
        size = scaled(near.size, unit)
        self.plane = _fit_plane(x, y, z, size, centre, spacing, real(reach))
        if quadric and self.plane and len(near.known) >= 5:
            self.quadric = _fit_quadric(self.plane.normal, x, y, z, size, centre, spacing)


def _fit_plane(x: Row, y: Row, z: Row, size: Row, centre: Vector, spacing: float, reach: float) -> Plane | None:
    unit, reach2 = real(1.0 / spacing), real(reach * reach)
    extra = shifted(size, -unit)
    extra2 = times(extra, extra)
    weight = inverted(times(shifted(squares(x, y, z), reach2), shifted(extra2, reach2)))
    wx, wy, wz = times(weight, x), times(weight, y), times(weight, z)
    scale = real(1.0 / real(total(weight) + real(1e-20)))
    mean: Vector = tuple(real(total(w) * scale) for w in (wx, wy, wz))
    moments = ((wx, x, 0, 0), (wx, y, 0, 1), (wx, z, 0, 2), (wy, y, 1, 1), (wy, z, 1, 2), (wz, z, 2, 2))
    c = tuple(
        real(real(total(times(w, v)) * scale) - real(mean[i] * mean[j])) for w, v, i, j in moments
    )
    blur = real(real(total(times(weight, extra2)) * scale) * TWELFTH)
    trace = real(real(c[0] + c[3]) + c[5])
    direction = _least_direction(c, trace if trace > real(1e-6) else real(1e-6))
    length2 = dot(direction, direction)
    if not length2 > real(1e-20):
        return None
    inverse = real(1.0 / root(length2))
    n: Vector = tuple(real(d * inverse) for d in direction)
    through: Vector = tuple(real(real(mean[k] * spacing) + centre[k]) for k in range(3))
    first = real(real(real(c[0] * n[0]) + real(real(2 * c[1]) * n[1])) + real(real(2 * c[2]) * n[2]))
    second = real(real(c[3] * n[1]) + real(real(2 * c[4]) * n[2]))
    across = real(
        real(real(n[0] * first) + real(n[1] * second)) + real(real(n[2] * c[5]) * n[2])
    )
    inner = real(max(across, 0.0) + real(real(0.02) * blur))
    variance = real(real(real(inner * spacing) * spacing) + real(0.08))
    return Plane(n, through, variance)


def _fit_quadric(
    n: Vector, x: Row, y: Row, z: Row, size: Row, centre: Vector, spacing: float
) -> Quadric:
    s = [abs(k) for k in n]
    least = (0 if s[0] < s[2] else 2) if s[0] < s[1] else (1 if s[1] < s[2] else 2)
    u = cross(n, tuple(1.0 if k == least else 0.0 for k in range(3)))
    scale = real(1.0 / root(dot(u, u)))
    u = tuple(real(k * scale) for k in u)
    v = cross(n, u)

    def along(w: Vector) -> Row:
        return plus(plus(scaled(x, w[0]), scaled(y, w[1])), scaled(z, w[2]))

    distance = shifted(squares(x, y, z), real(0.4))
    blur = shifted(scaled(times(size, size), TWELFTH), real(0.0003))
    weight = inverted(times(times(distance, distance), blur))
    a, b, height = along(u), along(v), along(n)
    terms = [row([1.0] * len(x)), a, b, times(a, a), times(a, b), times(b, b)]
    matrix, right = [], []
    for p in range(6):
        weighted = times(weight, terms[p])
        right.append(total(times(weighted, height)))
        matrix.append([total(times(weighted, terms[q])) for q in range(p + 1)])
    for p, ridge in enumerate((0.004, 0.024, 0.024, 0.24, 0.24, 0.24)):
        matrix[p][p] = real(matrix[p][p] + real(ridge))
    return Quadric(u, v, n, centre, real(1.0 / spacing), _solved(matrix, right))


def _solved(a: list[list[float]], right: list[float]) -> list[float]:
    """By Cholesky."""
    lower: list[list[float]] = [[] for _ in range(6)]
    inverse: list[float] = []
    for p in range(6):
        for q in range(p + 1):
            s = a[p][q]
            for k in range(q):
                s = real(s - real(lower[p][k] * lower[q][k]))
            if p == q:
                inverse.append(real(1.0 / root(s if s > real(1e-6) else real(1e-6))))
            else:
                lower[p].append(real(s * inverse[q]))
    y: list[float] = []
    for p in range(6):
        s = right[p]
        for k in range(p):
            s = real(s - real(lower[p][k] * y[k]))
        y.append(real(s * inverse[p]))
    for p in reversed(range(6)):
        s = y[p]
        for k in range(p + 1, 6):
            s = real(s - real(lower[k][p] * y[k]))
        y[p] = real(s * inverse[p])
    return y
