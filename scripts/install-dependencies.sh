#!/usr/bin/env bash
# SPDX-FileCopyrightText: loopmark contributors
# SPDX-License-Identifier: BSD-3-Clause
#
# Installs the Debian packages loopmark is built from. Needs root, or sudo. Does nothing, quickly, when all are there.
set -euo pipefail

usage() {
  cat <<'TEXT'
usage: scripts/install-dependencies.sh [--checks] [--fuzz] [--peers] [--dry-run]

Installs what building and testing loopmark needs, from the distribution's own archive:
compilers and build tools, and the libraries listed in this script.
  --checks   also what the checks need (clang-format, clang-tidy; Chromium for the tests of the pages)
  --fuzz     also what fuzzing and the fault scripts need (clang with libFuzzer, strace)
  --peers    also what the benchmarks compare against (Open3D, Google Benchmark, their Python)
             and what the Slurm example needs
  --dry-run  only say what would be installed
TEXT
}

# Package and the upstream version it was tested with (Debian 12). On Debian 12 that version is asked for by name;
# on another release the release's own version is taken.
build_tools='
build-essential=12.*       cmake=3.25.*          ninja-build=1.11.*     ccache=4.8*
git=1:2.*                  pkg-config=1.8.*      xz-utils=5.4.*         python3=3.11.*
file=1:5.*                 dpkg-dev=1.21.*       ca-certificates=*
'
libraries='
libeigen3-dev=3.4.*        libtbb-dev=2021.8.*   libnanoflann-dev=1.4.* libhwy-dev=1.0.*
libpcl-dev=1.13.*          libceres-dev=2.1.*    liboctomap-dev=1.9.*   libembree-dev=3.13.*
libmrpt-obs-dev=1:2.5.*    libmrpt-maps-dev=1:2.5.*  libmrpt-poses-dev=1:2.5.*
libmrpt-io-dev=1:2.5.*     libmrpt-opengl-dev=1:2.5.*
libyaml-cpp-dev=0.7.*      libcli11-dev=2.1.*    nlohmann-json3-dev=3.11.*
libkissfft-dev=131.*       libpng-dev=1.6.*      zlib1g-dev=1:1.2.*     libzstd-dev=1.5.*
libsqlite3-dev=3.40.*      liblz4-dev=1.9.*        libbz2-dev=1.0.*
libcpp-httplib-dev=0.11.*
libgtest-dev=1.12.*        libgmock-dev=1.12.*
'
# The script of the pages is bundled with these. Node from elsewhere brings its own npm, which Debian's would conflict with.
pages='esbuild=0.17.*'
if ! command -v node >/dev/null || ! command -v npm >/dev/null; then
  pages+=' nodejs=18.* npm=9.2.*'
fi
checks='
clang-format=1:14.*        clang-tidy=1:14.*         chromium=*
'
fuzzers='
clang-14=1:14.*            libclang-rt-14-dev=1:14.*   strace=6.1*
'
peers='
libopen3d-dev=0.16.*       libbenchmark-dev=1.7.*  python3-open3d=0.16.*  python3-numpy=1:1.24.*
slurm-wlm=22.05.*          munge=0.5.*
'

wanted="$build_tools $libraries $pages"
dry_run=false
for argument in "$@"; do
  case "$argument" in
    --checks) wanted+=" $checks" ;;
    --fuzz) wanted+=" $fuzzers" ;;
    --peers) wanted+=" $peers" ;;
    --dry-run) dry_run=true ;;
    -h | --help) usage; exit 0 ;;
    *) usage >&2; exit 2 ;;
  esac
done

if ! command -v apt-get >/dev/null; then
  echo "error: this script is for Debian and its relatives; install by hand: $(tr -s ' \n' ' ' <<<"$wanted")" >&2
  exit 2
fi

installed=$(dpkg-query -W -f '${db:Status-Status} ${Package}\n' | awk '$1 == "installed" { print $2 }' | sort -u)
missing=()
for entry in $wanted; do
  if ! grep -qxF -- "${entry%%=*}" <<<"$installed"; then
    missing+=("$entry")
  fi
done
if [[ ${#missing[@]} -eq 0 ]]; then
  echo "dependencies: all $(wc -w <<<"$wanted") packages are there"
  exit 0
fi

# shellcheck disable=SC1091
release=$(. /etc/os-release && echo "${ID:-}-${VERSION_ID:-}")
if [[ "$release" != debian-12 ]]; then
  echo "dependencies: $release is not the tested release (debian-12): taking its own versions"
  missing=("${missing[@]%%=*}")
fi
missing=("${missing[@]%=\*}")

as_root=()
if [[ $EUID -ne 0 ]]; then
  command -v sudo >/dev/null || {
    echo "error: ${#missing[@]} packages are missing and this is neither root nor a machine with sudo; as root, run: $0 $*" >&2
    exit 2
  }
  as_root=(sudo)
fi

echo "dependencies: installing ${#missing[@]} of $(wc -w <<<"$wanted") packages with apt-get:"
printf '  %s\n' "${missing[@]}"
if $dry_run; then
  exit 0
fi
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends \
  -o Dpkg::Use-Pty=0 "${missing[@]}" >/dev/null
echo "dependencies: done"
