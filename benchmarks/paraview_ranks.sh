#!/usr/bin/env bash
# What each process of a parallel ParaView reads of one file: points, and bytes from disk.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  cat <<'MESSAGE'
Usage: benchmarks/paraview_ranks.sh

Builds the ParaView plugin and generate_scan, codes a scan of 10 million points and reads it whole in
1, 2 and 4 processes of pvbatch: a line for each process, its points and the bytes that it has read.
MESSAGE
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

scripts/setup.sh --paraview >&2
for preset in paraview release; do
  cmake --preset "$preset"
  cmake --build --preset "$preset" -j "$(nproc)"
done >&2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
build/release/bin/generate_scan 10000000 >"$folder/scan.ply"
build/release/bin/bspc encode --quiet "$folder/scan.ply" "$folder/scan.bspc"
rm "$folder/scan.ply"

cat >"$folder/read.py" <<'END_OF_SCRIPT'
import sys
from paraview.simple import *
from paraview.modules.vtkRemotingCore import vtkProcessModule

plugin, folder = sys.argv[1:3]
LoadPlugin(plugin, remote=False, ns=globals())


def bytes_read():
    with open("/proc/self/io") as file:
        return int(next(line for line in file if line.startswith("rchar")).split()[1])


reader = OpenDataFile(folder + "/scan.bspc")
reader.LimitPoints = 0
before = bytes_read()
reader.UpdatePipeline()
read = bytes_read() - before
points = reader.SMProxy.GetClientSideObject().GetOutputDataObject(0).GetNumberOfPoints()
rank = vtkProcessModule.GetProcessModule().GetPartitionId()
# A file each: mpirun mixes what the processes print.
with open(f"{folder}/rank{rank}", "w") as file:
    print(f"rank {rank}: {points:>10,} points {read:>12,} bytes", file=file)
END_OF_SCRIPT

plugin=$PWD/build/paraview/lib/x86_64-linux-gnu/paraview-5.11/plugins/BSPCPlugin/BSPCPlugin.so
export PYTHONPATH=$PWD/build/paraview-python/usr/lib/python3/dist-packages HWLOC_COMPONENTS=-gl
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 OMPI_MCA_rmaps_base_oversubscribe=1
echo "file: $(stat -c %s "$folder/scan.bspc") bytes"
for ranks in 1 2 4; do
  echo "processes: $ranks"
  mpirun -np "$ranks" pvbatch --symmetric "$folder/read.py" "$plugin" "$folder" >&2
  cat "$folder"/rank*
  rm "$folder"/rank*
done
