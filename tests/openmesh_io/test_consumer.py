"""Installs the OpenMesh module and builds a project of somebody else's against it."""

import os
import pathlib
import subprocess
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["BSPC_BUILD"])
HERE = pathlib.Path(__file__).resolve().parent

OFF = """OFF
5 5 0
0 0 0
1 0 0
1 1 0
0 1 0
0.5 0.5 1
4 3 2 1 0
3 0 1 4
3 1 2 4
3 2 3 4
3 3 0 4
"""


def run(*command, **options):
    done = subprocess.run(command, capture_output=True, text=True, **options)
    if done.returncode != 0:
        raise AssertionError(f"{command}\n{done.stdout}{done.stderr}")
    return done.stdout


class Consumer(unittest.TestCase):
    def test_finds_links_and_runs_the_installed_module(self):
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            run("cmake", "--install", str(BUILD), "--prefix", str(folder / "installed"))
            run("cmake", "-S", str(HERE / "consumer"), "-B", str(folder / "build"),
                f"-DCMAKE_PREFIX_PATH={folder / 'installed'}")
            run("cmake", "--build", str(folder / "build"))
            model = folder / "pyramid.off"
            model.write_text(OFF)
            for library in ("openmesh", "openmesh_static"):
                said = run(str(folder / "build" / f"read_write_{library}"), str(model),
                           str(folder / f"{library}.bspc"))
                self.assertEqual(said, "5 vertices, 5 faces\n")


if __name__ == "__main__":
    unittest.main()
