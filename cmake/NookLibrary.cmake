# SPDX-License-Identifier: GPL-3.0-or-later
# libnook.so, nook::library: the C API. tools/CMakeLists.txt includes this file.
file(STRINGS ${PROJECT_SOURCE_DIR}/include/nook/nook.h NOOK_ABI REGEX "^#define NOOK_ABI [0-9]+$")
string(REGEX REPLACE "^.* " "" NOOK_ABI "${NOOK_ABI}")

add_library(nook_library SHARED $<TARGET_OBJECTS:nook_capi>)
target_link_libraries(nook_library PRIVATE nook_verbs)
set_target_properties(nook_library PROPERTIES OUTPUT_NAME nook EXPORT_NAME library VERSION ${NOOK_ABI}.${PROJECT_VERSION} SOVERSION ${NOOK_ABI}
	INSTALL_RPATH "$ORIGIN/nook;$ORIGIN/../libsamples/core" BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH_USE_LINK_PATH ON)
target_link_options(nook_library PRIVATE -Wl,--no-undefined -Wl,--version-script=${CMAKE_CURRENT_SOURCE_DIR}/capi.map)
set_property(TARGET nook_library PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/capi.map)
add_library(nook::library ALIAS nook_library)

target_include_directories(nook_library INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
install(TARGETS nook_library EXPORT nook_library LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libnook${NOOK_ABI}
	NAMELINK_COMPONENT libnook-dev)
install(EXPORT nook_library NAMESPACE nook:: FILE nookLibrary.cmake DESTINATION ${NOOK_INSTALL_CMAKEDIR} COMPONENT libnook-dev)
install(FILES ${PROJECT_SOURCE_DIR}/include/nook/nook.h ${PROJECT_SOURCE_DIR}/include/nook/nook.hpp
	DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nook COMPONENT libnook-dev)
# Debian's folder of Python packages; only python3-nook holds them.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/nook DESTINATION lib/python3/dist-packages COMPONENT python3-nook EXCLUDE_FROM_ALL
	FILES_MATCHING PATTERN "*.py")
