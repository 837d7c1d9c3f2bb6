"""The tree of method predictive, docs/format.md, section 13."""

from __future__ import annotations

from itertools import product

from predictive_model import DecisionModel
from predictive_residuals import AxisResiduals, ResidualModel
from predictive_scene import Scene
from predictive_surface import Question
from range_coder import AdaptiveBit, RangeDecoder
from reals import Vector, real, root

Point = tuple[int, int, int]


class Node:
    __slots__ = ("cell", "open", "count", "children", "first_known", "past_known")

    def __init__(self, cell: Point, open_bits: int, count: int):
        self.cell, self.open, self.count = cell, open_bits, count
        self.children: list[int] = []
        self.first_known = 0
        self.past_known: int | None = None  # set once the cell is finished

    def lower(self) -> Point:
        x, y, z = (c << self.open for c in self.cell)
        return x, y, z


class Tree:
    def __init__(self, features, extent: list[int], points: int):
        self.extent = extent
        self.bits = max(extent).bit_length()
        self.cell_points = features.cell_points
        self.scene = Scene(features, self.bits, points)
        self.model = DecisionModel(features.flags)
        self.residual_model = ResidualModel()
        self.deeper = AdaptiveBit()
        self.points: list[Point] = []
        self.start(points)

    def start(self, points: int) -> None:
        """A set of points of its own."""
        self.nodes: list[Node] = []
        self.places: dict[tuple, int] = {}
        self.scene.known.clear()
        self.level = 0
        if points:
            self._add(Node((0, 0, 0), self.bits, points))

    def _add(self, node: Node) -> int:
        self.places[node.open, node.cell] = len(self.nodes)
        self.nodes.append(node)
        return len(self.nodes) - 1

    def find(self, open_bits: int, cell: tuple) -> Node | None:
        number = self.places.get((open_bits, cell))
        return None if number is None else self.nodes[number]

    def coarse_layer(self, coder: RangeDecoder) -> tuple[list[Point], list[int]]:
        while self.level < len(self.nodes) and coder.adaptive(self.deeper):
            self._divide_level(coder)
        representatives, counts = [], []
        for node in self.nodes:
            if not node.children:
                lower = node.lower()
                inside = [min(1 << node.open, self.extent[k] + 1 - lower[k]) for k in range(3)]
                x, y, z = (lower[k] + (inside[k] - 1) // 2 for k in range(3))
                representatives.append((x, y, z))
                counts.append(node.count)
        return representatives, counts

    def final_layer(self, coder: RangeDecoder) -> None:
        while self.level < len(self.nodes):
            self._divide_level(coder)
        if self.nodes:
            self._walk(coder, self.nodes[0])

    def _question(self, lower: Point, sides: tuple[int, ...], axis: int) -> Question:
        at: Vector = tuple(real(lower[k] - self.origin[k]) for k in range(3))
        size: Vector = tuple(real(1 << s) for s in sides)
        return Question(at, size, axis, sides[axis], lower[axis])

    def _split(self, coder: RangeDecoder, lower: Point, sides: tuple, q: Question, n: int) -> int:
        middle = lower[q.axis] + (1 << (sides[q.axis] - 1))
        if middle > self.extent[q.axis]:
            self.scene.skip(q, self._is_flat(q, n))
            return 0
        if self._is_flat(q, n):
            self.scene.ask_flat(q)
            return self.model.flat_side(coder, q, self.scene)
        self.scene.ask(q)
        return self.model.upper_count(coder, n, q, self.scene)

    def _is_flat(self, q: Question, n: int) -> bool:
        return n == 1 and self.scene.in_cell and self.scene.flat.holds(q)

    @staticmethod
    def _part(lower: Point, sides: tuple, axis: int, upper: bool) -> tuple[Point, tuple]:
        shorter = list(sides)
        shorter[axis] -= 1
        corner = list(lower)
        if upper:
            corner[axis] += 1 << shorter[axis]
        return (corner[0], corner[1], corner[2]), tuple(shorter)

    # Breadth first.

    def _divide_level(self, coder: RangeDecoder) -> None:
        end = len(self.nodes)
        for i in range(self.level, end):
            node = self.nodes[i]
            if node.count <= self.cell_points or node.open == 0:
                continue
            self.origin = node.lower()
            self.scene.in_cell = False
            self._gather_around(node)
            self.scene.start_breadth_first(real(1 << node.open))
            self._divide(coder, node, node.lower(), (node.open,) * 3, 0, node.count)
        self.level = end

    def _divide(self, coder: RangeDecoder, node: Node, lower: Point, sides: tuple, axis: int, n: int) -> None:
        if axis == 3:
            open_bits = sides[0]
            x, y, z = (v >> open_bits for v in lower)
            node.children.append(self._add(Node((x, y, z), open_bits, n)))
            return
        upper = self._split(coder, lower, sides, self._question(lower, sides, axis), n)
        for half, count in ((False, n - upper), (True, upper)):
            if count:
                part = self._part(lower, sides, axis, half)
                self._divide(coder, node, *part, axis + 1, count)

    def _middle(self, node: Node) -> Vector:
        half = real(0.5 * real(1 << node.open))
        x, y, z = (real(real(a - b) + half) for a, b in zip(node.lower(), self.origin))
        return x, y, z

    def _add_cell(self, node: Node) -> None:
        side = real(1 << node.open)
        if not self.scene.in_cell:
            side = real(side + 1.0)
        self.scene.near.add(self._middle(node), real(node.count), side, None)

    def _gather_around(self, node: Node) -> None:
        self.scene.near.clear()
        for i in range(27):
            if i == 13:
                continue
            steps = (i // 9, i // 3 % 3, i % 3)
            cell = tuple(c + s - 1 for c, s in zip(node.cell, steps))
            if min(cell) < 0:
                continue
            found = self.find(node.open, cell)
            if found:
                if not found.children:
                    self._add_cell(found)
                for child in found.children:
                    self._add_cell(self.nodes[child])
                continue
            larger = self.find(node.open + 1, tuple(c >> 1 for c in cell))
            if larger and not larger.children and not self.scene.near.holds(self._middle(larger)):
                self._add_cell(larger)

    # Depth first.

    def _walk(self, coder: RangeDecoder, node: Node) -> None:
        if not node.children:
            self._code_cell(coder, node)
            return
        node.first_known = len(self.scene.known)
        for child in node.children:
            self._walk(coder, self.nodes[child])
        node.past_known = len(self.scene.known)

    def _code_cell(self, coder: RangeDecoder, node: Node) -> None:
        node.first_known = len(self.scene.known)
        self.origin = node.lower()
        self.scene.in_cell = True
        self._gather_touching(node)
        touching = len(self.scene.near.known)
        if "farther points" in self.scene.flags:
            self._gather_farther(node)
        self.scene.start_cell(real(1 << node.open), touching)
        self.changed = True
        sides = (node.open,) * 3
        if node.open == 0:
            self.scene.start_box(self._question(node.lower(), sides, 0), False)
        self._refine(coder, node.lower(), sides, 0, node.count, False)
        node.past_known = len(self.scene.known)

    def _add_finished(self, node: Node) -> None:
        if node.children or node.past_known is None:
            self._add_cell(node)
        else:
            self._add_known(node)

    def _add_known(self, node: Node) -> None:
        for i in range(node.first_known, node.past_known):
            self.scene.near.add(self._in_cell(self.scene.known[i].position), 1.0, 1.0, i)

    def _in_cell(self, position: Point) -> Vector:
        x, y, z = (real(real(a - b) + 0.5) for a, b in zip(position, self.origin))
        return x, y, z

    def _gather_touching(self, node: Node) -> None:
        self.scene.near.clear()
        self.count, self.area = real(node.count), 1.0
        large: list[Node] = []
        for corner in range(8):
            cell = []
            for k in range(3):
                up = node.cell[k] & 1
                beside = corner >> k & 1
                cell.append((node.cell[k] >> 1) + (beside if up else -beside))
            if min(cell) < 0:
                continue
            found = self.find(node.open + 1, tuple(cell))
            if found:
                self._gather_children(found, node)
                continue
            for up in (1, 2):
                cell = [c >> 1 for c in cell]
                larger = self.find(node.open + 1 + up, tuple(cell))
                if larger is None:
                    continue
                if not larger.children and larger not in large:
                    large.append(larger)
                    self._add_finished(larger)
                    self._count(larger, 4 << 2 * up)
                break
        spacing = real(real(1 << node.open) / root(real(self.count / self.area)))
        self.scene.cell_spacing = spacing if spacing >= 1 else 1.0

    def _gather_farther(self, node: Node) -> None:
        known = sum(i is not None for i in self.scene.near.known)
        if known >= self.scene.features.near_points + 8:
            return
        for step in product((-1, 0, 1), repeat=3):
            cell = tuple((c >> 1) + s for c, s in zip(node.cell, step))
            found = self.find(node.open + 1, cell) if min(cell) >= 0 else None
            for number in found.children if found else ():
                child = self.nodes[number]
                away = max(abs(a - b) for a, b in zip(child.cell, node.cell))
                if away == 2 and child.past_known is not None:
                    self._add_known(child)

    def _count(self, node: Node, area: int) -> None:
        self.count = real(self.count + real(node.count))
        self.area += area

    def _gather_children(self, parent: Node, node: Node) -> None:
        if not parent.children:
            self._add_finished(parent)
            self._count(parent, 4)
            return
        for number in parent.children:
            child = self.nodes[number]
            if max(abs(a - b) for a, b in zip(child.cell, node.cell)) != 1:
                continue
            self._count(child, 1)
            if not child.children:
                self._add_finished(child)
            for below in child.children:
                grandchild = self.nodes[below]
                if not grandchild.children or grandchild.past_known is None:
                    self._add_finished(grandchild)
                    continue
                for last in grandchild.children:
                    self._add_finished(self.nodes[last])

    def _refine(self, coder: RangeDecoder, lower: Point, sides: tuple, axis: int, n: int, halved: bool) -> None:
        if not any(sides):
            self._emit(lower, n)
            return
        while sides[axis] == 0:
            axis = (axis + 1) % 3
        q = self._question(lower, sides, axis)
        if n == 1 and "residuals" in self.scene.flags:
            self._residuals(coder, lower, sides, q)
            return
        if not halved or self.changed:
            self.scene.start_box(q, n == 1)
            self.changed = False
        if n == 1:
            self._refine_one(coder, lower, sides, axis)
            return
        upper = self._split(coder, lower, sides, q, n)
        whole = upper in (0, n)
        if whole:
            self.scene.take(axis, upper, False)
        for half, count in ((False, n - upper), (True, upper)):
            if count:
                self._refine(coder, *self._part(lower, sides, axis, half), (axis + 1) % 3, count, whole)

    def _refine_one(self, coder: RangeDecoder, lower: Point, sides: tuple, axis: int) -> None:
        while any(sides):
            while sides[axis] == 0:
                axis = (axis + 1) % 3
            q = self._question(lower, sides, axis)
            upper = self._split(coder, lower, sides, q, 1)
            self.scene.take(axis, upper, self._is_flat(q, 1))
            lower, sides = self._part(lower, sides, axis, bool(upper))
            axis = (axis + 1) % 3
        self._emit(lower, 1)

    def _residuals(self, coder: RangeDecoder, lower: Point, sides: tuple, box: Question) -> None:
        self.scene.start_residuals(box)
        residuals = AxisResiduals(box, self.scene)
        for rank, axis in enumerate(residuals.axes):
            if sides[axis]:
                q = self._question(lower, sides, axis)
                self.residual_model.start_axis(q, residuals.expected(rank), self.scene.spacing)
            while sides[axis]:
                upper = 0
                if lower[axis] + (1 << (sides[axis] - 1)) <= self.extent[axis]:
                    q = self._question(lower, sides, axis)
                    upper = self.residual_model.upper(coder, q, self.scene)
                lower, sides = self._part(lower, sides, axis, bool(upper))
            residuals.at[axis] = self._in_cell(lower)[axis]
            self.scene.candidates.weigh_at(axis, residuals.at[axis])
        self._emit(lower, 1)

    def _emit(self, position: Point, n: int) -> None:
        self.scene.learn(position, self._in_cell(position))
        self.changed = True
        self.points += [position] * n

