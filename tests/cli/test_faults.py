"""Disks that are full, signals, and processes that read and write one file."""

import os
import resource
import signal
import subprocess
import tempfile
import time
import unittest

from command_support import BSPC, read_points
from fault_support import FaultTest


class FullDisk(FaultTest):
    def test_leaves_the_old_file(self):
        # Counts of the lines that run are files too, and the limit would leave half of one.
        counts = tempfile.TemporaryDirectory()
        self.addCleanup(counts.cleanup)
        apart = {**os.environ, "GCOV_PREFIX": counts.name, "GCOV_ERROR_FILE": os.devnull}
        # ThreadSanitizer writes a file when it starts, and would be what a limit of 0 stops.
        for size in (1, 100, 3000):

            def limit(size=size):
                resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))

            for name, command in self.commands():
                with self.subTest(command=command, size=size):
                    self.refuse(name, *command, preexec_fn=limit, env=apart)
                    self.expect_old_files()

    def test_is_an_error_of_info_too(self):
        with open("/dev/full", "wb") as full:
            for options in ((), ("--json",)):
                self.refuse("standard output", "info", "in.bspc", *options, stdout=full)


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


if __name__ == "__main__":
    unittest.main()
