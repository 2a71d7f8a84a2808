# SPDX-License-Identifier: GPL-3.0-or-later
# libnook.so, nook::library, and libnook.a, nook::static: the C API. tools/CMakeLists.txt includes this file.
file(STRINGS ${PROJECT_SOURCE_DIR}/include/nook/nook.h NOOK_ABI REGEX "^#define NOOK_ABI [0-9]+$")
string(REGEX REPLACE "^.* " "" NOOK_ABI "${NOOK_ABI}")

add_library(nook_library SHARED $<TARGET_OBJECTS:nook_capi>)
target_link_libraries(nook_library PRIVATE nook_verbs)
set_target_properties(nook_library PROPERTIES OUTPUT_NAME nook EXPORT_NAME library VERSION ${NOOK_ABI}.${PROJECT_VERSION} SOVERSION ${NOOK_ABI}
	INSTALL_RPATH "$ORIGIN/nook;$ORIGIN/../libsamples/core" BUILD_WITH_INSTALL_RPATH ON INSTALL_RPATH_USE_LINK_PATH ON)
target_link_options(nook_library PRIVATE -Wl,--no-undefined -Wl,--version-script=${CMAKE_CURRENT_SOURCE_DIR}/capi.map)
set_property(TARGET nook_library PROPERTY LINK_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/capi.map)
add_library(nook::library ALIAS nook_library)

# One object of all rooms in which only the API is visible. The libraries of others stay separate, as in libnook.so.
get_target_property(rooms nook_samples INTERFACE_LINK_LIBRARIES)
list(FILTER rooms INCLUDE REGEX "^nook_") # CMake marks targets of other folders
set(parts nook_verbs nook_commit nook_shared ${rooms})
list(TRANSFORM parts REPLACE "(.+)" "$<TARGET_FILE:\\1>" OUTPUT_VARIABLE archives)
set(object ${CMAKE_CURRENT_BINARY_DIR}/nook_static.o)
add_custom_command(OUTPUT ${object}
	COMMAND sh ${PROJECT_SOURCE_DIR}/cmake/static_object.sh ${CMAKE_LINKER} ${CMAKE_NM} ${CMAKE_OBJCOPY} ${object}
		$<TARGET_OBJECTS:nook_capi> --start-group ${archives} --end-group
	DEPENDS ${PROJECT_SOURCE_DIR}/cmake/static_object.sh nook_capi $<TARGET_OBJECTS:nook_capi> ${parts}
	COMMAND_EXPAND_LISTS VERBATIM)
add_library(nook_static STATIC ${object})
set_target_properties(nook_static PROPERTIES OUTPUT_NAME nook EXPORT_NAME static LINKER_LANGUAGE CXX)
target_link_libraries(nook_static INTERFACE PNG::PNG TBB::tbb embree meshoptimizer::meshoptimizer epoxy ${CMAKE_DL_LIBS} stdc++ m)
if(NOOK_GMP AND NOOK_GMP_INCLUDE AND NOOK_GMP_LIBRARY AND NOOK_MPFR_LIBRARY)
	target_link_libraries(nook_static INTERFACE mpfr gmp)
endif()
# The run path of a program leads to the workers, as that of libnook.so does.
target_link_options(nook_static INTERFACE "$<INSTALL_INTERFACE:LINKER:-rpath,$<INSTALL_PREFIX>/${CMAKE_INSTALL_LIBDIR}/nook>")

foreach(kind IN ITEMS library static)
	target_include_directories(nook_${kind} INTERFACE $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
endforeach()
install(TARGETS nook_library EXPORT nook_library LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libnook${NOOK_ABI}
	NAMELINK_COMPONENT libnook-dev)
install(TARGETS nook_static EXPORT nook_static ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} COMPONENT libnook-dev)
install(EXPORT nook_library NAMESPACE nook:: FILE nookLibrary.cmake DESTINATION ${NOOK_INSTALL_CMAKEDIR} COMPONENT libnook-dev)
install(EXPORT nook_static NAMESPACE nook:: FILE nookStatic.cmake DESTINATION ${NOOK_INSTALL_CMAKEDIR} COMPONENT libnook-dev)
install(FILES ${PROJECT_SOURCE_DIR}/include/nook/nook.h ${PROJECT_SOURCE_DIR}/include/nook/nook.hpp
	DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/nook COMPONENT libnook-dev)
# Debian's folder of Python packages; only python3-nook holds them.
install(DIRECTORY ${PROJECT_SOURCE_DIR}/python/nook DESTINATION lib/python3/dist-packages COMPONENT python3-nook EXCLUDE_FROM_ALL
	FILES_MATCHING PATTERN "*.py")
