#!/usr/bin/env bash
# Installs the Debian 12 packages that building and testing bspc needs.
set -euo pipefail

build_packages=(
  cmake ninja-build g++ python3 libc6-dev
  libxxhash-dev libzstd-dev libeigen3-dev libcli11-dev liblzf-dev nlohmann-json3-dev
  libgtest-dev libbenchmark-dev
)
lint_packages=(clang-format clang-tidy ccache)
compiler_packages=(clang)
# libFuzzer, and what tells the lines of a stack.
fuzz_packages=(clang libclang-rt-dev llvm)
coverage_packages=(gcovr)
valgrind_packages=(valgrind)
peer_packages=(libdraco-dev draco)
plot_packages=(python3-matplotlib python3-pil)
# dpkg-dev finds out what a package depends on; the last three render without a screen.
vtk_packages=(libvtk9-dev python3-vtk9 python3-numpy dpkg-dev xvfb xauth libgl1-mesa-dri)
openmesh_packages=(libopenmesh-dev)

# ParaView; openmpi-bin runs it in several processes, the last ones give it a screen and icons.
paraview_packages=(
  paraview paraview-dev libvtk9.1 openmpi-bin xvfb xauth libgl1-mesa-dri libqt5svg5
)
# Cannot be installed beside python3-vtk9; what the tests need of it is unpacked into the build.
paraview_python_package=python3-paraview
paraview_python_folder=build/paraview-python

usage() {
  cat <<'END'
Usage: scripts/setup.sh [--lint] [--vtk] [--openmesh] [--paraview] [--compilers] [--fuzz]
                        [--coverage] [--valgrind] [--peers] [--plots] [--for-download PACKAGE]

Installs the Debian 12 packages that building and testing bspc needs; does nothing where they are
installed. Needs root or sudo only if something is missing.

  --lint                  also clang-format and clang-tidy, for scripts/lint.sh, and ccache, for
                          scripts/test.sh
  --vtk                   also VTK with its Python package, for the preset dev
  --openmesh              also OpenMesh, for the preset dev
  --paraview              also ParaView, for the preset paraview; unpacks ParaView's Python modules
                          into build/paraview-python
  --compilers             also clang, for scripts/compilers.sh
  --fuzz                  also clang with libFuzzer, for scripts/fuzz.sh
  --coverage              also gcovr, for scripts/coverage.sh
  --valgrind              also Valgrind, for scripts/valgrind.sh
  --peers                 also the coders that benchmarks/peers compares bspc with
  --plots                 also Matplotlib and Pillow, for the plots of benchmarks
  --for-download PACKAGE  also make sure that apt-get knows PACKAGE, without installing it
END
}

die() {
  echo "setup: $*" >&2
  exit 1
}

wanted=("${build_packages[@]}")
paraview=no
to_download=
while (($# > 0)); do
  case $1 in
    --paraview)
      wanted+=("${paraview_packages[@]}")
      paraview=yes
      ;;
    --lint) wanted+=("${lint_packages[@]}") ;;
    --vtk) wanted+=("${vtk_packages[@]}") ;;
    --openmesh) wanted+=("${openmesh_packages[@]}") ;;
    --coverage) wanted+=("${coverage_packages[@]}") ;;
    --valgrind) wanted+=("${valgrind_packages[@]}") ;;
    --compilers) wanted+=("${compiler_packages[@]}") ;;
    --fuzz) wanted+=("${fuzz_packages[@]}") ;;
    --peers) wanted+=("${peer_packages[@]}") ;;
    --plots) wanted+=("${plot_packages[@]}") ;;
    --for-download)
      (($# > 1)) || die "--for-download needs the name of a package"
      to_download=$2
      shift
      ;;
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
done

installed() {
  [[ $(dpkg-query --show --showformat='${db:Status-Status}' "$1" 2>/dev/null) == installed ]]
}

# A package is known if apt-get could fetch it now.
known() {
  [[ -n $(apt-cache madison "$1" 2>/dev/null) ]]
}

missing=()
if command -v dpkg-query >/dev/null; then
  for package in "${wanted[@]}"; do
    installed "$package" || missing+=("$package")
  done
else
  missing=("${wanted[@]}")
fi

if ((${#missing[@]} == 0)); then
  echo "setup: all ${#wanted[@]} packages are installed"
  [[ -n $to_download || $paraview == yes ]] || exit 0
fi

command -v apt-get >/dev/null ||
  die "apt-get is missing: this script knows Debian and its relatives only." \
    "Install what these packages hold by other means: ${wanted[*]}"

as_root=()
need_root() {
  if ((EUID == 0)); then return; fi
  command -v sudo >/dev/null ||
    die "missing packages: ${missing[*]:-none}; run this script as root, or install sudo"
  as_root=(sudo)
}

# Environment variables do not pass through sudo unless env sets them behind it.
apt() {
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get -y -q "$@"
}

refreshed=no
refresh_lists() {
  [[ $refreshed == no ]] || return 0
  echo "setup: fetching the package lists"
  need_root
  apt update
  refreshed=yes
}

install_missing() {
  apt install --no-install-recommends "${missing[@]}"
}

if ((${#missing[@]} > 0)); then
  need_root
  for package in "${missing[@]}"; do
    known "$package" || refresh_lists
  done
  echo "setup: installing ${missing[*]}"
  if ! install_missing; then
    # Lists that are older than the archive name files that are gone.
    [[ $refreshed == no ]] || die "apt-get could not install: ${missing[*]}"
    refresh_lists
    install_missing || die "apt-get could not install: ${missing[*]}"
  fi
fi

if [[ -n $to_download ]]; then
  known "$to_download" || refresh_lists
  known "$to_download" || die "apt-get does not know the package $to_download"
fi

unpack_paraview_python() {
  if [[ -d $paraview_python_folder/usr/lib/python3/dist-packages/paraview ]]; then return; fi
  known "$paraview_python_package" || refresh_lists
  local folder
  folder=$(mktemp -d)
  (cd "$folder" && apt-get -q download "$paraview_python_package")
  mkdir -p "$paraview_python_folder"
  dpkg-deb -x "$folder/$paraview_python_package"_*.deb "$paraview_python_folder"
  rm -r "$folder"
}
if [[ $paraview == yes ]]; then
  cd "$(dirname "${BASH_SOURCE[0]}")/.."
  unpack_paraview_python
fi
