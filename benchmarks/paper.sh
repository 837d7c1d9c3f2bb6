#!/usr/bin/env bash
# The paper's Tables 2 and 3, rates, curves and figures, one command each.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: benchmarks/paper.sh table2 [MODEL...]
       benchmarks/paper.sh table3 [MODEL...]
       benchmarks/paper.sh rate [MODEL [bsp|kd]]
       benchmarks/paper.sh distortion [MODEL]
       benchmarks/paper.sh figures [MODEL [FOLDER]]
       benchmarks/paper.sh pictures [FOLDER]

Installs what is missing, builds, fetches the models of Debian's package libcgal-demo (once) where
no MODEL is named, and prints

  table2      bits per point and times of the four partitions, and of the method predictive, by the
              number of points of the models
  table3      bits per point of the four partitions of the paper's Table 3, beside what it prints
  rate        bits per point and error of every level
  distortion  rate against error where cells with few points stay undivided
  figures     nothing, but writes points coloured by cell (PLY) into FOLDER (build/figures), as the
              paper's Figures 1, 2, 6 and 7 show them
  pictures    nothing, but renders such figures of the bunny, triceratops and armadillo (PNG) into
              FOLDER (docs/paper), with VTK

MODEL is a PLY, OBJ, OFF, XYZ or CSV file; it is put on a grid of 12 bits unless it is on one.
END
}

case ${1:-} in
  table2 | table3 | rate | distortion | figures | pictures) what=$1 ;;
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
[[ $# -gt 0 && $what != pictures ]] || scripts/models.sh >&2
arguments=()
case $what in
  table2)
    if (($# == 0)); then
      # Only formats of which there is a reader, and each content once: the file of the least name.
      while read -r _ name; do arguments+=("$name"); done < <(
        find build/demo/data/meshes build/demo/data/points_3 -name '*.off' -o -name '*.ply' \
          -o -name '*.xyz' | sort | xargs -d '\n' md5sum | awk '!seen[$1]++'
      )
    fi
    for model in "$@"; do arguments+=("$(absolute "$model")"); done
    ;;
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
  pictures)
    folder=docs/paper
    (($# == 0)) || folder=$(absolute "$1")
    scripts/setup.sh --vtk --plots >&2
    for name in bunny00 triceratops armadillo; do
      mkdir -p "build/figures/$name"
      build/release/bin/paper figures "$models/$name.off" "build/figures/$name"
    done
    mkdir -p "$folder"
    exec xvfb-run --auto-servernum --server-args="-screen 0 1280x1024x24" \
      /usr/bin/python3 benchmarks/paper_pictures.py build/figures "$folder"
    ;;
esac
build/release/bin/paper "$what" "${arguments[@]}"
