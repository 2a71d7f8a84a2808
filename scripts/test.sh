#!/bin/sh
# SPDX-License-Identifier: GPL-3.0-or-later
# Sets up, configures, builds, and runs every test through ctest, or those that ctest's options choose. Incremental: run it again at any
# time. Usage: test.sh [CTEST_OPTION...]
set -eu
cd "$(dirname "$0")/.."
export GLIBC_TUNABLES="${GLIBC_TUNABLES-glibc.malloc.hugetlb=1}" # huge pages save a tenth to a quarter of the time

scripts/setup.sh
cmake --preset release
cmake --build --preset release
ctest --preset release --parallel "$(nproc)" "$@"
