"""Makes bad files, one for every rule, and lets both decoders refuse them.

    CONTENT_OF=build/dev/bin/content_of python3 tests/conformance/bad_files.py [--write FOLDER]

A file is a good one of the conformance set in which one rule is broken and all checksums are right.
`--write` puts them into a folder, with a list of what is wrong and how they must be refused.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
from collections import Counter
from typing import Iterator

from bad_container import (
    BadFile,
    array_field_rules,
    file_rules,
    grid_rules,
    head_rules,
    streaming_rules,
    tile_rules,
)
from bad_payloads import (
    array_rules,
    cell_array_rules,
    fast_rules,
    mesh_rules,
    partition_rules,
    predictive_rules,
    streaming_mesh_rules,
    surface_array_rules,
    surface_rules,
)
from content import Content
from elementary import FormatError

DATA = os.path.join(os.path.dirname(__file__), "..", "..", "Testing", "Data")
# What the library calls the kinds of the second decoder.
LIBRARY_KINDS = {"not bspc": "not a .bspc file"}


def good(name: str) -> bytes:
    folders = ("frozen_1.0", "golden", "conformance")
    paths = [os.path.join(DATA, folder, name + ".bspc") for folder in folders]
    with open(next(p for p in paths if os.path.exists(p)), "rb") as stream:
        return stream.read()


def all_bad_files() -> Iterator[BadFile]:
    layers = good("kd_noise")
    for rules in (file_rules, head_rules, tile_rules):
        yield from rules(layers)
    yield from grid_rules(good("kd_terrain"))
    yield from streaming_rules(good("streaming_tiles"))
    yield from array_field_rules(good("kd_arrays"))
    methods = {m: good(f"{m}_terrain_bits") for m in ("kd", "bsp", "octree", "gencode")}
    yield from partition_rules(methods)
    yield from fast_rules(good("fast_slabs_gaps"), good("fast_slabs_trees"), good("fast_noise"))
    yield from array_rules(good("kd_arrays"))
    yield from predictive_rules(good("predictive_terrain_bits"))
    yield from mesh_rules(good("mesh"))
    yield from cell_array_rules(good("all_cells"), good("joined_cells"))
    yield from streaming_mesh_rules(good("mesh_streaming"))
    yield from surface_rules(good("surface_mesh"), good("random_surface_647"))
    yield from surface_array_rules(good("surface_mesh_arrays"))


def second_decoder(data: bytes) -> str:
    """The kind of error by which the second decoder refuses a file, or "good"."""
    try:
        Content(data).hash()
    except FormatError as error:
        return LIBRARY_KINDS.get(error.kind, error.kind)
    return "good"


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--write", metavar="FOLDER")
    arguments = parser.parse_args()
    outcomes: Counter = Counter()
    with tempfile.TemporaryDirectory() as scratch:
        folder = arguments.write or scratch
        files = list(all_bad_files())
        paths = [os.path.join(folder, f"bad_{i:03d}.bspc") for i in range(len(files))]
        for path, (_, _, data) in zip(paths, files):
            with open(path, "wb") as stream:
                stream.write(data)
        if arguments.write:
            with open(os.path.join(folder, "bad.txt"), "w", encoding="utf-8") as lines:
                for path, (what, kind, _) in zip(paths, files):
                    lines.write(f"{os.path.basename(path)}\t{kind}\t{what}\n")
        run = subprocess.run([os.environ["CONTENT_OF"], *paths], capture_output=True, text=True, check=True)
        for (what, kind, data), line in zip(files, run.stdout.splitlines()):
            library, second = line.split("\t")[1:], second_decoder(data)
            right = library[:2] == ["bad", kind] and second == kind
            outcomes[kind if right else "wrong"] += 1
            if not right:
                print(f"{what}: must be {kind}; library: {' '.join(library)}; second decoder: {second}")
    print(f"{len(files)} bad files: " + ", ".join(f"{n} {k}" for k, n in sorted(outcomes.items())))
    return 1 if outcomes["wrong"] or not files else 0


if __name__ == "__main__":
    sys.exit(main())
