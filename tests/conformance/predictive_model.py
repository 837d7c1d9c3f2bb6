"""The decisions of method predictive and their mixers, docs/format.md, section 13."""

from __future__ import annotations

from lanes import bell_of, plus, row, scaled, times, total
from predictive_scene import Scene, half_octave
from predictive_surface import Question
from range_coder import RangeDecoder
from reals import Counter, Counters, clamp, class_of, ln, real, root, squash

GREATEST_AGE = 60


def limited(value: int, low: int, high: int) -> int:
    return min(max(value, low), high)


class Sets:
    """Sets of weights of one selector."""

    def __init__(self, start: float, rate: tuple[float, float, float]):
        self.start = real(start)
        self.rate, self.half_life, self.floor = real(rate[0]), rate[1], real(rate[2])
        self.weights: dict[object, object] = {}
        self.seen: dict[object, int] = {}

    def of(self, key: object, count: int):
        weights = self.weights.setdefault(key, row())
        while len(weights) < count:
            weights.append(self.start)
        return weights

    def step(self, key: object) -> float:
        seen = self.seen.get(key, 0)
        part = real(real(self.rate * self.half_life) / real(seen + self.half_life))
        return real(part + self.floor)

    def count(self, key: object) -> None:
        self.seen[key] = min(self.seen.get(key, 0) + 1, 60000)


class PlainMixer:
    """Of one selector or more."""

    def __init__(self, start: float, rate: tuple[float, float, float]):
        self.start, self.rate = start, rate
        self.sets: list[Sets] = []

    def decode(self, coder: RangeDecoder, inputs, selected: tuple) -> int:
        while len(self.sets) < len(selected):
            self.sets.append(Sets(0.0 if self.sets else self.start, self.rate))
        n = len(inputs)
        picked = [sets.of(key, n) for sets, key in zip(self.sets, selected)]
        weights = picked[0][:n]
        for other in picked[1:]:
            weights = plus(weights, other[:n])
        probability = squash(clamp(total(times(weights, inputs)), -11.0, 11.0))
        bit = coder.bit(int(clamp(real(probability * 65536), 4.0, 65532.0)))
        step = real(self.sets[0].step(selected[0]) * real(bit - probability))
        for i, weights in enumerate(picked):
            weights[:n] = plus(weights[:n], scaled(inputs, step if i == 0 else real(0.5 * step)))
        self.sets[0].count(selected[0])
        return bit


class LayeredMixer:
    """Of several selectors, the first and the last of them once more, and several final sets."""

    def __init__(self, start: float, rate: tuple[float, float, float], final_floor: float):
        self.start, self.rate = start, rate
        self.final_rate = (0.015, 10.0, final_floor)
        self.sets: list[Sets] = []
        self.finals: list[Sets] = []

    def _make(self, selectors: int, finals: int) -> None:
        self.sets = [Sets(self.start, self.rate) for _ in range(selectors + 2)]
        self.finals = [Sets(1 / (selectors + 2), self.final_rate) for _ in range(finals)]

    def decode(self, coder: RangeDecoder, inputs, selected: tuple, final_keys: tuple) -> int:
        if not self.sets:
            self._make(len(selected), len(final_keys))
        n, picked = len(inputs), (*selected, selected[0], selected[-1])
        logits = [
            clamp(total(times(sets.of(key, n)[:n], inputs)), -11.0, 11.0)
            for sets, key in zip(self.sets, picked)
        ]
        finals = [sets.of(key, len(logits)) for sets, key in zip(self.finals, final_keys)]
        mixed, mean = [], 0.0
        for weights in finals:
            u = total(times(weights, row(logits)))
            mixed.append(u)
            mean = real(mean + u)
        mean = real(mean * real(1 / len(finals)))
        probability = squash(clamp(mean, -11.0, 11.0))
        bit = coder.bit(int(clamp(real(probability * 65536), 4.0, 65532.0)))
        for sets, key, weights, u in zip(self.finals, final_keys, finals, mixed):
            step = real(sets.step(key) * real(bit - squash(clamp(u, -11.0, 11.0))))
            sets.count(key)
            weights[:] = plus(weights, scaled(row(logits), step))
        for i, (sets, key, logit) in enumerate(zip(self.sets, picked, logits)):
            pace = (real(0.2), 3.0)[i - len(selected)] if i >= len(selected) else 1.0
            step = real(real(sets.step(key) * pace) * real(bit - squash(logit)))
            sets.count(key)
            weights = sets.of(key, n)
            weights[:n] = plus(weights[:n], scaled(inputs, step))
        return bit


class Evidence:
    """Inputs, and the counters among them."""

    def __init__(self, counters: Counters, greatest_age: int = GREATEST_AGE):
        self.all, self.inputs, self.greatest_age = counters, row(), greatest_age
        self.used: list[Counter] = []

    def add(self, logit: float) -> None:
        self.inputs.append(clamp(logit, -8.0, 8.0))

    def context(self, *context: object) -> None:
        counter = self.all[context]
        self.used.append(counter)
        self.inputs.append(counter.evidence())

    def learn(self, bit: int) -> int:
        for counter in self.used:
            counter.learn(bit, self.greatest_age)
        return bit


class Situation:
    """Classes of a question."""

    def __init__(self, q: Question, p: Scene):
        self.size = limited(half_octave(real(q.size[q.axis] / p.spacing)) + 10, 0, 17)
        self.surface = fine(p.surface_evidence())
        self.open = min(q.open, 21)
        self.distances = p.distances()
        self.error, self.mass, self.kinds = 5, 0, (8, 8, 8)
        if p.in_cell:
            self.error = limited(half_octave(p.candidate_error) + 10, 0, 9)
            answers = p.candidates.answers
            self.kinds = tuple(coarse(a[0].evidence) for a in answers)
            mass = real(0.01)
            for a in answers[:2]:
                mass = real(mass + real(a[-1].lower + a[-1].upper))
            self.mass = 1 + limited((half_octave(mass) >> 1) + 7, 0, 9)


def fine(logit: float) -> int:
    return class_of(logit, 2, 12.5, 25)


def coarse(logit: float) -> int:
    return class_of(logit, 2, 8.5, 17)


def doubt(logit: float) -> float:
    p = squash(logit)
    return real(real(4 * p) * real(1.0 - p))


class DecisionModel:
    USUAL = (0.02, 60.0, 0.003)

    def __init__(self, flags: set[str]):
        self.flags, self.layered = flags, "two layers" in flags
        self.counters = Counters()
        if self.layered:
            self.side_mixer = LayeredMixer(0.12, (0.04, 400.0, 0.007), 0.003)
            self.more_mixer = LayeredMixer(0.2, (0.05, 200.0, 0.005), 0.003)
        else:
            self.side_mixer, self.more_mixer = (PlainMixer(0.12, self.USUAL) for _ in range(2))
        self.share_mixer = PlainMixer(0.12, self.USUAL)
        self.flat_mixer = PlainMixer(0.06, self.USUAL)

    def upper_count(self, coder: RangeDecoder, n: int, q: Question, p: Scene) -> int:
        s = Situation(q, p)
        if n == 1:
            return self._side(coder, 0, s, q, p)
        if n <= 8:
            fewer = 0
            while fewer < n // 2 and self._more(coder, n, fewer, s, q, p):
                fewer += 1
            if 2 * fewer == n:
                return fewer
            return n - fewer if self._side(coder, 1 if n == 2 else 2, s, q, p) else fewer
        if not self._more(coder, 9, 0, s, q, p):
            return n if self._side(coder, 2, s, q, p) else 0
        low, high, depth = 1, n - 1, 0
        while low < high:
            middle = (low + high + 1) // 2
            if self._share(coder, n, depth, (low, middle, high), s, p):
                low = middle
            else:
                high = middle - 1
            depth += 1
        return low

    def _side(self, coder: RangeDecoder, z: int, s: Situation, q: Question, p: Scene) -> int:
        flags = self.flags
        e = Evidence(self.counters, 120 if self.layered else GREATEST_AGE)
        e.add(1.0)
        e.add(p.surface_evidence())
        for flag, value in (("narrow quadric", p.narrow_quadric), ("plane", p.plane_evidence)):
            if flag in flags:
                e.add(value)
        if "axis values" in flags:
            e.add(p.axis_values.evidence)
        if not p.in_cell or "density" in flags:
            e.add(p.density)
        if p.in_cell:
            for _, answers in p.candidates.heard():
                for answer in answers:
                    e.add(answer.evidence)
            e.add(p.narrow)
            if "wide coordinates" in flags:
                e.add(p.wide)
        self._side_contexts(e, z, s, q, p)
        second: tuple = (z, s.mass, s.error) if p.in_cell else (z,)
        first: tuple = (p.in_cell, z, s.size, q.axis)
        if p.phase_evidence is not None:
            e.add(p.phase_evidence)
            e.context("side", 11, z, fine(p.phase_evidence), q.open)
            first = ("lattice", z, q.axis, q.open)
        if not self.layered:
            return e.learn(self.side_mixer.decode(coder, e.inputs, (first, second)))
        about = (p.in_cell, z)
        selected = (
            first, (*about, min(s.distances)), (z, s.mass, s.open), (z, *s.kinds[:2]),
            (*about, s.surface), second,
        )  # fmt: skip
        finals = (about, (*about, s.error, q.axis))
        return e.learn(self.side_mixer.decode(coder, e.inputs, selected, finals))

    def _side_contexts(self, e: Evidence, z: int, s: Situation, q: Question, p: Scene) -> None:
        flags, c = self.flags, s.kinds
        e.context("side", 0, z, s.surface, s.size)
        e.context("side", 1, z, c[0], c[1], s.mass)
        if not p.in_cell or "nearest" in flags:
            e.context("side", 2, z, *s.distances)
        one_layer = not self.layered
        if one_layer and (not p.in_cell or "projection" in flags):
            e.context("side", 3, z, c[2], s.surface)
        if "axis values" in flags:
            e.context("side", 4, z, *p.axis_values.classes, s.open)
        if "many contexts" not in flags:
            return
        narrow = coarse(p.narrow) if p.in_cell else 8
        e.context("side", 5, z, class_of(p.density, 3, 12.5, 25), s.size)
        e.context("side", 6, z, c[0], narrow, q.axis)
        if not one_layer:
            return
        ratio = real(real(p.surface_error * p.spacing) / q.size[q.axis])
        e.context("side", 7, z, narrow, s.size)
        e.context("side", 8, z, fine(p.plane_evidence), s.surface)
        e.context("side", 9, z, c[2], s.size)
        e.context("side", 10, z, s.surface, limited(half_octave(ratio) + 6, 0, 11))

    def flat_side(self, coder: RangeDecoder, q: Question, p: Scene) -> int:
        place = (q.axis, min(q.open, 15))
        e = Evidence(self.counters)
        e.add(1.0)
        for said in p.flat.evidence(q):
            e.add(said)
        e.add(p.narrow)
        e.context("flat", 0, place, fine(p.narrow))
        if "axis values" in self.flags:
            e.add(p.axis_values.evidence)
            e.context("flat", 1, place, *p.axis_values.classes)
        speaks = p.phase_evidence is not None
        if speaks:
            e.add(p.phase_evidence)
            e.context("flat", 2, place, fine(p.phase_evidence))
        return e.learn(self.flat_mixer.decode(coder, e.inputs, ((place, speaks),)))

    def _more(self, coder: RangeDecoder, n: int, fewer: int, s: Situation, q: Question, p: Scene) -> int:
        e, tiny = Evidence(self.counters), real(0.02)
        e.add(1.0)
        surface = doubt(p.surface_evidence())
        e.add(ln(real(surface + tiny)))
        if "plane" in self.flags:
            e.add(ln(real(doubt(p.plane_evidence) + tiny)))
        sparseness = abs(p.density)
        if not p.in_cell or "density" in self.flags:
            e.add(-sparseness)
        balance = 0
        if p.in_cell:
            for kind, answers in p.candidates.heard():
                a = answers[-1]
                share = real(real(min(a.lower, a.upper) + real(0.01)) / real(real(a.lower + a.upper) + tiny))
                e.add(real(ln(share) + 1.0))
                if kind < 2:
                    balance = 1 + class_of(share, 10, 0, 5)
        t = (min(n, 9), min(fewer, 4))
        doubt_class = class_of(surface, 7.99, 0, 8)
        low, high = sorted(s.distances)
        e.context("more", 0, t, s.size)
        e.context("more", 1, t, doubt_class, s.size)
        e.context("more", 2, t, doubt_class, balance, q.axis)
        e.context("more", 3, t, low, high)
        e.context("more", 4, t, class_of(sparseness, 3, 0, 8), s.size // 3)
        speaks = p.phase_evidence is not None
        if speaks:
            e.context("more", 5, t, fine(p.phase_evidence), q.open)
        if not self.layered:
            return e.learn(self.more_mixer.decode(coder, e.inputs, ((t, speaks), t)))
        selected = ((t, speaks), (t, s.size), (t, doubt_class, balance), (t, p.in_cell, q.axis))
        return e.learn(self.more_mixer.decode(coder, e.inputs, selected, (t, p.in_cell)))

    def _share(
        self, coder: RangeDecoder, n: int, depth: int, bounds: tuple[int, int, int], s: Situation, p: Scene
    ) -> int:
        spread = real(real(real(0.7) * p.density) + real(real(0.3) * p.plane_evidence))
        by_density = _share_evidence(n, bounds, squash(spread), real(1.3), 0.5)
        by_surface = _share_evidence(n, bounds, squash(p.surface_evidence()), 2.0, real(0.7))
        depth = min(depth, 7)
        e = Evidence(self.counters)
        e.add(1.0)
        e.add(by_density)
        e.add(by_surface)
        e.context("share", 0, depth, fine(by_density), min(half_octave(real(n)), 20))
        e.context("share", 1, depth, fine(by_surface), s.size)
        return e.learn(self.share_mixer.decode(coder, e.inputs, (depth, depth)))


def _share_evidence(n: int, bounds: tuple[int, int, int], p: float, widening: float, floor: float) -> float:
    mean = real(real(n) * p)
    scale = real(real(root(real(mean * real(1.0 - p))) * widening) + floor)
    low, middle, high = bounds
    places = (real(real(low) - 0.5), real(real(middle) - 0.5), real(real(high) + 0.5))
    at_low, at, at_high = (bell_of(real(real(x - mean) / scale)) for x in places)
    tiny = real(1e-5)
    return ln(real(real(real(at_high - at) + tiny) / real(real(at - at_low) + tiny)))
