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


def one_frame(frame: bytes, size: int) -> bytes:
    """The `size` bytes that one whole frame gives."""
    compressed = _library.ZSTD_findFrameCompressedSize(bytes(frame), len(frame))
    require(compressed == len(frame), "not one zstd frame")
    out = ctypes.create_string_buffer(max(size, 1))
    got = _library.ZSTD_decompress(out, size, bytes(frame), len(frame))
    require(not _library.ZSTD_isError(got) and got == size, "a zstd frame is damaged")
    return out.raw[:size]


def any_frame(frame: bytes, most: int = 1 << 26) -> bytes:
    """What one whole frame gives, at most `most` bytes."""
    compressed = _library.ZSTD_findFrameCompressedSize(bytes(frame), len(frame))
    require(compressed == len(frame), "not one zstd frame")
    size = 1 << 12
    while size <= most:
        out = ctypes.create_string_buffer(size)
        got = _library.ZSTD_decompress(out, size, bytes(frame), len(frame))
        if not _library.ZSTD_isError(got):
            return out.raw[:got]
        size *= 8
    require(False, "a zstd frame is damaged")
