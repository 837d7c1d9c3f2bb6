"""Several processes: each reads its own tiles, and all of them write one file."""

import os
import signal
import subprocess
import sys
import unittest

from paraview_support import PLUGIN, SCREEN, ParaViewTest, environment
from test_batch import CLOUD

LOCAL = """
from paraview.modules.vtkRemotingCore import vtkProcessModule
module = vtkProcessModule.GetProcessModule()
rank = module.GetPartitionId()
def local_points(source):
    source.UpdatePipeline()
    return source.SMProxy.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
"""


class Parallel(ParaViewTest):
    def setUp(self):
        super().setUp()
        self.batch(
            CLOUD
            + """
SaveData('cloud.bspc', proxy=cloud, Effort=2, NumberOfLevels=3)
"""
        )

    def test_processes_share_a_file_and_write_one_together(self):
        out = self.batch(
            LOCAL
            + """
sphere = Sphere(ThetaResolution=400, PhiResolution=200)
redistributed = RedistributeDataSet(Input=sphere)
local = local_points(redistributed)
print('local', rank, local, flush=True)
SaveData('together.bspc', proxy=redistributed, DropCells=1)
again = OpenDataFile('together.bspc')
print('again', rank, local_points(again), flush=True)
cloud = OpenDataFile('cloud.bspc')
cloud.LimitPoints = 0
print('shared', rank, local_points(cloud), flush=True)
""",
            ranks=2,
        )
        again = [int(line.split()[1]) for line in self.told(out, "again")]
        self.assertEqual(len(again), 2, out)
        self.assertTrue(all(count > 0 for count in again), again)
        local = [int(line.split()[1]) for line in self.told(out, "local")]
        self.assertEqual(sorted(local), sorted(again))
        shared = [int(line.split()[1]) for line in self.told(out, "shared")]
        self.assertEqual(sum(shared), 20000)
        # One process reads the same file, whole.
        alone = self.batch("print('alone', points_of(OpenDataFile('together.bspc')))")
        self.assertEqual(int(self.told(alone, "alone")[0]), sum(again))

    def test_a_file_for_each_process(self):
        self.batch(
            """
redistributed = RedistributeDataSet(Input=Sphere(ThetaResolution=100, PhiResolution=50))
redistributed.UpdatePipeline()
SaveData('each.bspc', proxy=redistributed, DropCells=1, FilePerProcess=1)
""",
            ranks=2,
        )
        for rank in range(2):
            self.assertTrue(os.path.exists(self.path(f"each.{rank}.bspc")))

    def test_what_one_process_cannot_write_fails_for_all(self):
        out = self.batch(
            """
redistributed = RedistributeDataSet(Input=Sphere(ThetaResolution=100, PhiResolution=50))
redistributed.UpdatePipeline()
try:
    SaveData('nowhere/each.bspc', proxy=redistributed, DropCells=1)
except RuntimeError:
    pass
print('alive', flush=True)
""",
            ranks=2,
        )
        self.assertIn("cannot be created", out)
        self.assertEqual(len(self.told(out, "alive")), 2)

    def test_a_client_of_a_server_with_two_processes(self):
        port = 21000 + os.getpid() % 20000
        server = subprocess.Popen(
            SCREEN + ["mpirun", "-np", "2", "pvserver", f"--server-port={port}",
                      "--force-offscreen-rendering"],
            cwd=self.folder, env=environment(self.folder), stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT, text=True, errors="replace", start_new_session=True,
        )
        try:
            for line in server.stdout:
                if "Waiting for client" in line or "Accepting connection" in line:
                    break
            script = self.path("client.py")
            with open(script, "w", encoding="utf8") as file:
                file.write(
                    f"""
from paraview.simple import *
Connect('localhost', {port})
LoadPlugin({PLUGIN!r}, remote=True, ns=globals())
LoadPlugin({PLUGIN!r}, remote=False, ns=globals())
reader = OpenDataFile({self.path("cloud.bspc")!r})
reader.UpdatePipeline()
print('points', reader.GetDataInformation().GetNumberOfPoints(), flush=True)
SaveData({self.path("served.bspc")!r}, proxy=reader)
served = OpenDataFile({self.path("served.bspc")!r})
served.UpdatePipeline()
print('served', served.GetDataInformation().GetNumberOfPoints(), flush=True)
"""
                )
            done = subprocess.run(
                [sys.executable, script], cwd=self.folder, env=environment(self.folder),
                timeout=200, check=False, capture_output=True, text=True, errors="replace",
            )
        finally:
            # With it the screen that xvfb-run has started.
            os.killpg(server.pid, signal.SIGTERM)
            server.wait(60)
            server.stdout.close()
        out = done.stdout + done.stderr
        self.assertEqual(self.told(out, "points"), ["20000"], out)
        self.assertEqual(self.told(out, "served"), ["20000"], out)


if __name__ == "__main__":
    unittest.main()
