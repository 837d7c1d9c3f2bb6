"""The window: File > Open and File > Save Data, driven by ParaView's own test player."""

import os
import subprocess
import unittest

from paraview_support import GOLDEN, PLUGIN, SCREEN, ParaViewTest, environment

OPEN_AND_SAVE = """<?xml version="1.0" ?>
<pqevents>
  <pqevent object="pqClientMainWindow/menubar/menu_File" command="activate" arguments="actionFileOpen"/>
  <pqevent object="pqClientMainWindow/FileOpenDialog" command="filesSelected" arguments="{opened}"/>
  <pqevent object="pqClientMainWindow/propertiesDock/propertiesPanel/Accept" command="activate" arguments=""/>
  <pqevent object="pqClientMainWindow/menubar/menu_File" command="activate" arguments="actionFileSaveData"/>
  <pqevent object="pqClientMainWindow/FileSaveDialog" command="filesSelected" arguments="{saved}"/>
  <pqevent object="pqClientMainWindow/WriterSettingsDialog/widget/OKButton" command="activate" arguments=""/>
</pqevents>
"""


class Window(ParaViewTest):
    def test_open_and_save_through_the_menus(self):
        script = self.path("test.xml")
        saved = self.path("saved.bspc")
        with open(script, "w", encoding="utf8") as file:
            file.write(
                OPEN_AND_SAVE.format(
                    opened=os.path.join(GOLDEN, "fast_terrain.bspc"), saved=saved
                )
            )
        env = environment(self.folder)
        # As a user who has put the plugin where ParaView looks for plugins.
        env["PV_PLUGIN_PATH"] = os.path.dirname(PLUGIN)
        done = subprocess.run(
            SCREEN + ["paraview", "-dr", f"--test-script={script}", "--exit"],
            cwd=self.folder, env=env, timeout=300, check=False, capture_output=True, text=True,
            errors="replace",
        )
        out = done.stdout + done.stderr
        self.assertEqual(done.returncode, 0, out)
        self.assertTrue(os.path.exists(saved), out)
        told = self.batch("print('points', points_of(OpenDataFile('saved.bspc')))")
        self.assertEqual(self.told(told, "points"), ["1600"])


if __name__ == "__main__":
    unittest.main()
