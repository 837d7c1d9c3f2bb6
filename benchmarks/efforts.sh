#!/usr/bin/env bash
# What the efforts cost and give, as a table and a plot, and what each idea of method predictive is
# worth.
set -euo pipefail
here=$PWD
cd "$(dirname "${BASH_SOURCE[0]}")/.."

usage() {
  cat <<'END'
Usage: benchmarks/efforts.sh table [--repeat N] [--output FOLDER] MODEL.ply...
       benchmarks/efforts.sh ablation [--effort 5..9] [--output FOLDER] MODEL.ply...

Installs what is missing, builds, and writes into FOLDER (build/efforts) and prints

  table     bits per point, and microseconds of processor time a point to encode and to decode, of
            every effort (efforts.tsv); every file is decoded and compared. Plots bits against decode
            time (efforts.svg)
  ablation  bits per point without each feature of an effort of method predictive (ablation.tsv)

A MODEL's points must lie on a lattice, as quantised models and most scans do.
END
}

case ${1:-} in
  table | ablation) what=$1 ;;
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

folder=build/efforts
options=()
models=()
while (($# > 0)); do
  case $1 in
    --output)
      folder=$(absolute "${2:?--output needs a folder}")
      shift
      ;;
    --repeat | --effort)
      options=("$1" "${2:?$1 needs a number}")
      shift
      ;;
    *) models+=("$(absolute "$1")") ;;
  esac
  shift
done
if ((${#models[@]} == 0)); then
  usage >&2
  exit 2
fi

scripts/setup.sh --plots >&2
mkdir -p build "$folder"
{
  cmake --preset release && cmake --build --preset release -j "$(nproc)" --target efforts_benchmark
} >build/efforts.log 2>&1 || {
  cat build/efforts.log >&2
  echo "efforts: the build failed" >&2
  exit 1
}
if [[ $what == ablation ]]; then
  build/release/bin/efforts_benchmark ablation "${options[@]}" "${models[@]}" |
    tee "$folder/ablation.tsv"
else
  build/release/bin/efforts_benchmark table "${options[@]}" "${models[@]}" |
    tee "$folder/efforts.tsv"
  /usr/bin/python3 benchmarks/plot_efforts.py "$folder/efforts.tsv" "$folder/efforts.svg"
fi
