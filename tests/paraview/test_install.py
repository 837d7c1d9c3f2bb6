"""What is installed is found: by ParaView through its search path, by a file manager by type."""

import glob
import os
import re
import subprocess
import unittest

from paraview_support import GOLDEN, ParaViewTest, environment


class Install(ParaViewTest):
    def test_installed_plugin_opens_files_that_the_desktop_hands_over(self):
        prefix = self.path("installed")
        subprocess.run(
            ["cmake", "--install", os.environ["BSPC_BUILD"], "--component", "plugin",
             "--prefix", prefix],
            check=True, capture_output=True,
        )
        installed = [
            os.path.relpath(os.path.join(folder, name), prefix)
            for folder, _, names in os.walk(prefix) for name in names
        ]
        # The plugin alone: neither headers nor archives of what it was made of.
        self.assertEqual([name for name in installed if name.endswith((".a", ".h"))], [])
        with open(os.path.join(prefix, "share/applications/bspc-paraview.desktop")) as file:
            entry = file.read()
        folder = re.search(r"^Exec=env PV_PLUGIN_PATH=(\S+) paraview --data=%f$", entry, re.M)[1]
        self.assertTrue(os.path.exists(os.path.join(folder, "BSPCPlugin.so")), installed)
        kind = re.search(r"^MimeType=(.*);$", entry, re.M)[1]
        with open(os.path.join(prefix, "share/mime/packages/bspc.xml")) as file:
            self.assertIn(f'type="{kind}"', file.read())

        script = self.path("script.py")
        with open(script, "w", encoding="utf8") as file:
            file.write(
                f"""
from paraview.simple import *
reader = OpenDataFile({glob.glob(os.path.join(GOLDEN, "*.bspc"))[0]!r})
reader.UpdatePipeline()
print('points', reader.GetDataInformation().GetNumberOfPoints() > 0)
"""
            )
        env = environment(self.folder)
        env["PV_PLUGIN_PATH"] = folder
        done = subprocess.run(
            ["pvbatch", script], cwd=self.folder, env=env, timeout=300, check=False,
            capture_output=True, text=True, errors="replace",
        )
        self.assertEqual(self.told(done.stdout, "points"), ["True"], done.stdout + done.stderr)


if __name__ == "__main__":
    unittest.main()
