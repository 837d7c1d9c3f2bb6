"""The Debian package: what it installs runs from where it is, and other projects find it.

Needs BSPC_BUILD, a finished build, and CMAKE in the environment.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import unittest

BUILD = pathlib.Path(os.environ["BSPC_BUILD"])
CMAKE = os.environ["CMAKE"]
SOURCE = pathlib.Path(__file__).resolve().parents[2]


def run(*command, **options):
    """Runs a command, shows what it said if it fails, and returns its standard output."""
    done = subprocess.run(
        [str(part) for part in command], capture_output=True, text=True, check=False, **options
    )
    if done.returncode != 0:
        raise AssertionError(f"{command} failed:\n{done.stdout}\n{done.stderr}")
    return done.stdout


class Package(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        cls.work = pathlib.Path(cls.folder.name)
        cpack = pathlib.Path(CMAKE).with_name("cpack")
        run(cpack, "--config", BUILD / "CPackConfig.cmake", "-B", cls.work, cwd=BUILD)
        (cls.package,) = cls.work.glob("*.deb")
        run("dpkg", "-x", cls.package, cls.work / "root")
        cls.prefix = cls.work / "root" / "usr"
        (python,) = cls.prefix.glob("lib/python3*/dist-packages")
        cls.environment = {**os.environ, "PYTHONPATH": str(python), "PYTHONDONTWRITEBYTECODE": "1"}

    @classmethod
    def tearDownClass(cls):
        cls.folder.cleanup()

    def test_it_names_what_it_needs(self):
        depends = run("dpkg-deb", "--field", self.package, "Depends")
        for package in ("libvtk9.1", "libc6", "python3-vtk9", "python3-numpy"):
            self.assertIn(package, depends)
        suggests = run("dpkg-deb", "--field", self.package, "Suggests")
        for package in ("libzstd-dev", "libvtk9-dev"):  # to build on it
            self.assertIn(package, suggests)

    def test_the_command_runs(self):
        model = SOURCE / "Testing" / "Data" / "terrain_lines.ply"
        file = self.work / "terrain.bspc"
        run(self.prefix / "bin" / "bspc", "encode", model, file)
        run(self.prefix / "bin" / "bspc", "verify", file, "--against", model)

    def test_the_python_package_is_imported_from_there(self):
        where = run(sys.executable, "-c", "import bspc; print(bspc.__file__)", env=self.environment)
        self.assertTrue(where.startswith(str(self.prefix)), where)

    def test_the_example_for_numpy_runs(self):
        example = SOURCE / "docs" / "examples" / "numpy_round_trip.py"
        said = run(sys.executable, example, self.work / "numpy.bspc", env=self.environment)
        self.assertIn("100000 points in", said)
        self.assertIn("every tenth of 100000: 10000", said)

    def test_another_project_finds_the_vtk_modules(self):
        build = self.work / "example"
        run(
            CMAKE, "-G", "Ninja", "-S", SOURCE / "docs" / "examples" / "vtk", "-B", build,
            f"-DCMAKE_PREFIX_PATH={self.prefix}", "-DCMAKE_BUILD_TYPE=Release",
        )  # fmt: skip
        run(CMAKE, "--build", build)
        said = run(build / "vtk_round_trip", self.work / "vtk.bspc")
        self.assertIn("100000 points in", said)
        self.assertIn("of 100000 points are in the box", said)

    def test_another_project_finds_the_library_alone(self):
        project = self.work / "alone"
        project.mkdir()
        example = SOURCE / "docs" / "examples" / "round_trip.cpp"
        (project / "CMakeLists.txt").write_text(
            "cmake_minimum_required(VERSION 3.25)\n"
            "project(alone LANGUAGES CXX)\n"
            "find_package(BSPC 0.1 REQUIRED COMPONENTS library)\n"
            f'add_executable(alone "{example}")\n'
            "target_link_libraries(alone PRIVATE BSPC::bspc)\n"
        )
        build = project / "build"
        run(CMAKE, "-G", "Ninja", "-S", project, "-B", build, f"-DCMAKE_PREFIX_PATH={self.prefix}")
        run(CMAKE, "--build", build)
        said = run(build / "alone", self.work / "alone.bspc")
        self.assertIn("1000 points came back", said)
        self.assertNotIn("VTK_DIR", (build / "CMakeCache.txt").read_text())


if __name__ == "__main__":
    unittest.main()
