"""The range decoder of docs/format.md, section 8."""

from __future__ import annotations

from elementary import FormatError, require

MASK64 = (1 << 64) - 1
MASK32 = (1 << 32) - 1


class AdaptiveBit:
    __slots__ = ("probability", "age")

    def __init__(self) -> None:
        self.probability = 32768
        self.age = 0


class AdaptiveBits(dict):
    """A model for each context that occurs."""

    def __missing__(self, context: tuple) -> "AdaptiveBit":
        model = self[context] = AdaptiveBit()
        return model


class AdaptiveSymbol:
    def __init__(self, size: int, first: int | list[int] = 24, growth: int = 24, limit: int = 16384) -> None:
        self.frequencies = list(first) if isinstance(first, list) else [first] * size
        self.total = sum(self.frequencies)
        self.growth = growth
        self.limit = limit

    def learn(self, symbol: int) -> None:
        self.frequencies[symbol] += self.growth
        self.total += self.growth
        if self.total > self.limit:
            self.frequencies = [(f + 1) // 2 for f in self.frequencies]
            self.total = sum(self.frequencies)


class RangeDecoder:
    def __init__(self, data: bytes) -> None:
        self.data = bytes(data)
        self.position = 0
        self.missing = 0
        self.range = MASK64
        self.code = 0
        for _ in range(8):
            self.code = self.code << 8 | self._byte()

    def _byte(self) -> int:
        if self.position < len(self.data):
            self.position += 1
            return self.data[self.position - 1]
        self.missing += 1
        if self.missing > 8:
            raise FormatError("a payload ends early")
        return 0

    def _normalise(self) -> None:
        if self.range < 1 << 32:
            self.range = self.range << 32
            self.code &= MASK32
            for _ in range(4):
                self.code = self.code << 8 | self._byte()

    def finish(self) -> None:
        require(self.position == len(self.data), "a payload goes on after its end")

    def part(self, total: int) -> int:
        """A part of width 1 of a whole."""
        step = self.range // total
        value = min(self.code // step, total - 1)
        self.code -= step * value
        self.range = step
        self._normalise()
        return value

    def symbol(self, model: AdaptiveSymbol) -> int:
        step = self.range // model.total
        value = min(self.code // step, model.total - 1)
        start = 0
        for symbol, frequency in enumerate(model.frequencies):
            if value < start + frequency:
                break
            start += frequency
        self.code -= step * start
        self.range = step * frequency
        self._normalise()
        model.learn(symbol)
        return symbol

    def bit(self, probability: int) -> int:
        bound = (self.range >> 16) * probability
        if self.code < bound:
            self.range = bound
            bit = 1
        else:
            self.code -= bound
            self.range -= bound
            bit = 0
        self._normalise()
        return bit

    def raw(self, bits: int) -> int:
        self.range >>= bits
        value = min(self.code // self.range, (1 << bits) - 1)
        self.code -= self.range * value
        self._normalise()
        return value

    def wide(self, bits: int) -> int:
        value = 0
        while bits > 24:
            bits -= 24
            value |= self.raw(24) << bits
        return value | self.raw(bits)

    def uniform(self, last: int) -> int:
        if last == 0:
            return 0
        if last < 1 << 16:
            return self.part(last + 1)
        shift = last.bit_length() - 16
        top = last >> shift
        upper = self.part(top + 1)
        if upper < top:
            return upper << shift | self.wide(shift)
        return (upper << shift) + self.uniform(last & ((1 << shift) - 1))

    def adaptive(self, model: AdaptiveBit) -> int:
        bit = self.bit(model.probability)
        rate = 655360 // (10 * model.age + 16)
        if bit:
            model.probability += ((65504 - model.probability) * rate) >> 16
        else:
            model.probability -= ((model.probability - 32) * rate) >> 16
        model.age = min(model.age + 1, 95)
        return bit


def stream_of(payload: "bytes | RangeDecoder") -> RangeDecoder:
    """A payload's stream; tests give one that makes its payload (scripted.py)."""
    return payload if isinstance(payload, RangeDecoder) else RangeDecoder(payload)
