"""Encodes random models and compares what both decoders find in the files.

    BSPC=build/dev/bin/bspc CONTENT_OF=build/dev/bin/content_of \\
      python3 tests/conformance/random_files.py [--seconds S] [--first SEED] [--count N]

ends with an error if they differ, and tells the seed; `--first SEED --count 1 --keep FILE` makes
that file again. `--rewrite` does so with the files random_METHOD_SEED.bspc of the conformance set
that are of open methods, for use when these have changed.
"""

from __future__ import annotations

import glob
import os
import subprocess
import sys
import tempfile

import random_models
import seed_runs
from content import Content
from elementary import FormatError


SET = os.path.join(os.path.dirname(__file__), "..", "..", "Testing", "Data", "conformance")


class Comparison:
    def __init__(self, bspc: str, content_of: str, folder: str):
        self.bspc = bspc
        self.model, self.coded = os.path.join(folder, "in.ply"), os.path.join(folder, "out.bspc")
        self.library = subprocess.Popen([content_of], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)

    def close(self) -> None:
        self.library.stdin.close()
        self.library.wait()
        self.library.stdout.close()

    def encode(self, seed: int) -> bytes | None:
        """The file of a seed; None if its options do not fit its model."""
        data, options = random_models.model(seed)
        with open(self.model, "wb") as stream:
            stream.write(data)
        run = subprocess.run(
            [self.bspc, "encode", self.model, self.coded, "--force", "--quiet", "--threads", "1", *options],
            capture_output=True,
        )
        if run.returncode:
            return None
        with open(self.coded, "rb") as stream:
            return stream.read()

    def outcome(self, seed: int) -> tuple[str, str]:
        """"same", "refused by the encoder" or "different", and what was found."""
        data = self.encode(seed)
        if data is None:
            return "refused by the encoder", ""
        self.library.stdin.write(self.coded + "\n")
        self.library.stdin.flush()
        wanted = self.library.stdout.readline().strip().split("\t")[1:]
        try:
            found = Content(data).hash()
        except FormatError as error:
            found = f"{error.kind}: {error}"
        if wanted[:2] == ["good", found]:
            return "same", found
        return "different", f"library {wanted}, second decoder {found}"


def rewrite(comparison: Comparison) -> None:
    for path in glob.glob(os.path.join(SET, "random_*.bspc")):
        data = comparison.encode(int(path[:-5].split("_")[-1]))
        if data is None:
            raise FormatError(f"{path} is refused by the encoder")
        with open(path, "wb") as stream:
            stream.write(data)


def main() -> int:
    parser = seed_runs.parser_of(__doc__)
    parser.add_argument("--rewrite", action="store_true")
    arguments = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        comparison = Comparison(os.environ["BSPC"], os.environ["CONTENT_OF"], folder)

        def outcome_of(seed: int) -> tuple[str, str]:
            outcome, what = comparison.outcome(seed)
            return outcome, f"{what}\n  {' '.join(random_models.model(seed)[1])}"

        if arguments.rewrite:
            rewrite(comparison)
            comparison.close()
            return 0
        outcomes = seed_runs.run(arguments, outcome_of)
        if arguments.keep:
            os.replace(comparison.coded, arguments.keep)
        comparison.close()
    # Nothing compared is no agreement.
    return 1 if outcomes["different"] or outcomes["same"] < outcomes["refused by the encoder"] else 0


if __name__ == "__main__":
    sys.exit(main())
