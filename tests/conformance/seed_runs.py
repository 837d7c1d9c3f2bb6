"""Comparisons of the two decoders on what random seeds make: one seed after the other."""

from __future__ import annotations

import argparse
import sys
import time
from collections import Counter
from typing import Callable


def parser_of(description: str | None) -> argparse.ArgumentParser:
    parser = argparse.ArgumentParser(
        description=description, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--seconds", type=float, default=600)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--count", type=int, default=sys.maxsize)
    parser.add_argument("--keep", help="a copy of the last file")
    return parser


def run(arguments: argparse.Namespace, outcome_of: Callable[[int], tuple[str, str]]) -> Counter:
    """How often each outcome came; what is different is printed at once."""
    outcomes: Counter = Counter()
    end = time.monotonic() + arguments.seconds
    seed = arguments.first
    while seed < arguments.first + arguments.count and time.monotonic() < end:
        outcome, what = outcome_of(seed)
        outcomes[outcome] += 1
        if outcome == "different":
            print(f"seed {seed}: {what}", flush=True)
        seed += 1
    print(f"seeds {arguments.first} to {seed - 1}: " + ", ".join(f"{n} {o}" for o, n in outcomes.items()))
    return outcomes
