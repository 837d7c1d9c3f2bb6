#!/usr/bin/env bash
# Whole meshes beside Draco's, on the models of scripts/models.sh: a table of both parts.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

options=()
if [[ ${1-} == --positions-first ]]; then
  options+=("$1")
  shift
fi
if (($# > 0)); then
  cat <<'END'
Usage: benchmarks/meshes.sh [--positions-first]

Builds draco_mesh_benchmark and runs it on the meshes of Debian's package libcgal-demo (24 MB, fetched
once) that have at least 1,000 triangles: bytes of positions and faces, bspc's and Draco's, at 12 bits.
An asterisk says that bspc coded positions along the faces, which then stand among the rest; with
--positions-first it never does.
END
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

scripts/setup.sh --peers
scripts/models.sh
{
  cmake --preset release -DBSPC_BUILD_PEER_BENCHMARKS=ON
  cmake --build --preset release -j "$(nproc)" --target draco_mesh_benchmark
} >&2
models=()
for model in build/demo/data/meshes/*.off; do
  # The counts stand behind the keyword, on its line or the next that is no comment.
  faces=$(awk '{ sub(/#.*/, ""); sub(/^[A-Z]*OFF/, "") } /[0-9]/ { print $2; exit }' "$model")
  ((faces < 1000)) || models+=("$model")
done
build/release/bin/draco_mesh_benchmark "${options[@]}" "${models[@]}"
