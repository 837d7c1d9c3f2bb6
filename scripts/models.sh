#!/usr/bin/env bash
# Fetches the models of Debian's package libcgal-demo; scripts/demo.sh and benchmarks/paper.sh use it.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

if (($# > 0)); then
  cat <<'END'
Usage: scripts/models.sh

Fetches the models of Debian's package libcgal-demo into build/demo/data (24 MB, once; the package is
not installed). Does nothing if they are there.
END
  [[ $1 == -h || $1 == --help ]] && exit 0
  exit 2
fi

package=libcgal-demo
demo=build/demo
[[ ! -f $demo/complete ]] || exit 0

scripts/setup.sh --for-download "$package"
echo "models: fetching the models of $package into $demo"
rm -rf "$demo/package"
mkdir -p "$demo/package"
options=()
# apt-get's own user may not be able to write into a checkout.
((EUID != 0)) || options=(-o APT::Sandbox::User=root)
rm -f "$demo/$package"_*.deb
(cd "$demo" && apt-get -q "${options[@]}" download "$package")
dpkg -x "$demo/$package"_*.deb "$demo/package"
tar -xzf "$demo/package/usr/share/doc/$package/data.tar.gz" -C "$demo"
rm -r "$demo/package"
touch "$demo/complete"
