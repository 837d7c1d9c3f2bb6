"""Mixed bits of docs/format.md, section 14: context bits and a mixer."""

from __future__ import annotations

from functools import lru_cache

from range_coder import RangeDecoder

_LOGISTIC = [22, 36, 60, 98, 162, 267, 439, 720, 1179, 1921, 3108, 4971, 7812, 11955, 17625, 24743]
_LOGISTIC += [32768, 40793, 47911, 53581, 57724, 60565, 62428, 63615, 64357, 64816, 65097, 65269]
_LOGISTIC += [65374, 65438, 65476, 65500, 65514]


def squash(x: int) -> int:
    i, t = divmod(x + 2048, 128)
    return (_LOGISTIC[i] * (128 - t) + _LOGISTIC[i + 1] * t + 64) // 128


_SQUASHED = [squash(x) for x in range(-2047, 2048)]


@lru_cache(maxsize=None)
def _stretched(sixteenth: int) -> int:
    wanted = 16 * sixteenth + 8
    return next((x - 2047 for x, s in enumerate(_SQUASHED) if s >= wanted), 2047)


def stretch(p: int) -> int:
    return _stretched(p // 16)


class MixedBits:
    """Tables of context bits, one for each input of the mixers, and the mixers."""

    def __init__(self, inputs: int, weight: int):
        self.inputs, self.weight = inputs, weight
        self.bits: list[dict[int, list[int]]] = [{} for _ in range(inputs)]
        self.mixers: dict[tuple, list[int]] = {}

    def decode(self, coder: RangeDecoder, mixer: tuple, places: list[int]) -> int:
        weights = self.mixers.setdefault(mixer, [self.weight] * self.inputs)
        models = [t.setdefault(p, [32768, 0]) for t, p in zip(self.bits, places)]
        logits = [stretch(m[0]) for m in models]
        mixed = sum(w * x for w, x in zip(weights, logits)) >> 16
        probability = squash(min(max(mixed, -2047), 2047))
        bit = coder.bit(probability)
        error = (65535 if bit else 0) - probability
        for i, x in enumerate(logits):
            weight = weights[i] + ((x * error + (1 << 13)) >> 14)
            weights[i] = min(max(weight, -(1 << 22)), 1 << 22)
        for model in models:
            rate = 655360 // (10 * model[1] + 16)
            if bit:
                model[0] += (65535 - model[0]) * rate >> 16
            else:
                model[0] -= model[0] * rate >> 16
            model[1] = min(model[1] + 1, 160)
        return bit
