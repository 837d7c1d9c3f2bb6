#!/usr/bin/python3
"""Sizes, speeds and memory of .bspc beside other codecs, in one run: a table and plots."""

import argparse
import os
import pathlib
import subprocess
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent
sys.path.insert(0, str(HERE))
sys.dont_write_bytecode = True

import comparison_report  # noqa: E402  (found by the path above)
from comparison import Comparison, PointSets, external_codec, tmc3_codecs  # noqa: E402

BUILD = ROOT / "build" / "compare"

DESCRIPTION = """\
Measures .bspc at its nine efforts against Draco (kd-tree and sequential, every speed), VTK's .vtp
with its compressors, and zstd and xz on the sorted points; and against codecs of yours. Every codec
gets the same whole numbers, and every file is decoded and compared. Installs what is missing, builds,
and writes into the folder of --output: results.tsv, report.md and, with Matplotlib, plots.

What is measured: FILEs; or --generated, --models and --scaling; all three if nothing is named.
"""

EPILOG = """\
--codec takes a name and two commands of the shell. In them {in.EXT} is the model that is to be
encoded, in the format of that ending; {out} or {out.EXT} the file that the first command writes and
the second one reads; {back.EXT} the model that the second one writes. Formats: ply, obj, off, xyz,
csv, las, pcd. Their times hold the start of the programs, and reading and writing files. Example:

  benchmarks/compare.py scan.ply --codec draco_encoder \\
    'draco_encoder -point_cloud -qp 0 -i {in.ply} -o {out.drc}' \\
    'draco_decoder -i {out.drc} -o {back.ply}'
"""


def parse_arguments():
    parser = argparse.ArgumentParser(
        prog="benchmarks/compare.py", description=DESCRIPTION, epilog=EPILOG,
        formatter_class=argparse.RawDescriptionHelpFormatter,
    )
    parser.add_argument("files", nargs="*", metavar="FILE", help="models (PLY, LAS, XYZ ...)")
    parser.add_argument("--generated", action="store_true",
                        help="a set of each kind: surface scan, scan lines, depth, CAD, random")
    parser.add_argument("--points", type=int, default=250_000, metavar="N",
                        help="points of each of them (default 250000)")
    parser.add_argument("--models", action="store_true",
                        help="the models of Debian's package libcgal-demo")
    parser.add_argument("--least", type=int, default=1000, metavar="N",
                        help="... those of N points or more (default 1000)")
    parser.add_argument("--scaling", action="store_true",
                        help="surface scans and scan lines of 1,000 points and ten times as many")
    parser.add_argument("--scale-to", type=int, default=100_000_000, metavar="N",
                        help="... up to this number (default 10^8)")
    parser.add_argument("--bits", type=int, default=12, metavar="B",
                        help="grid of models that lie on none (default 12 bits)")
    parser.add_argument("--codecs", default="", metavar="REGEX",
                        help="only codecs in whose name this is found")
    parser.add_argument("--codec", nargs=3, action="append", default=[],
                        metavar=("NAME", "ENCODE", "DECODE"), help="another codec; see below")
    parser.add_argument("--tmc3", metavar="PATH",
                        help="MPEG's reference software of G-PCC, as octree and predictive tree")
    parser.add_argument("--rounds", type=int, default=3, metavar="N",
                        help="rounds in which the codecs take turns (default 3)")
    parser.add_argument("--seconds", type=float, default=0.1, metavar="S",
                        help="a codec repeats quick work for so long each time (default 0.1)")
    parser.add_argument("--limit", type=float, default=60, metavar="S",
                        help="a codec that needs longer once is out, for larger sets too "
                             "(default 60)")
    parser.add_argument("--output", default=str(BUILD / "results"), metavar="FOLDER",
                        help="default: build/compare/results")
    arguments = parser.parse_args()
    if not (arguments.files or arguments.generated or arguments.models or arguments.scaling):
        arguments.generated = arguments.models = arguments.scaling = True
    if arguments.rounds < 1 or arguments.points < 1 or arguments.scale_to < 1000:
        parser.error("--rounds and --points must be at least 1, --scale-to 1000")
    return arguments


def build():
    subprocess.run([ROOT / "scripts/setup.sh", "--vtk", "--peers", "--plots"], check=True,
                   stdout=sys.stderr)
    BUILD.mkdir(parents=True, exist_ok=True)
    commands = (
        ["cmake", "--preset", "release", "-B", str(BUILD), "-DBSPC_BUILD_VTK=ON",
         "-DBSPC_BUILD_PEER_BENCHMARKS=ON"],
        ["cmake", "--build", str(BUILD), "-j", str(os.cpu_count()), "--target", "compare_codec"],
    )
    for command in commands:
        done = subprocess.run(command, cwd=ROOT, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                              check=False)
        if done.returncode != 0:
            sys.stderr.buffer.write(done.stdout)
            sys.exit("compare: the build failed")
    return BUILD / "bin" / "compare_codec"


def main():
    arguments = parse_arguments()
    program = build()
    output = pathlib.Path(arguments.output)
    output.mkdir(parents=True, exist_ok=True)
    codecs = [external_codec(*words) for words in arguments.codec]
    if arguments.tmc3:
        codecs += tmc3_codecs(arguments.tmc3)
    with tempfile.TemporaryDirectory(prefix="compare-") as scratch:
        sets = PointSets(program, pathlib.Path(scratch), arguments.bits, arguments.least)
        comparison = Comparison(program, pathlib.Path(scratch), arguments, codecs)
        with open(output / "results.tsv", "w", encoding="utf-8") as table:
            comparison.write_to(table)
            for name in arguments.files:
                comparison.measure(sets.from_file("files", name))
            if arguments.generated:
                for kind in sets.kinds():
                    comparison.measure(sets.generated(kind, arguments.points))
            if arguments.models:
                subprocess.run([ROOT / "scripts/models.sh"], check=True, stdout=sys.stderr)
                for name in sets.models(ROOT / "build/demo/data"):
                    comparison.measure(sets.from_file("models", name))
            if arguments.scaling:
                for kind in ("surface", "lines"):
                    comparison.scale(sets, kind, arguments.scale_to)
    subprocess.run(["/usr/bin/python3", HERE / "plot_comparison.py", output / "results.tsv", output],
                   check=True)
    comparison_report.write(output, sys.argv[1:], arguments)
    print("compare: %s: results.tsv, report.md and plots" % output, file=sys.stderr)
    return 1 if comparison.failures else 0


if __name__ == "__main__":
    sys.exit(main())
