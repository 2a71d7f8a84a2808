# SPDX-License-Identifier: GPL-3.0-or-later
# WebAssembly for Node.js and browsers, by Debian's Emscripten.
find_program(NOOK_EMCC emcc REQUIRED)
file(REAL_PATH ${NOOK_EMCC} NOOK_EMCC_FILE)
get_filename_component(EMSCRIPTEN_ROOT_PATH ${NOOK_EMCC_FILE} DIRECTORY)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
# Eigen sums by twos, as with SSE2 elsewhere: the same order, the same bytes. What it has for x86 alone stays out: a header of MMX, by
# that header's guard; assembly for GCC before 6.3 and from 6.0 on, by the number 5.13, which it reads as 6.3 in one place and as 5 in
# the other. Errors are the machine's own exceptions.
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -msse2 -D__MMINTRIN_H -fgnuc-version=5.13 -fwasm-exceptions")
# Where Debian keeps what the optimiser needs.
set(CMAKE_CXX_LINKER_LAUNCHER ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs)
set(CMAKE_CROSSCOMPILING_EMULATOR "node;--no-experimental-fetch")
set(NOOK_CCACHE "" CACHE FILEPATH "") # it does not know emcc
include(${CMAKE_CURRENT_LIST_DIR}/headers.cmake)
