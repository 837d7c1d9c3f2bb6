"""What tests of faults share: an old file that a failed command must leave as it was."""

from command_support import CommandTest, lattice_cloud, write_ply


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
