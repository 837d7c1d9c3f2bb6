"""Elementary types of docs/format.md, section 1."""

from __future__ import annotations

import struct


class FormatError(Exception):
    """A rule of the format is violated; `kind` is corrupt, truncated, unsupported or not bspc."""

    def __init__(self, message: str, kind: str = "corrupt") -> None:
        super().__init__(message)
        self.kind = kind


def require(condition: object, message: str, kind: str = "corrupt") -> None:
    if not condition:
        raise FormatError(message, kind)


def bit_length(value: int) -> int:
    return value.bit_length()


# Number of a scalar type: name, bytes, letter of the struct module.
SCALAR_TYPES = {
    0: ("float32", 4, "f"),
    1: ("float64", 8, "d"),
    2: ("int8", 1, "b"),
    3: ("uint8", 1, "B"),
    4: ("int16", 2, "h"),
    5: ("uint16", 2, "H"),
    6: ("int32", 4, "i"),
    7: ("uint32", 4, "I"),
    8: ("int64", 8, "q"),
    9: ("uint64", 8, "Q"),
}
BIT, STRING = 10, 11
FLOAT32, FLOAT64, UINT8, UINT16, UINT32, UINT64 = 0, 1, 3, 5, 7, 9


def type_name(scalar_type: int) -> str:
    return {BIT: "bit", STRING: "string"}.get(scalar_type) or SCALAR_TYPES[scalar_type][0]


def value_size(scalar_type: int) -> int:
    return 1 if scalar_type == BIT else SCALAR_TYPES[scalar_type][1]


def is_float(scalar_type: int) -> bool:
    return scalar_type in (FLOAT32, FLOAT64)


def float32(value: float) -> float:
    """The nearest float32 of a float64; infinite beyond the greatest."""
    try:
        return struct.unpack("<f", struct.pack("<f", value))[0]
    except OverflowError:
        return float("inf") if value > 0 else float("-inf")


class Reader:
    """Reads elementary types from bytes, from the first on."""

    def __init__(
        self,
        data: bytes,
        position: int = 0,
        end: int | None = None,
        short: str = "corrupt",
        tail: object = None,
    ) -> None:
        """`short` is the kind of error if the data end early: only those of a file are truncated.
        `tail`: what stands for the rest, in tests that make it while it is read (scripted.py)."""
        self.data, self.short, self.tail = data, short, tail
        self.position = position
        self.end = len(data) if end is None else end

    def left(self) -> int:
        return self.end - self.position

    def bytes(self, size: int) -> bytes:
        require(size <= self.left(), "content ends early", self.short)
        self.position += size
        return self.data[self.position - size : self.position]

    def rest(self) -> bytes:
        rest = self.bytes(self.left())
        return rest if self.tail is None else self.tail

    def inner(self) -> "Reader":
        """What is left, as content of its own."""
        return Reader(self.bytes(self.left()), tail=self.tail)

    def u8(self) -> int:
        return self.bytes(1)[0]

    def unsigned(self, size: int) -> int:
        return int.from_bytes(self.bytes(size), "little")

    def varint(self) -> int:
        value = 0
        for i in range(10):
            byte = self.u8()
            value |= (byte & 127) << (7 * i)
            if byte < 128:
                require(byte != 0 or i == 0, "a varint is longer than it must be")
                require(value < 1 << 64, "a varint is above 64 bits")
                return value
        raise FormatError("a varint is above 64 bits")

    def svarint(self) -> int:
        value = self.varint()
        return value // 2 if value % 2 == 0 else -(value // 2) - 1

    def text(self) -> bytes:
        return self.bytes(self.varint())

    def finish(self) -> None:
        require(self.position == self.end, "content goes on after its end")


def reader_of(data: bytes | Reader) -> Reader:
    return data if isinstance(data, Reader) else Reader(data)
