#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Set-up, configure, build, and every test through ctest. Can be run again; what is done is not done twice.
set -eu
cd "$(dirname "$0")/.."
export GLIBC_TUNABLES="${GLIBC_TUNABLES-glibc.malloc.hugetlb=1}" # large pages save a tenth to a quarter of much that is run

scripts/setup.sh
cmake --preset release
cmake --build --preset release
ctest --preset release --parallel "$(nproc)"
