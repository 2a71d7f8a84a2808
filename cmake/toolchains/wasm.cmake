# SPDX-License-Identifier: GPL-3.0-or-later
# WebAssembly for Node.js and browsers with Debian's Emscripten.
find_program(NOOK_EMCC emcc REQUIRED)
file(REAL_PATH ${NOOK_EMCC} NOOK_EMCC_FILE)
get_filename_component(EMSCRIPTEN_ROOT_PATH ${NOOK_EMCC_FILE} DIRECTORY)
include(${EMSCRIPTEN_ROOT_PATH}/cmake/Modules/Platform/Emscripten.cmake)
# Eigen sums in pairs, as with SSE2 elsewhere: the same order, the same bytes. Its x86-only parts are disabled: an MMX header by
# defining that header's guard; assembly for GCC before 6.3 and from 6.0 on by the version 5.13, which it reads as 6.3 in one place
# and as 5 in the other. Exceptions are native.
set(CMAKE_CXX_FLAGS_INIT "-msimd128 -msse2 -D__MMINTRIN_H -fgnuc-version=5.13 -fwasm-exceptions")
# Debian's folder for the optimiser's dependencies.
set(CMAKE_CXX_LINKER_LAUNCHER ${CMAKE_COMMAND} -E env NODE_PATH=/usr/share/nodejs)
set(CMAKE_CROSSCOMPILING_EMULATOR "node;--no-experimental-fetch")
set(NOOK_CCACHE "" CACHE FILEPATH "") # ccache does not support emcc
include(${CMAKE_CURRENT_LIST_DIR}/headers.cmake)
