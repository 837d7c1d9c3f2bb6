"""Zstandard frames (RFC 8878), by the system's libzstd."""

from __future__ import annotations

import ctypes
import ctypes.util

from elementary import require

_library = ctypes.CDLL(ctypes.util.find_library("zstd") or "libzstd.so.1")
_library.ZSTD_decompress.restype = ctypes.c_size_t
_library.ZSTD_decompress.argtypes = [ctypes.c_void_p, ctypes.c_size_t, ctypes.c_void_p, ctypes.c_size_t]
_library.ZSTD_isError.restype = ctypes.c_uint
_library.ZSTD_isError.argtypes = [ctypes.c_size_t]
_library.ZSTD_findFrameCompressedSize.restype = ctypes.c_size_t
_library.ZSTD_findFrameCompressedSize.argtypes = [ctypes.c_void_p, ctypes.c_size_t]


MAGIC = bytes.fromhex("28B52FFD")
MOST_WINDOW = 1 << 23


def _check(frame: bytes) -> None:
    """One whole frame such as section 1 allows."""
    require(len(frame) >= 6 and frame[:4] == MAGIC, "not a zstd frame")
    compressed = _library.ZSTD_findFrameCompressedSize(bytes(frame), len(frame))
    require(compressed == len(frame), "not one zstd frame")
    descriptor = frame[4]
    require(not descriptor & 3, "a zstd frame with a dictionary")
    if descriptor & 32:  # one segment: its content's size follows
        width = 1 << (descriptor >> 6)
        window = int.from_bytes(frame[5 : 5 + width], "little") + (256 if width == 2 else 0)
    else:
        base = 1 << 10 + (frame[5] >> 3)
        window = base + (base >> 3) * (frame[5] & 7)
    require(window <= MOST_WINDOW, "a zstd frame needs too large a window")


def one_frame(frame: bytes, size: int) -> bytes:
    """The `size` bytes that one whole frame gives."""
    _check(frame)
    out = ctypes.create_string_buffer(max(size, 1))
    got = _library.ZSTD_decompress(out, size, bytes(frame), len(frame))
    require(not _library.ZSTD_isError(got) and got == size, "a zstd frame is damaged")
    return out.raw[:size]


def any_frame(frame: bytes, most: int = 1 << 26) -> bytes:
    """What one whole frame gives, at most `most` bytes."""
    _check(frame)
    size = 1 << 12
    while size <= most:
        out = ctypes.create_string_buffer(size)
        got = _library.ZSTD_decompress(out, size, bytes(frame), len(frame))
        if not _library.ZSTD_isError(got):
            return out.raw[:got]
        size *= 8
    require(False, "a zstd frame is damaged")
