"""XXH3 of 64 bits with seed 0, as the xxHash specification describes it."""

from __future__ import annotations

import struct

_SECRET = bytes.fromhex(
    "b8fe6c3923a44bbe7c01812cf721ad1cded46de9839097db7240a4a4b7b3671fcb79e64eccc0e578825ad07dccff7221"
    "b8084674f743248ee03590e6813a264c3c2852bb91c300cb88d0658b1b532ea371644897a20df94e3819ef46a9deacd8"
    "a8fa763fe39c343ff9dcbbc7c70b4f1d8a51e04bcdb45931c89f7ec9d9787364eac5ac8334d3ebc3c581a0fffa1363eb"
    "170ddd51b7f0da49d316552629d4689e2b16be587d47a1fc8ff8b8d17ad031ce45cb3a8f95160428afd7fbcabb4b407e"
)
_MASK = (1 << 64) - 1
_MASK32 = (1 << 32) - 1
_P32_1, _P32_2, _P32_3 = 0x9E3779B1, 0x85EBCA77, 0xC2B2AE3D
_P64_1, _P64_2, _P64_3 = 0x9E3779B185EBCA87, 0xC2B2AE3D27D4EB4F, 0x165667B19E3779F9
_P64_4, _P64_5 = 0x85EBCA77C2B2AE63, 0x27D4EB2F165667C5


def _u32(data: bytes, at: int) -> int:
    return int.from_bytes(data[at : at + 4], "little")


def _u64(data: bytes, at: int) -> int:
    return int.from_bytes(data[at : at + 8], "little")


def _rotate(value: int, bits: int) -> int:
    return (value << bits | value >> (64 - bits)) & _MASK


def _swap(value: int) -> int:
    return int.from_bytes(value.to_bytes(8, "little"), "big")


def _fold(a: int, b: int) -> int:
    product = a * b
    return (product & _MASK) ^ (product >> 64)


def _avalanche(h: int) -> int:
    h ^= h >> 37
    h = h * 0x165667919E3779F9 & _MASK
    return h ^ h >> 32


def _avalanche64(h: int) -> int:
    h ^= h >> 33
    h = h * _P64_2 & _MASK
    h ^= h >> 29
    h = h * _P64_3 & _MASK
    return h ^ h >> 32


def _mix(data: bytes, at: int, secret: int) -> int:
    return _fold(_u64(data, at) ^ _u64(_SECRET, secret), _u64(data, at + 8) ^ _u64(_SECRET, secret + 8))


def _short(data: bytes) -> int:
    n = len(data)
    if n == 0:
        return _avalanche64(_u64(_SECRET, 56) ^ _u64(_SECRET, 64))
    if n <= 3:
        combined = data[0] << 16 | data[n >> 1] << 24 | data[n - 1] | n << 8
        return _avalanche64(combined ^ _u32(_SECRET, 0) ^ _u32(_SECRET, 4))
    if n <= 8:
        h = _u32(data, n - 4) + (_u32(data, 0) << 32)
        h ^= _u64(_SECRET, 8) ^ _u64(_SECRET, 16)
        h ^= _rotate(h, 49) ^ _rotate(h, 24)
        h = h * 0x9FB21C651E98DF25 & _MASK
        h ^= (h >> 35) + n
        h = h * 0x9FB21C651E98DF25 & _MASK
        return h ^ h >> 28
    low = _u64(data, 0) ^ _u64(_SECRET, 24) ^ _u64(_SECRET, 32)
    high = _u64(data, n - 8) ^ _u64(_SECRET, 40) ^ _u64(_SECRET, 48)
    return _avalanche((n + _swap(low) + high + _fold(low, high)) & _MASK)


def _middle(data: bytes) -> int:
    n = len(data)
    h = n * _P64_1
    if n <= 128:
        for i in reversed(range((n - 1) // 32 + 1)):
            h += _mix(data, 16 * i, 32 * i) + _mix(data, n - 16 * (i + 1), 32 * i + 16)
        return _avalanche(h & _MASK)
    for i in range(8):
        h += _mix(data, 16 * i, 16 * i)
    h = _avalanche(h & _MASK)
    for i in range(8, n // 16):
        h += _mix(data, 16 * i, 16 * (i - 8) + 3)
    return _avalanche((h + _mix(data, n - 16, 136 - 17)) & _MASK)


def _accumulate(lanes: list[int], data: bytes, at: int, keys: tuple[int, ...]) -> None:
    words = struct.unpack_from("<8Q", data, at)
    for i in range(8):
        key = words[i] ^ keys[i]
        lanes[i ^ 1] += words[i]
        lanes[i] += (key & _MASK32) * (key >> 32)


def _long(data: bytes) -> int:
    n = len(data)
    lanes = [_P32_3, _P64_1, _P64_2, _P64_3, _P64_4, _P32_2, _P64_5, _P32_1]
    keys = [struct.unpack_from("<8Q", _SECRET, 8 * i) for i in range(17)]
    blocks = (n - 1) // 1024
    for b in range(blocks):
        for i in range(16):
            _accumulate(lanes, data, 1024 * b + 64 * i, keys[i])
        for i in range(8):
            lane = lanes[i] & _MASK
            lanes[i] = ((lane ^ lane >> 47) ^ keys[16][i]) * _P32_1 & _MASK
    for i in range((n - 1 - 1024 * blocks) // 64):
        _accumulate(lanes, data, 1024 * blocks + 64 * i, keys[i])
    _accumulate(lanes, data, n - 64, struct.unpack_from("<8Q", _SECRET, 192 - 64 - 7))
    lanes = [lane & _MASK for lane in lanes]
    h = n * _P64_1
    for i in range(4):
        secret = 11 + 16 * i
        h += _fold(lanes[2 * i] ^ _u64(_SECRET, secret), lanes[2 * i + 1] ^ _u64(_SECRET, secret + 8))
    return _avalanche(h & _MASK)


def xxh3(data: bytes) -> int:
    data = bytes(data)
    if len(data) <= 16:
        return _short(data)
    return _middle(data) if len(data) <= 240 else _long(data)


def checksum_width(size: int) -> int:
    return 4 if size < 65536 else 8


def checksum(data: bytes, size: int | None = None) -> int:
    """The checksum(size) of section 1."""
    width = checksum_width(len(data) if size is None else size)
    return xxh3(data) & ((1 << 8 * width) - 1)
