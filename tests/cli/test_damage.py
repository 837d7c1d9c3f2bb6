"""Files that were damaged or cut short: refused as a whole, or decoded as far as they are whole."""

import json
import os
import sys
import unittest

from command_support import CommandTest, column, lattice_cloud, read_points, write_ply


SOURCE = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(SOURCE, "tests", "conformance"))
from draft import Draft  # noqa: E402


class DamageTest(CommandTest):
    POINTS = lattice_cloud(3000, size=300)

    def encode(self, *options):
        write_ply(self.path("in.ply"), self.POINTS)
        self.succeed("encode", "in.ply", "good.bspc", *options)
        return self.read_bytes("good.bspc")

    def refuse_to_decode(self, data, *options):
        """The message of `decode`, which must write nothing, about a file of these bytes."""
        self.write_bytes("bad.bspc", data)
        return self.refuse("bad.bspc", "decode", "bad.bspc", "out.ply", *options)


class CoarseLevels(DamageTest):
    def test_are_verified_too(self):
        with open(os.path.join(SOURCE, "Testing/Data/frozen_1.0/kd_noise.bspc"), "rb") as file:
            draft = Draft(file.read())
        self.write_bytes("good.bspc", draft.bytes())
        self.succeed("verify", "good.bspc")
        # One representative instead of more; the points themselves are right.
        draft.tiles[0].overrides["layers"] = b"\1\1"
        self.write_bytes("bad.bspc", draft.bytes())
        self.refuse("bad.bspc", "verify", "bad.bspc")


class Flips(DamageTest):
    def check_flips(self, *options):
        good = self.encode(*options)
        # All of the head, then samples of the payload, then the end, where an index may stand.
        places = set(range(40)) | set(range(40, len(good), len(good) // 10))
        places |= set(range(len(good) - 12, len(good)))
        for place in sorted(places):
            with self.subTest(place=place, size=len(good)):
                bad = bytearray(good)
                bad[place] ^= 1 << place % 8
                self.refuse_to_decode(bytes(bad))

    def test_in_a_progressive_file_are_refused(self):
        self.check_flips("--layers", "3")

    def test_in_a_streaming_file_are_refused(self):
        self.check_flips("--layers", "3", "--layout", "streaming")

    def test_are_found_by_verify_and_info_too(self):
        bad = bytearray(self.encode())
        bad[len(bad) // 2] ^= 16
        self.write_bytes("bad.bspc", bytes(bad))
        self.refuse("bad.bspc", "verify", "bad.bspc")
        bad = bytearray(self.read_bytes("good.bspc"))
        bad[12] ^= 1
        self.write_bytes("bad.bspc", bytes(bad))
        self.refuse("bad.bspc", "info", "bad.bspc")


class OtherFiles(DamageTest):
    def test_truncations_are_refused(self):
        for layout in ("progressive", "streaming"):
            good = self.encode("--layers", "3", "--layout", layout, "--force")
            for size in (0, 1, 7, 8, 9, 20, len(good) // 3, len(good) // 2, len(good) - 1):
                with self.subTest(layout=layout, size=size):
                    self.refuse_to_decode(good[:size])

    def test_a_file_that_goes_on_after_its_end_is_refused(self):
        for layout in ("progressive", "streaming"):
            with self.subTest(layout):
                good = self.encode("--layout", layout, "--force")
                self.refuse_to_decode(good + b"\0")

    def test_a_model_is_not_taken_for_a_bspc_file(self):
        self.encode()
        self.refuse("in.ply", "decode", "in.ply", "out.ply")
        self.refuse("in.ply", "info", "in.ply")

    def test_a_damaged_model_is_refused(self):
        self.encode()
        self.write_bytes("cut.ply", self.read_bytes("in.ply")[:-5])
        self.refuse("cut.ply", "encode", "cut.ply", "out.bspc")
        self.write_bytes("odd.xyz", b"1 2 3\n4 five 6\n")
        self.refuse("odd.xyz", "encode", "odd.xyz", "out.bspc")

    def test_a_memory_limit_is_kept(self):
        write_ply(self.path("in.ply"), [(1.0, 2.0, 3.0)] * 200000)
        self.succeed("encode", "in.ply", "dense.bspc")
        self.refuse("dense.bspc", "decode", "dense.bspc", "out.ply", "--max-memory", "0.001")


class Partial(DamageTest):
    def info(self, name, *options):
        return json.loads(self.succeed("info", name, "--json", *options))

    def cut_in_layer(self, layer):
        """Keeps the layers before this one and half of it; returns what `info` says of the whole."""
        good = self.encode("--layers", "4", "--effort", "2")
        info = self.info("good.bspc")
        missing = sum(entry["bytes"] for entry in info["layers"][layer + 1 :])
        size = len(good) - missing - info["layers"][layer]["bytes"] // 2
        self.write_bytes("cut.bspc", good[:size])
        return info

    def test_a_cut_progressive_file_gives_its_whole_layers(self):
        info = self.cut_in_layer(2)
        self.assertIn("--partial", self.refuse("cut.bspc", "decode", "cut.bspc", "out.ply"))
        self.succeed("decode", "cut.bspc", "out.ply", "--partial", "--counts")
        self.assertEqual(len(read_points(self.path("out.ply"))), info["layers"][1]["points"])
        self.assertEqual(sum(column(self.path("out.ply"), "PointCount")), len(self.POINTS))
        self.assertEqual(self.info("cut.bspc", "--partial")["wholeLayers"], 2)
        # The same points as the whole file's layers up to that one.
        self.succeed("decode", "good.bspc", "level.ply", "--level", "1")
        self.assertEqual(
            read_points(self.path("out.ply")), read_points(self.path("level.ply"))
        )

    def test_a_cut_in_the_last_layer_still_gives_the_others(self):
        info = self.cut_in_layer(3)
        self.succeed("decode", "cut.bspc", "out.ply", "--partial")
        self.assertEqual(len(read_points(self.path("out.ply"))), info["layers"][2]["points"])

    def test_a_streaming_file_without_its_index_gives_its_whole_tiles(self):
        good = self.encode("--layers", "3", "--layout", "streaming")
        for missing in (1, 10):
            with self.subTest(missing):
                self.write_bytes("cut.bspc", good[:-missing])
                message = self.refuse("cut.bspc", "decode", "cut.bspc", "out.ply")
                self.assertIn("--partial", message)
                self.succeed("decode", "cut.bspc", "out.ply", "--partial")
                self.assertEqual(read_points(self.path("out.ply")), sorted(self.POINTS))
                os.remove(self.path("out.ply"))

    def test_a_streaming_file_without_a_whole_tile_gives_nothing(self):
        good = self.encode("--layers", "3", "--layout", "streaming")
        self.refuse_to_decode(good[: len(good) // 2], "--partial")

    def test_a_whole_file_is_whole_with_partial_too(self):
        for layout in ("progressive", "streaming"):
            with self.subTest(layout):
                self.encode("--layers", "3", "--layout", layout, "--force")
                self.succeed("decode", "good.bspc", "out.ply", "--partial", "--force")
                self.assertEqual(read_points(self.path("out.ply")), sorted(self.POINTS))

    def test_damage_is_refused_with_partial_too(self):
        good = self.encode("--layers", "3")
        bad = bytearray(good)
        bad[len(good) - self.info("good.bspc")["layers"][2]["bytes"] // 2] ^= 1
        self.refuse_to_decode(bytes(bad), "--partial")
        self.refuse_to_decode(good[:9], "--partial")


if __name__ == "__main__":
    unittest.main()
