"""bspc where reads and writes fail or come in pieces, and where memory runs out.

BSPC_FAULTY_FILES names the library that makes them do so (tests/faults/faulty_files.cpp), which is
loaded first. Sanitizers want that for themselves and need more memory, so they run without these.
"""

import os
import resource
import unittest

from command_support import write_text
from fault_support import FaultTest

FAULTY_FILES = os.environ["BSPC_FAULTY_FILES"]


class FaultyFiles(FaultTest):
    def faulty(self, name, **limits):
        environment = dict(os.environ, LD_PRELOAD=FAULTY_FILES, FAULTY_FILE=name)
        environment.update({key: str(value) for key, value in limits.items()})
        return {"env": environment}

    def test_that_are_read_and_written_in_pieces_are_as_others(self):
        self.succeed("decode", "in.bspc", "out.xyz")
        expected = self.read_bytes("out.xyz")
        self.succeed("encode", "in.ply", "a.bspc", **self.faulty("in.ply"))
        self.succeed("encode", "in.ply", "b.bspc", **self.faulty("b.bspc.part"))
        for name in ("a.bspc", "b.bspc"):
            self.assertEqual(self.read_bytes(name), self.read_bytes("in.bspc"))
        self.succeed("decode", "in.bspc", "a.xyz", **self.faulty("in.bspc"))
        self.assertEqual(self.read_bytes("a.xyz"), expected)
        self.succeed("encode", "a.xyz", "c.bspc", **self.faulty("a.xyz"))
        self.succeed("verify", "c.bspc", "--against", "in.ply", **self.faulty("c.bspc"))

    def test_that_cannot_be_read_are_named(self):
        write_text(self.path("in.xyz"), self.POINTS, "xyz")
        write_text(self.path("in.obj"), self.POINTS, "obj")
        for name in ("in.ply", "in.xyz", "in.obj"):
            for at in (0, 2000, os.path.getsize(self.path(name)) - 1):
                with self.subTest(name=name, at=at):
                    faulty = self.faulty(name, FAULTY_READ_AT=at)
                    self.refuse(name, "encode", name, "old.bspc", "--force", **faulty)
                    self.expect_old_files()
        for at in (0, 40, os.path.getsize(self.path("in.bspc")) - 1):
            with self.subTest(at=at):
                faulty = self.faulty("in.bspc", FAULTY_READ_AT=at)
                self.refuse("in.bspc", "decode", "in.bspc", "old.ply", "--force", **faulty)
                self.expect_old_files()

    def test_that_cannot_be_read_from_standard_input_are_not_taken_for_shorter_ones(self):
        write_text(self.path("in.xyz"), self.POINTS, "xyz")
        for name, command in (
            ("in.xyz", ("encode", "-", "old.bspc", "--from", "xyz", "--force")),
            ("in.bspc", ("decode", "-", "old.ply", "--force", "--partial")),
        ):
            with self.subTest(name), open(self.path(name), "rb") as file:
                faulty = self.faulty(name, FAULTY_READ_AT=os.path.getsize(self.path(name)) // 2)
                self.refuse("standard input", *command, stdin=file, **faulty)
                self.expect_old_files()

    def test_that_are_full_leave_the_old_file(self):
        for name, command in self.commands():
            for at in (0, 1000):
                with self.subTest(command=command, at=at):
                    faulty = self.faulty(".part", FAULTY_WRITE_AT=at)
                    self.refuse(name, *command, **faulty)
                    self.expect_old_files()


class Memory(FaultTest):
    SPACE = 256 << 20

    def limit(self):
        resource.setrlimit(resource.RLIMIT_AS, (self.SPACE, self.SPACE))

    def test_that_runs_out_is_an_error_that_leaves_the_old_file(self):
        rows = 20_000_000
        header = "ply\nformat binary_little_endian 1.0\nelement vertex %d\n" % rows
        header += "".join("property char %s\n" % axis for axis in "xyz") + "end_header\n"
        with open(self.path("dense.ply"), "wb") as file:
            file.write(header.encode("ascii"))
            file.truncate(file.tell() + 3 * rows)
        message = self.fail_with(
            1, "encode", "dense.ply", "old.bspc", "--force", "--method", "kd", preexec_fn=self.limit
        )
        self.assertIn("memory", message)
        self.expect_old_files()


if __name__ == "__main__":
    unittest.main()
