"""A second decoder of .bspc files, written from docs/format.md alone.

    python3 decoder.py FILE...

prints what each file holds as JSON, with the hash of its decoded content (see
Testing/Data/conformance/README.md), or the kind of error that it is refused with.
"""

from __future__ import annotations

import json
import sys
from collections import Counter

from container import METHODS, File
from content import Content
from elementary import FormatError, type_name


def summary(data: bytes) -> dict:
    """What a file of these bytes holds; throws FormatError."""
    file = File(data)
    head = file.head
    result = {
        "version": f"{file.major}.{file.minor}",
        "layout": "streaming" if head.streaming else "progressive",
        "points": sum(t.points for t in file.tiles),
        "layers": [
            sum(1 if layer < t.lacking else t.representatives[layer - t.lacking] for t in file.tiles)
            for layer in range(head.layers)
        ],
        "methods": Counter(METHODS.get(t.method, str(t.method)) for t in file.tiles),
        "tiles": len(file.tiles),
        "keepsOrder": head.keeps_order,
        "arrays": {
            a.name.decode("utf-8", "replace"): f"{type_name(a.scalar_type)} x {a.components}"
            for a in head.arrays
        },
        "cells": head.mesh.counts if head.mesh else [0, 0, 0],
    }
    result["content"] = Content(data).hash()
    return result


def main() -> int:
    if len(sys.argv) < 2 or sys.argv[1] in ("-h", "--help"):
        print(__doc__.strip())
        return 0 if len(sys.argv) > 1 else 2
    failed = False
    for name in sys.argv[1:]:
        with open(name, "rb") as stream:
            data = stream.read()
        try:
            result = summary(data)
        except FormatError as error:
            result = {"error": error.kind, "message": str(error)}
            failed = True
        print(json.dumps({"file": name, **result}, indent=2))
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
