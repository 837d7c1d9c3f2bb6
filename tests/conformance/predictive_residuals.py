"""Lone points axis by axis, docs/format.md, section 13, "Residuals"."""

from __future__ import annotations

from lanes import bell_of
from predictive_model import Evidence, PlainMixer, class_of, limited
from predictive_scene import Scene, half_octave
from predictive_surface import TWELFTH, Question
from range_coder import RangeDecoder
from reals import Counter, Counters, Vector, clamp, ln, real, root

SURFACE = 3  # where candidates speak, the number of axes before


class AxisResiduals:
    """Where the only point of a box is expected."""

    def __init__(self, q: Question, p: Scene):
        self.p = p
        self.at = list(q.centre)
        self.variance = [real(real(s * s) * TWELFTH) for s in q.size]
        quadric, plane = p.surface.quadric, p.surface.plane
        normal: Vector = (0.0, 0.0, 0.0)
        if quadric or plane:
            normal = (quadric or plane).normal
        self.axes = sorted(range(3), key=lambda k: abs(normal[k]))
        if quadric:
            height = real(clamp(quadric.at(q.centre)[0], -0.5, 0.5) / quadric.unit)
            self.at = [real(x - real(height * n)) for x, n in zip(self.at, quadric.normal)]

    def expected(self, rank: int) -> tuple[float, float, int]:
        """Place, scale and what says so."""
        k = self.axes[rank]
        mean, variance, unexplained = self.p.candidates.moments(k, self.at[k])
        variance = real(variance + real(unexplained * self.variance[k]))
        place = real(self.at[k] + mean)
        least = self.p.candidates.kernel_variance()
        scale = root(real(max(variance, 0.0) + least))
        quadric = self.p.surface.quadric
        if rank < 2 or not quadric:
            return place, scale, rank
        there = [*self.at]
        there[k] = place
        height, gradient = quadric.at((there[0], there[1], there[2]))
        slope = abs(gradient[k])
        if not slope > real(0.4):
            return place, scale, rank
        other = real(real(self.p.surface_error / real(slope * quadric.unit)) + real(0.3))
        if not other < scale:
            return place, scale, rank
        away = clamp(real(height / gradient[k]), -1.0, 1.0)
        return real(place - real(away / quadric.unit)), other, SURFACE


class ResidualModel:
    def __init__(self) -> None:
        self.counters = Counters()
        self.mixer = PlainMixer(0.3, (0.02, 60.0, 0.003))

    def start_axis(self, q: Question, expected: tuple[float, float, int], spacing: float) -> None:
        self.place, scale, self.kind = expected
        self.inverse = real(1.0 / scale)
        self.scale_class = limited(half_octave(real(scale / spacing)) + 9, 0, 11)
        low = q.lower[q.axis]
        self.at_low, self.at_high = self._bell(low), self._bell(real(low + q.size[q.axis]))
        self.first = True

    def _bell(self, bound: float) -> float:
        return bell_of(real(real(bound - self.place) * self.inverse))

    def upper(self, coder: RangeDecoder, q: Question, p: Scene) -> int:
        at, tiny = self._bell(q.middle), real(1e-4)
        above = real(real(self.at_high - at) + tiny)
        evidence = ln(real(above / real(real(at - self.at_low) + tiny)))
        bit = self._sure(coder, q, evidence) if abs(evidence) > 2 else self._mixed(coder, q, p, evidence)
        if bit:
            self.at_low = at
        else:
            self.at_high = at
        self.first = False
        return bit

    def _sure(self, coder: RangeDecoder, q: Question, evidence: float) -> int:
        logit = class_of(real(abs(evidence) - 2.0), 3, 0, 16)
        counter: Counter = self.counters["sure", self.kind, min(q.open, 8), logit]
        as_expected = coder.bit(limited(counter.probability >> 8, 32, 65536 - 32))
        counter.learn(as_expected)
        return int(bool(as_expected) == (evidence > 0))

    def _mixed(self, coder: RangeDecoder, q: Question, p: Scene, evidence: float) -> int:
        p.ask_values(q)
        e = Evidence(self.counters)
        e.add(evidence)
        halves = real(real(self.place - q.middle) / real(0.5 * q.size[q.axis]))
        distance = class_of(halves, 4, 8.5, 17)
        e.context("near", self.kind, self.first, self.scale_class, distance, min(q.open, 8))
        if "axis values" in p.flags:
            e.add(p.axis_values.evidence)
            e.context("values", min(q.open, 16), *p.axis_values.classes)
        speaks = p.phase_evidence is not None
        if speaks:
            e.add(p.phase_evidence)
            phase = class_of(p.phase_evidence, 2, 12.5, 25)
            e.context("phases", q.axis, min(q.open, 16), phase)
        selected = (self.kind, q.axis, min(q.open, 8), speaks)
        return e.learn(self.mixer.decode(coder, e.inputs, (selected,)))
