#!/usr/bin/env bash
# Sizes of point arrays in .bspc beside .vtp with LZMA and Draco, and what reading costs, from scratch.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)) && [[ $1 == -h || $1 == --help ]]; then
  cat <<'END'
Usage: benchmarks/arrays.sh [FILE.vtp or FILE.bspc]

Builds bspc with the VTK modules and the comparison with Draco into build/arrays, and prints two
tables: bits a value of each array of a scan (a made one, or the file's), all values bit for bit, and
the time of reading a million points into vtkPolyData beside the library's own decoding.
END
  exit 0
fi

scripts/setup.sh --vtk --peers
mkdir -p build/arrays
echo "arrays: building"
build() {
  cmake --preset release -B build/arrays -DBSPC_BUILD_VTK=ON -DBSPC_BUILD_PYTHON=OFF \
    -DBSPC_BUILD_PEER_BENCHMARKS=ON &&
    cmake --build build/arrays -j "$(nproc)" --target array_sizes vtk_read_benchmark
}
build >build/arrays/build.log 2>&1 || {
  cat build/arrays/build.log >&2
  echo "arrays: the build failed" >&2
  exit 1
}
build/arrays/bin/array_sizes "$@"
echo
build/arrays/bin/vtk_read_benchmark
