#!/usr/bin/env bash
# The paper's Table 3, rates, curves and figures, one command each.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: benchmarks/paper.sh table3 [MODEL...]
       benchmarks/paper.sh rate [MODEL [bsp|kd]]
       benchmarks/paper.sh distortion [MODEL]
       benchmarks/paper.sh figures [MODEL [FOLDER]]

Installs what is missing, builds, fetches the models of Debian's package libcgal-demo (once) where
no MODEL is named, and prints

  table3      bits per point of the four partitions of the paper's Table 3, beside what it prints
  rate        bits per point and error of every level
  distortion  rate against error where cells with few points stay undivided
  figures     nothing, but writes points coloured by cell (PLY) into FOLDER (build/figures), as the
              paper's Figures 1, 2, 6 and 7 show them

MODEL is a PLY, OBJ, OFF, XYZ or CSV file; it is put on a grid of 12 bits unless it is on one.
END
}

case ${1:-} in
  table3 | rate | distortion | figures) what=$1 ;;
  -h | --help)
    usage
    exit 0
    ;;
  *)
    usage >&2
    exit 2
    ;;
esac
shift

# A relative name means the folder that the script was called from.
absolute() {
  [[ $1 == /* ]] && printf '%s' "$1" || printf '%s' "$here/$1"
}

scripts/setup.sh >&2
mkdir -p build
{
  cmake --preset release && cmake --build --preset release -j "$(nproc)" --target paper
} >build/paper.log 2>&1 || {
  cat build/paper.log >&2
  echo "paper: the build failed" >&2
  exit 1
}

models=build/demo/data/meshes
bunny=$models/bunny00.off
(($# > 0)) || scripts/models.sh >&2
arguments=()
case $what in
  table3)
    if (($# == 0)); then
      for name in triceratops cow fandisk blobby bull camel elephant bunny00 armadillo; do
        arguments+=("$models/$name.off")
      done
    fi
    for model in "$@"; do arguments+=("$(absolute "$model")"); done
    ;;
  rate)
    arguments=("$(if (($# > 0)); then absolute "$1"; else printf '%s' "$bunny"; fi)" "${2:-bsp}")
    ;;
  distortion)
    arguments=("$(if (($# > 0)); then absolute "$1"; else printf '%s' "$bunny"; fi)")
    ;;
  figures)
    folder=build/figures
    (($# < 2)) || folder=$(absolute "$2")
    mkdir -p "$folder"
    arguments=("$(if (($# > 0)); then absolute "$1"; else printf '%s' "$bunny"; fi)" "$folder")
    ;;
esac
build/release/bin/paper "$what" "${arguments[@]}"
