"""Faces through the command: PLY, OBJ and OFF files there and back."""

import json
import struct
import unittest

from command_support import CommandTest

CUBE = """OFF
8 7 0
0 0 0
4 0 0
4 4 0
0 4 0
0 0 4
4 0 4
4 4 4
0 4 4
4 3 2 1 0
4 4 5 6 7
4 0 1 5 4
4 1 2 6 5
4 2 3 7 6
3 3 0 4
3 3 4 7
"""


def faces_of_off(text):
    """Faces by the places of their corners, from the smallest on, sorted."""
    numbers = [line.split() for line in text.splitlines()[1:]]
    count, faces = int(numbers[0][0]), int(numbers[0][1])
    points = [tuple(float(x) for x in row) for row in numbers[1 : 1 + count]]
    shapes = []
    for row in numbers[1 + count : 1 + count + faces]:
        shape = [points[int(i)] for i in row[1:]]
        start = shape.index(min(shape))
        shapes.append(shape[start:] + shape[:start])
    return sorted(shapes)


class Meshes(CommandTest):
    def write_text(self, name, text):
        self.write_bytes(name, text.encode("ascii"))

    def read_text(self, name):
        return self.read_bytes(name).decode("ascii")

    def encode(self, name, text, *options):
        self.write_text(name, text)
        self.succeed("encode", name, "m.bspc", "--force", *options)

    def decode(self, name, *options):
        self.succeed("decode", "m.bspc", name, "--force", *options)

    def test_faces_come_back_in_every_format(self):
        self.encode("cube.off", CUBE)
        self.succeed("verify", "m.bspc", "--against", "cube.off")
        self.decode("back.off")
        self.assertEqual(faces_of_off(self.read_text("back.off")), faces_of_off(CUBE))
        for name in ("back.ply", "back.obj", "back.off"):
            with self.subTest(name):
                self.decode(name)
                self.succeed("encode", name, "again.bspc", "--force")
                self.succeed("verify", "again.bspc", "--against", "cube.off")

    def test_info_tells_of_faces(self):
        self.encode("cube.off", CUBE)
        mesh = json.loads(self.succeed("info", "--json", "m.bspc"))["mesh"]
        self.assertEqual((mesh["faces"], mesh["lines"], mesh["vertexCells"]), (7, 0, 0))
        self.assertIn(b"7 faces", self.succeed("info", "m.bspc"))

    def test_kept_order_keeps_faces_as_they_were(self):
        self.encode("cube.off", CUBE, "--keep-order")
        self.decode("back.off")
        self.assertEqual(self.read_text("back.off"), CUBE)

    def test_lines_and_points_of_obj_files(self):
        text = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 2\np 2\nl 1 3 4\nf -4 -3 -2\n"
        self.encode("mixed.obj", text)
        self.succeed("verify", "m.bspc", "--against", "mixed.obj")
        self.decode("back.obj")
        lines = self.read_text("back.obj").splitlines()
        self.assertEqual(sorted(line[0] for line in lines), list("#flpvvvv"))
        self.refuse("back.off", "decode", "m.bspc", "back.off")
        self.decode("back.off", "--no-faces")

    def test_faces_can_be_left_out(self):
        self.encode("cube.off", CUBE, "--no-faces")
        self.assertNotIn("mesh", json.loads(self.succeed("info", "--json", "m.bspc")))
        self.encode("cube.off", CUBE)
        self.decode("back.off", "--no-faces")
        self.assertIn("8 0 0", self.read_text("back.off"))
        done = self.run_bspc("decode", "m.bspc", "back.xyz")
        self.assertIn(b"without the faces", done.stderr)

    def test_binary_ply_with_large_faces(self):
        head = (
            "ply\nformat binary_big_endian 1.0\nelement vertex 300\nproperty float x\n"
            "property float y\nproperty float z\nelement face 1\n"
            "property list int int vertex_indices\nend_header\n"
        )
        body = b"".join(struct.pack(">3f", i, i * i % 7, 0) for i in range(300))
        body += struct.pack(">301i", 300, *range(300))
        self.write_bytes("polygon.ply", head.encode("ascii") + body)
        self.succeed("encode", "polygon.ply", "m.bspc")
        self.succeed("verify", "m.bspc", "--against", "polygon.ply")
        self.decode("back.ply")
        self.succeed("encode", "back.ply", "again.bspc")
        self.succeed("verify", "again.bspc", "--against", "polygon.ply")

    def test_faces_of_text_ply_files(self):
        head = (
            "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
            "property float z\nelement face 2\nproperty list uchar int vertex_index\nend_header\n"
        )
        self.encode("a.ply", head + "0 0 0\n1 0 0\n1 1 0\n0 1 1\n3 0 1 2\n4 0 2 3 1\n")
        self.succeed("verify", "m.bspc", "--against", "a.ply")
        self.assertIn(b"2 faces", self.succeed("info", "m.bspc"))

    def test_wrong_faces_are_errors(self):
        for face in ("f 1 2 9", "f 0 1 2", "f 1 2 -9", "f a b c"):
            with self.subTest(face):
                self.write_text("wrong.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n" + face + "\n")
                self.refuse("wrong.obj", "encode", "wrong.obj", "m.bspc")

    def test_verify_finds_other_faces(self):
        self.encode("cube.off", CUBE)
        self.write_text("other.off", CUBE.replace("3 3 4 7", "3 3 7 4"))
        self.assertIn("faces", self.refuse("m.bspc", "verify", "m.bspc", "--against", "other.off"))

    def test_a_file_that_was_cut_short_gives_its_points(self):
        self.encode("cube.off", CUBE)
        self.write_bytes("cut.bspc", self.read_bytes("m.bspc")[:-3])
        self.assertIn("--partial", self.refuse("cut.bspc", "decode", "cut.bspc", "out.ply"))
        self.succeed("decode", "cut.bspc", "out.off", "--partial")
        self.assertIn("8 0 0", self.read_text("out.off"))


if __name__ == "__main__":
    unittest.main()
