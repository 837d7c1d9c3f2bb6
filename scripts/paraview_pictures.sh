#!/usr/bin/env bash
# Renders the pictures of docs/paraview.md anew.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  echo "Usage: scripts/paraview_pictures.sh"
  echo "Builds the ParaView plugin and renders docs/paraview/*.png with it."
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

scripts/setup.sh --paraview
cmake --preset paraview
cmake --build --preset paraview -j "$(nproc)"
plugin=$PWD/build/paraview/lib/x86_64-linux-gnu/paraview-5.11/plugins/BSPCPlugin/BSPCPlugin.so
export PYTHONPATH=$PWD/build/paraview-python/usr/lib/python3/dist-packages HWLOC_COMPONENTS=-gl
xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
  pvbatch docs/paraview/pictures.py "$plugin" "$PWD/Testing/Data/superquadric_scan.ply" \
  "$PWD/docs/paraview"
