# SPDX-License-Identifier: GPL-3.0-or-later
# Windows on x86-64 with Debian's MinGW and POSIX threads: programs that need only Windows' own libraries, with the stack of Linux. Run by
# Wine.
set(CMAKE_SYSTEM_NAME Windows)
set(CMAKE_SYSTEM_PROCESSOR x86_64)
set(CMAKE_C_COMPILER x86_64-w64-mingw32-gcc-posix)
set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)
set(CMAKE_RC_COMPILER x86_64-w64-mingw32-windres)
set(CMAKE_FIND_ROOT_PATH /usr/x86_64-w64-mingw32 ${NOOK_WINDOWS_LIBRARIES}) # the second: packaging/windows_libraries.sh
set(CMAKE_EXE_LINKER_FLAGS_INIT "-static -s -Wl,--stack,8388608")
find_program(NOOK_WINE NAMES wine64 wine64-stable PATHS /usr/lib/wine NO_CMAKE_FIND_ROOT_PATH)
if(NOOK_WINE)
	set(CMAKE_CROSSCOMPILING_EMULATOR ${NOOK_WINE})
endif()
include(${CMAKE_CURRENT_LIST_DIR}/headers.cmake)
