"""Method predictive of docs/format.md, section 13: its features, layers and sets."""

from __future__ import annotations

from elementary import require
from predictive_sets import Mirror, RangeImage
from predictive_tree import Point, Tree
from range_coder import RangeDecoder, stream_of

FLAGS = (
    "quadric", "plane", "parallelograms", "projection", "separate kinds", "two scales",
    "axis values", "wide coordinates", "density", "nearest", "many contexts", "phases", "mirrors",
    "range images", "two layers", "narrow quadric", "farther points", "chains", "residuals",
)  # fmt: skip
_LOWEST = {"quadric", "parallelograms", "axis values", "phases", "mirrors", "range images"}
_SIXTH = _LOWEST | {"projection"}
_SEVENTH = _SIXTH | {"separate kinds", "nearest", "many contexts"}
# Effort: flags, near points, pair reach, refit, flat share.
EFFORTS = {
    5: (_LOWEST | {"residuals"}, 6, 8, 0, 0),
    6: (_SIXTH, 10, 9, 1, 6),
    7: (_SEVENTH, 13, 14, 1, 4),
    8: (set(FLAGS) - {"residuals"}, 16, 36, 1, 2),
    9: (set(FLAGS) - {"residuals"}, 20, 64, 2, 0),
}
OWN = 15


class Features:
    """How a tile was coded, and the lattices of its axes."""

    def __init__(self, coder: RangeDecoder):
        self.effort = coder.raw(4)
        self.cell_points = 6
        if self.effort == OWN:
            flags = coder.wide(32)
            require(flags < 1 << len(FLAGS), "unknown features")
            self.flags = {name for i, name in enumerate(FLAGS) if flags >> i & 1}
            self.cell_points, self.near_points, self.pair_reach, self.refit, self.flat_share = (
                coder.raw(8) for _ in range(5)
            )
            require(self.cell_points >= 1, "cells of no points")
            require(1 <= self.near_points <= 24, "a wrong number of near points")
            require(self.refit <= 2, "an unknown way to refit")
        else:
            require(self.effort in EFFORTS, "an unknown effort")
            self.flags, self.near_points, self.pair_reach, self.refit, self.flat_share = (
                EFFORTS[self.effort]
            )
        self.lattices = [0, 0, 0]
        if "phases" in self.flags:
            self.lattices = [coder.wide(32) if coder.bit(2048) else 0 for _ in range(3)]


class Predictive:
    MOST_PLANES = 2

    def __init__(self, points: int, extent: list[int], version: int):
        require(version == 0, "unknown version of predictive", "unsupported")
        require(points < 1 << 32, "too many points for method predictive")
        self.n, self.extent = points, list(extent)
        self.tree: Tree | None = None

    def layer(self, payload: bytes, last: bool) -> tuple[list[Point], list[int]]:
        coder = stream_of(payload)
        if self.tree is None:
            self.features = Features(coder)
            self.tree = Tree(self.features, self.extent, self.n)
        if not last:
            result = self.tree.coarse_layer(coder)
            coder.finish()
            return result
        if self.tree.level == 0:
            self._sets(coder)
        else:
            self.tree.final_layer(coder)
        coder.finish()
        return self.tree.points, [1] * len(self.tree.points)

    def _sets(self, coder: RangeDecoder) -> None:
        if "range images" in self.features.flags and self.n >= 4000 and coder.bit(2048):
            self.tree.points += RangeImage(coder, self.extent, self.n).points(self.n)
            self._plain(coder, self.n - len(self.tree.points))
        else:
            self._set(coder, self.n, self.MOST_PLANES)

    def _plain(self, coder: RangeDecoder, n: int) -> None:
        self.tree.start(n)
        self.tree.final_layer(coder)

    def _set(self, coder: RangeDecoder, n: int, planes: int) -> None:
        may_be_mirrored = "mirrors" in self.features.flags and planes > 0 and n >= 16
        if not (may_be_mirrored and coder.bit(2048)):
            self._plain(coder, n)
            return
        mirror = Mirror(coder, self.extent)
        originals = coder.uniform(n)
        first = len(self.tree.points)
        self._set(coder, originals, planes - 1)
        left = n - originals
        for original in self.tree.points[first : first + originals]:
            copy = mirror.copy(original, self.tree.scene.phases)
            if copy is not None:
                require(left > 0, "a tile has more points than it says")
                left -= 1
                self.tree.points.append(copy)
                self.tree.scene.learn_coordinates(copy)
        self._plain(coder, left)
