"""Bad files: ParaView says what is wrong in a sentence and stays alive."""

import os
import unittest

from paraview_support import GOLDEN, ParaViewTest


class Damage(ParaViewTest):
    def test_every_kind_of_bad_file_is_an_error_that_can_be_read(self):
        with open(os.path.join(GOLDEN, "fast_terrain.bspc"), "rb") as file:
            good = file.read()
        flipped = bytearray(good)
        flipped[len(good) // 2] ^= 0x10
        newer = bytearray(good)
        newer[8] = 99
        # A head that claims more tiles than the file can hold.
        huge = good[:10] + bytes([1, 9, 0]) + bytes([0xFF] * 8) + good[21:]
        cases = {
            "truncated.bspc": (good[: len(good) // 2], "ends early"),
            "flipped.bspc": (bytes(flipped), "checksum"),
            "newer.bspc": (bytes(newer), "version"),
            "magic.bspc": (b"PLY" + good[3:], ""),
            "empty.bspc": (b"", ""),
            "huge.bspc": (huge, ""),
        }
        for name, (content, _) in cases.items():
            with open(self.path(name), "wb") as file:
                file.write(content)
        out = self.batch(
            f"""
import sys
for name in {list(cases)!r}:
    print('file', name, flush=True)
    sys.stderr.flush()
    try:
        reader = OpenDataFile(name)
        reader.UpdatePipeline()
        print('points', reader.GetDataInformation().GetNumberOfPoints(), flush=True)
    except RuntimeError as error:
        print('refused', str(error).splitlines()[0], flush=True)
reader = OpenDataFile({os.path.join(GOLDEN, "fast_terrain.bspc")!r})
print('alive', points_of(reader), flush=True)
"""
        )
        self.assertEqual(self.told(out, "alive"), ["1600"], out)
        self.assertNotIn("1600", " ".join(self.told(out, "points")))
        for name, (_, words) in cases.items():
            self.assertIn(words, out, name)


if __name__ == "__main__":
    unittest.main()
