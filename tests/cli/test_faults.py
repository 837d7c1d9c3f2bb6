"""Disks that are full, reads that fail, signals, and memory that runs out.

BSPC_FAULTY_FILES names a library that makes reads and writes fail (tests/faults/faulty_files.cpp);
without it those tests are left out.
"""

import os
import resource
import signal
import subprocess
import time
import unittest

from command_support import BSPC, CommandTest, lattice_cloud, read_points, write_ply, write_text

FAULTY_FILES = os.environ.get("BSPC_FAULTY_FILES", "")


class FaultTest(CommandTest):
    POINTS = lattice_cloud(3000, size=3000)

    def setUp(self):
        super().setUp()
        write_ply(self.path("in.ply"), self.POINTS)
        self.succeed("encode", "in.ply", "in.bspc")
        self.write_bytes("old.bspc", b"what was there before")
        self.write_bytes("old.ply", b"what was there before")

    def expect_old_files(self):
        for name in ("old.bspc", "old.ply"):
            self.assertEqual(self.read_bytes(name), b"what was there before")

    def commands(self):
        """What writes over the old files."""
        yield "old.bspc", ("encode", "in.ply", "old.bspc", "--force")
        yield "old.bspc", ("join", "in.bspc", "in.bspc", "-o", "old.bspc", "--force")
        for kind in ("ply", "xyz"):
            yield "old.ply", ("decode", "in.bspc", "old.ply", "--force", "--to", kind)


class FullDisk(FaultTest):
    def test_leaves_the_old_file(self):
        for size in (0, 100, 3000):

            def limit(size=size):
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

            for name, command in self.commands():
                with self.subTest(command=command, size=size):
                    self.refuse(name, *command, preexec_fn=limit)
                    self.expect_old_files()

    def test_is_an_error_of_info_too(self):
        with open("/dev/full", "wb") as full:
            for options in ((), ("--json",)):
                self.refuse("standard output", "info", "in.bspc", *options, stdout=full)


@unittest.skipUnless(FAULTY_FILES, "needs BSPC_FAULTY_FILES")
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


class Signals(FaultTest):
    def start(self):
        """An encode that waits for the rest of its input, and has begun to write."""
        process = subprocess.Popen(
            [BSPC, "encode", "-", "old.bspc", "--from", "ply", "--force"],
            cwd=self.folder,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            stderr=subprocess.PIPE,
        )
        self.addCleanup(process.kill)
        self.addCleanup(process.communicate)
        process.stdin.write(self.read_bytes("in.ply")[:1000])
        process.stdin.flush()
        before = len(self.files())
        deadline = time.monotonic() + 60
        while not self.unfinished() and time.monotonic() < deadline:
            time.sleep(0.01)
        self.assertEqual(len(self.files()), max(before, 5))
        return process

    def unfinished(self):
        return [name for name in self.files() if ".part" in name]

    def test_that_kill_leave_the_old_file_and_nothing_that_looks_like_a_result(self):
        process = self.start()
        process.kill()
        process.communicate()
        self.assertEqual(process.returncode, -signal.SIGKILL)
        self.expect_old_files()
        for name in self.unfinished():
            self.assertFalse(name.endswith((".bspc", ".ply")))
            self.fail_with(1, "info", name)
        self.succeed("encode", "in.ply", "old.bspc", "--force")
        self.assertEqual(self.read_bytes("old.bspc"), self.read_bytes("in.bspc"))

    def test_that_interrupt_twice_end_at_once(self):
        process = self.start()
        for _ in range(200):  # the first one is noted, which takes a moment
            process.send_signal(signal.SIGINT)
            time.sleep(0.05)
            if process.poll() is not None:
                break
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertEqual(self.unfinished(), [])
        self.expect_old_files()

    def test_that_interrupt_once_leave_the_old_file(self):
        for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
            with self.subTest(number):
                process = self.start()
                process.send_signal(number)
                _, errors = process.communicate(self.read_bytes("in.ply")[1000:], timeout=120)
                self.assertEqual(process.returncode, 1)
                self.assertIn(b"stopped as asked", errors)
                self.assertEqual(self.unfinished(), [])
                self.expect_old_files()


class Processes(FaultTest):
    def run_together(self, *commands):
        started = [
            subprocess.Popen([BSPC, *command], cwd=self.folder, stderr=subprocess.PIPE)
            for command in commands
        ]
        for process in started:
            _, errors = process.communicate(timeout=120)
            self.assertEqual(process.returncode, 0, errors)

    def test_that_read_one_file_get_the_same(self):
        self.run_together(*[("decode", "in.bspc", "%d.ply" % i) for i in range(4)])
        for i in range(4):
            self.assertEqual(self.read_bytes("%d.ply" % i), self.read_bytes("0.ply"))
        self.assertEqual(read_points(self.path("0.ply")), sorted(self.POINTS))

    def test_that_write_one_file_leave_a_whole_one(self):
        self.run_together(*[("encode", "in.ply", "old.bspc", "--force")] * 4)
        self.assertEqual(self.read_bytes("old.bspc"), self.read_bytes("in.bspc"))
        self.assertEqual([name for name in self.files() if ".part" in name], [])


class Memory(FaultTest):
    SPACE = 256 << 20

    def limit(self):
        resource.setrlimit(resource.RLIMIT_AS, (self.SPACE, self.SPACE))

    def test_that_runs_out_is_an_error_that_leaves_the_old_file(self):
        if self.run_bspc("--version", preexec_fn=self.limit).returncode != 0:
            self.skipTest("a sanitizer needs more")
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
