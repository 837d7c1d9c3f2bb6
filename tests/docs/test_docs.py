"""What README.md and docs/ say: links, examples, names and options, sizes of pictures.

The environment variable BSPC names the command.
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
DOCS = ROOT / "docs"
PAGES = sorted(DOCS.glob("*.md")) + [ROOT / "README.md", ROOT / "CONTRIBUTING.md"]
sys.path.insert(0, str(ROOT / "tests" / "cli"))
from command_support import BSPC, write_las, write_ply  # noqa: E402  (found by the path above)

COMMANDS = ("encode", "decode", "info", "verify", "join", "bench")


def text_of(path):
    return path.read_text(encoding="utf-8")


def blocks_of(path, language):
    """The code blocks of a page that are marked with that language."""
    return re.findall(r"^```%s\n(.*?)^```" % language, text_of(path), re.MULTILINE | re.DOTALL)


def anchors_of(path):
    """What the headings of a page are called in links."""
    headings = re.findall(r"^#+ (.+)$", text_of(path), re.MULTILINE)
    return {re.sub(r"[^\w\- ]", "", heading.lower()).replace(" ", "-") for heading in headings}


class Links(unittest.TestCase):
    def test_lead_somewhere(self):
        for page in PAGES:
            for target in re.findall(r"\]\(([^)\s]+)\)", text_of(page)):
                if re.match(r"https?:|mailto:", target):
                    continue
                name, _, anchor = target.partition("#")
                path = (page.parent / name) if name else page
                with self.subTest(page=page.name, target=target):
                    self.assertTrue(path.exists())
                    if anchor:
                        self.assertIn(anchor, anchors_of(path))

    def test_every_page_is_in_the_table_of_contents(self):
        contents = text_of(DOCS / "README.md")
        for page in PAGES:
            if page != DOCS / "README.md":
                with self.subTest(page.name):
                    self.assertIn("(%s)" % os.path.relpath(page, DOCS), contents)


class Pictures(unittest.TestCase):
    def test_are_small(self):
        sizes = [path.stat().st_size for kind in ("png", "svg") for path in DOCS.rglob("*." + kind)]
        self.assertGreater(len(sizes), 0)
        self.assertLess(max(sizes), 300_000)
        self.assertLess(sum(sizes), 1_500_000)


class Names(unittest.TestCase):
    def check(self, page, names):
        self.assertGreater(len(names), 0)
        text = re.sub(r"^```.*?^```", "", text_of(page), flags=re.MULTILINE | re.DOTALL)
        told = set(re.findall(r"\w+", " ".join(re.findall(r"`([^`]+)`", text))))
        self.assertEqual(sorted(set(names) - told), [], page.name)

    def test_every_option_of_the_command_is_told(self):
        guide = text_of(DOCS / "guide.md")
        for command in COMMANDS:
            section = guide[guide.index("\n### %s\n" % command):].split("\n### ")[1]
            done = subprocess.run([BSPC, command, "--help"], stdout=subprocess.PIPE, check=True,
                                  encoding="utf-8")
            options = set(re.findall(r"^  (?:-\w,)?(--[a-z-]+)", done.stdout, re.MULTILINE))
            told = set(re.findall(r"^\| `(?:-\w, )?(--[a-z-]+)", section, re.MULTILINE))
            self.assertEqual(options - {"--help"}, told, command)

    def test_every_public_name_of_the_library_is_told(self):
        names = []
        for header in (ROOT / "bspc/include/bspc").glob("*.h"):
            text = text_of(header)
            names += re.findall(r"^(?:class|struct|enum class|using) (\w+)[^;\n]*[{=]", text,
                                re.MULTILINE)
            names += re.findall(r"^(?!using|class|struct|enum)[A-Za-z][\w:<>, ]*[ &*](\w+)\(", text,
                                re.MULTILINE)
        self.check(DOCS / "library.md", names)

    def test_every_property_of_reader_and_writer_is_told(self):
        names = []
        for module in ("vtkBSPReader", "vtkBSPWriter"):
            text = text_of(ROOT / module / (module + ".h"))
            text = text[text.index("public:"):text.index("protected:")]
            names += re.findall(r"vtk(?:Set|Get)\w*Macro\((\w+)", text)
            names += [name for name in re.findall(r"\b(?:Set|Get)(\w+)\([^)]*\)[^:]*?[;{]", text)
                      if not re.search(r"To[A-Z]\w+$|^MTime$", name)]
            names += re.findall(r"\b(Can\w+|Clear\w+)\(", text)
        self.check(DOCS / "vtk.md", [name for name in names if name != "FileName"])

    def test_every_parameter_of_the_python_functions_is_told(self):
        reading = text_of(ROOT / "python/bspc/reading.py")
        signature = re.search(r"^def read\((.*?)\) ->", reading, re.MULTILINE | re.DOTALL).group(1)
        names = re.findall(r"^    (\w+): ", signature, re.MULTILINE)
        writing = text_of(ROOT / "python/bspc/writing.py")
        signature = re.search(r"^def _writer\((.*?)\) ->", writing, re.MULTILINE | re.DOTALL)
        names += re.findall(r"^    (\w+): ", signature.group(1), re.MULTILINE)
        self.check(DOCS / "vtk.md", set(names) - {"source", "points", "arrays"})

    def test_every_name_for_openmesh_is_told(self):
        text = text_of(ROOT / "openmesh_io/include/bspc/openmesh_io.h")
        text = text[:text.index("namespace detail")]
        names = re.findall(r"^struct (\w+)", text, re.MULTILINE)
        names += re.findall(r"^(?:BSPC_OPENMESH_API )?[\w&:]+ (\w+)\(", text, re.MULTILINE)
        self.check(DOCS / "openmesh.md", names)


class Examples(unittest.TestCase):
    def test_are_parts_of_the_programs_that_run(self):
        programs = [path for path in (DOCS / "examples").rglob("*") if path.is_file()]
        lines = {" ".join(line.split()) for path in programs for line in text_of(path).splitlines()}
        count = 0
        # What paraview.md shows runs in ParaView alone: tests/paraview does the like.
        for page in (page for page in PAGES if page.name != "paraview.md"):
            for language in ("cpp", "python", "cmake"):
                for block in blocks_of(page, language):
                    for line in block.splitlines():
                        code = " ".join(re.sub(r"(//|  #).*$", "", line).split())
                        with self.subTest(page=page.name, line=line):
                            self.assertTrue(any(code in known for known in lines))
                        count += 1
        self.assertGreater(count, 0)


class Console(unittest.TestCase):
    """Commands behind "$ " and what they print, in one folder for a page."""

    def prepare(self, folder):
        for model in (ROOT / "Testing/Data").glob("*.ply"):
            shutil.copy(model, folder)
        points = [(i % 20, i // 20, i % 7) for i in range(400)]
        write_ply(folder + "/scan.ply", points)
        write_ply(folder + "/west.ply", points)
        write_ply(folder + "/east.ply", [(x + 20, y, z) for x, y, z in points])
        write_las(folder + "/tile.las", points, (0.01,) * 3, (0.0,) * 3, point_format=2)

    def run_line(self, folder, line):
        """The command's output as one text; files that it is to write may be there already."""
        environment = dict(os.environ, PATH=os.path.dirname(BSPC) + ":" + os.environ["PATH"])
        if re.match(r"bspc (encode|decode|join) ", line):
            line += " --force"
        done = subprocess.run(["bash", "-o", "pipefail", "-c", line], cwd=folder, env=environment,
                              stdin=subprocess.DEVNULL, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT, timeout=120, check=False)
        return done.returncode, done.stdout.decode("utf-8").strip()

    def compare(self, shown, printed):
        """The same words, and about the same numbers: an encoder may become a little better."""
        number = r"\d[\d,]*(?:\.\d+)?"
        self.assertEqual(re.sub(number, "N", shown), re.sub(number, "N", printed))
        for a, b in zip(re.findall(number, shown), re.findall(number, printed)):
            a, b = float(a.replace(",", "")), float(b.replace(",", ""))
            self.assertLessEqual(abs(a - b), 0.03 * max(abs(a), abs(b)), (shown, printed))

    def test_does_what_is_shown(self):
        count = 0
        for page in PAGES:
            with tempfile.TemporaryDirectory() as folder:
                self.prepare(folder)
                for block in blocks_of(page, "console"):
                    for example in re.split(r"^\$ ", block, flags=re.MULTILINE)[1:]:
                        line, _, shown = example.partition("\n")
                        code, printed = self.run_line(folder, line)
                        with self.subTest(page=page.name, line=line):
                            # An example of an error shows it.
                            self.assertEqual(code, 1 if shown.startswith("bspc: ") else 0, printed)
                            if shown.strip():
                                self.compare(shown.strip(), printed)
                        count += 1
        self.assertGreater(count, 10)


if __name__ == "__main__":
    unittest.main()
