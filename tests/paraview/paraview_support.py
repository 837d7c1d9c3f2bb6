"""What the tests of the ParaView plugin share: they run ParaView's programs as people do."""

import glob
import os
import shutil
import subprocess
import tempfile
import unittest

PLUGIN = os.environ["BSPC_PLUGIN"]
SOURCE = os.environ["BSPC_SOURCE"]
GOLDEN = os.path.join(SOURCE, "Testing", "Data", "frozen_1.0")

# An X server that does not start anew when the first client leaves, which would shut out the next.
SCREEN = ["xvfb-run", "-a", "-s", "-screen 0 1280x1024x24 -noreset"]

PREAMBLE = """
from paraview.simple import *
LoadPlugin({plugin!r}, remote=False, ns=globals())
def points_of(source):
    source.UpdatePipeline()
    return source.GetDataInformation().GetNumberOfPoints()
def arrays_of(source):
    return sorted(array.Name for array in source.PointData)
def values_of(source, name):
    from paraview.vtk.util.numpy_support import vtk_to_numpy
    data = servermanager.Fetch(source)
    array = data.GetPoints().GetData() if name == "Points" else data.GetPointData().GetArray(name)
    return vtk_to_numpy(array)
"""


def environment(home):
    """A user who has nothing but ParaView; no looking for screens that are not there."""
    env = dict(os.environ)
    env.update(
        HOME=home,
        PYTHONPATH=os.environ["BSPC_PARAVIEW_PYTHON"],
        HWLOC_COMPONENTS="-gl",
        OMPI_MCA_rmaps_base_oversubscribe="1",
        OMPI_ALLOW_RUN_AS_ROOT="1",
        OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1",
    )
    return env


class ParaViewTest(unittest.TestCase):
    """Runs scripts in a folder of its own."""

    def setUp(self):
        self.folder = tempfile.mkdtemp(prefix="bspc-paraview-")
        self.addCleanup(shutil.rmtree, self.folder)

    def path(self, name):
        return os.path.join(self.folder, name)

    def batch(self, script, *, ranks=1, screen=False, succeeds=True):
        """What pvbatch prints for a script; PREAMBLE is in front of it."""
        name = self.path("script.py")
        with open(name, "w", encoding="utf8") as file:
            file.write(PREAMBLE.format(plugin=PLUGIN) + script)
        command = ["pvbatch", *(["--symmetric"] if ranks > 1 else []), name]
        printed = self.path("printed")
        if ranks > 1:
            command = ["mpirun", "-np", str(ranks), "--output-filename", printed, *command]
        if screen:
            command = SCREEN + command
        done = subprocess.run(
            command, cwd=self.folder, env=environment(self.folder), timeout=300, check=False,
            capture_output=True, text=True, errors="replace",
        )
        if succeeds:
            self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        if ranks > 1:
            return self.text_of_ranks(printed)
        return done.stdout + done.stderr

    def text_of_ranks(self, folder):
        """What the processes print, one after another: in what mpirun passes on, lines of one
        process stand in the middle of another's."""
        texts = []
        for path in sorted(glob.glob(os.path.join(folder, "*", "rank.*", "std*"))):
            with open(path, encoding="utf8", errors="replace") as file:
                texts.append(file.read())
        shutil.rmtree(folder)
        return "\n".join(texts)

    def told(self, output, word):
        """What follows a word at the beginning of a line, line by line."""
        return [line[len(word) :].strip() for line in output.splitlines() if line.startswith(word)]
