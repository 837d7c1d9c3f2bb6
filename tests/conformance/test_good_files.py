"""Both decoders read every good file of the conformance set, with the content that the set tells.

The second one leaves out what takes it long unless CONFORMANCE_ALL is set.
"""

from __future__ import annotations

import glob
import hashlib
import os
import subprocess
import sys
import unittest

from container import METHODS, File
from content import Content
from elementary import FormatError

SET = os.path.join(os.path.dirname(__file__), "..", "..", "Testing", "Data", "conformance")
LIST = os.path.join(SET, "good.txt")
FROZEN = os.path.join(SET, "..", "frozen_1.0")
SUMS = os.path.join(FROZEN, "SHA256SUMS")
# Of that list. It may grow, when a feature of version 1.0 turns out to have no file; nothing that
# it has may go or change.
SUM_OF_SUMS = "73afcf6a4c4e4dd1ec062c2e80502469040f832fe7e42bf3a3bb2e4db9a26f5d"
FOLDERS = (FROZEN, os.path.join(SET, "..", "golden"), SET)


def listed() -> dict[str, str]:
    """Path from the set's folder: hash."""
    with open(LIST, encoding="utf-8") as lines:
        return {path: wanted for wanted, path in (line.split() for line in lines)}


def contents_by_library(program: str, paths: list[str]) -> dict[str, list[str]]:
    """Path: what content_of prints about it."""
    run = subprocess.run(
        [program, *(os.path.join(SET, p) for p in paths)], capture_output=True, text=True, check=True
    )
    return {p: line.split("\t")[1:] for p, line in zip(paths, run.stdout.splitlines())}


QUICK = ("predictive_lattice", "predictive_range_image")


def is_too_slow(path: str, file: File) -> bool:
    """Whether the second decoder needs more than some seconds."""
    if any(name in path for name in QUICK):
        return False
    return any(METHODS[t.method] == "predictive" and t.points > 50 for t in file.tiles)


def read(path: str) -> bytes:
    with open(os.path.join(SET, path), "rb") as stream:
        return stream.read()


def all_files() -> list[str]:
    """Paths from the set's folder."""
    found = [f for folder in FOLDERS for f in glob.glob(os.path.join(folder, "*.bspc"))]
    return [os.path.relpath(f, SET) for f in found]


class GoodFiles(unittest.TestCase):
    def test_list_has_all_files(self):
        self.assertEqual(sorted(all_files()), sorted(listed()))

    def test_frozen_files_are_as_they_were(self):
        with open(SUMS, "rb") as stream:
            sums = stream.read()
        self.assertEqual(hashlib.sha256(sums).hexdigest(), SUM_OF_SUMS)
        told = dict(reversed(line.split()) for line in sums.decode().splitlines())
        names = [os.path.basename(f) for f in glob.glob(os.path.join(FROZEN, "*.bspc"))]
        found = {n: hashlib.sha256(read(os.path.join(FROZEN, n))).hexdigest() for n in names}
        self.assertEqual(found, told)

    def test_library_finds_the_content_that_is_told(self):
        wanted = listed()
        found = contents_by_library(os.environ["CONTENT_OF"], list(wanted))
        for path, content in found.items():
            with self.subTest(path):
                self.assertEqual(content[:2], ["good", wanted[path]])

    def test_second_decoder_finds_the_content_that_is_told(self):
        for path, wanted in listed().items():
            with self.subTest(path):
                data = read(path)
                file = File(data)  # of every file at least the structure
                if is_too_slow(path, file) and "CONFORMANCE_ALL" not in os.environ:
                    continue
                self.assertEqual(Content(data).hash(), wanted)

    def test_second_decoder_reads_the_example_of_the_specification(self):
        with open(os.path.join(SET, "../../../docs/format.md"), encoding="utf-8") as lines:
            example = lines.read().split("<!-- example: begin -->")[1].split("<!-- example: end -->")[0]
        pairs = [line[6:].split("  ")[0] for line in example.splitlines() if line.startswith("00")]
        content = Content(bytes.fromhex("".join(pairs)))
        self.assertEqual(content.tiles[0].points[-1], [(0, 0, 0), (0, 3, 1), (3, 0, 0), (2, 2, 3)])
        self.assertEqual([content.head.grid.coordinate(k, 3) for k in range(3)], [1.0, 2.25, -1.25])


def write_list(program: str) -> None:
    paths = all_files()
    with open(LIST, "w", encoding="utf-8") as lines:
        for path, content in sorted(contents_by_library(program, paths).items()):
            if content[0] != "good":
                raise FormatError(f"{path}: {content}")
            lines.write(f"{content[1]}  {path}\n")


if __name__ == "__main__":
    if sys.argv[1:2] == ["--write"]:
        write_list(sys.argv[2])
    else:
        unittest.main()
