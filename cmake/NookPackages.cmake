# SPDX-License-Identifier: GPL-3.0-or-later
# cpack -G DEB in the build folder makes nook, with the program and its patterns, and libnook-dev, with the CMake package and the
# headers. cpack -G ZIP of a Windows build makes the program.
set(CPACK_PACKAGE_NAME nook)
set(CPACK_PACKAGE_VENDOR nook)
set(CPACK_PACKAGE_CONTACT "nook maintainers <nook@users.noreply.github.com>")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "ambient obscurance assets, made and measured")
set(CPACK_RESOURCE_FILE_LICENSE ${PROJECT_SOURCE_DIR}/LICENSE)
set(CPACK_STRIP_FILES ON)
set(CPACK_VERBATIM_VARIABLES ON)
set(CPACK_COMPONENTS_ALL nook libnook-dev)

set(NOOK_HOMEPAGE "" CACHE STRING "Address of the project, for packages' Homepage")
set(CPACK_PACKAGE_HOMEPAGE_URL ${NOOK_HOMEPAGE})

# Man pages and completions are made as they are installed, by the program that is.
if(UNIX AND NOT EMSCRIPTEN AND (NOT CMAKE_CROSSCOMPILING OR CMAKE_CROSSCOMPILING_EMULATOR))
	list(JOIN CMAKE_CROSSCOMPILING_EMULATOR " " emulator)
	install(CODE "
		set(pages \"${PROJECT_BINARY_DIR}/help_pages\")
		execute_process(COMMAND sh \"${PROJECT_SOURCE_DIR}/packaging/help_pages.sh\" \"${emulator} ${PROJECT_BINARY_DIR}/tools/nook\" \"\${pages}\"
			COMMAND_ERROR_IS_FATAL ANY)
		file(GLOB manual \"\${pages}/*.gz\")
		set(share \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_DATADIR}\")
		file(INSTALL \${manual} DESTINATION \"\${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_MANDIR}/man1\")
		file(INSTALL \"\${pages}/nook\" DESTINATION \"\${share}/bash-completion/completions\")
		file(INSTALL \"\${pages}/_nook\" DESTINATION \"\${share}/zsh/vendor-completions\")
		file(INSTALL \"\${pages}/nook.fish\" DESTINATION \"\${share}/fish/vendor_completions.d\")" COMPONENT nook)
endif()

if(WIN32)
	set(CPACK_GENERATOR ZIP)
	set(CPACK_COMPONENTS_ALL nook licences)
	set(CPACK_ARCHIVE_FILE_NAME nook-${PROJECT_VERSION}-windows-x86_64)
	set(CPACK_PACKAGE_FILE_NAME ${CPACK_ARCHIVE_FILE_NAME})
else()
	set(CPACK_GENERATOR DEB)
	set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
	set(CPACK_DEB_COMPONENT_INSTALL ON)
	set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
	set(CPACK_DEBIAN_PACKAGE_SECTION graphics)
	set(CPACK_DEBIAN_NOOK_PACKAGE_NAME nook)
	set(CPACK_DEBIAN_NOOK_PACKAGE_SHLIBDEPS ON)
	set(CPACK_COMPONENT_NOOK_DESCRIPTION "Program that makes sample patterns, shader modules and occlusion volumes\n of levels for ambient obscurance, and measures how far they are from\n ray tracing.")
	set(CPACK_DEBIAN_LIBNOOK-DEV_PACKAGE_NAME libnook-dev)
	set(CPACK_DEBIAN_LIBNOOK-DEV_PACKAGE_SECTION libdevel)
	set(CPACK_DEBIAN_LIBNOOK-DEV_PACKAGE_DEPENDS "nook (= ${PROJECT_VERSION})")
	set(CPACK_COMPONENT_LIBNOOK-DEV_DESCRIPTION "Package of CMake for nook, and headers that read its files\n With find_package(nook), patterns, shader modules, levels and their\n volumes are made while a project builds.")

	# Files that Debian requires in addition to the licences.
	execute_process(COMMAND git -C ${PROJECT_SOURCE_DIR} log -1 --format=%aD
		OUTPUT_VARIABLE date OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
	if(NOT date)
		set(date "Thu, 01 Jan 1970 00:00:00 +0000") # not a repository
	endif()
	find_program(NOOK_GZIP gzip)
	mark_as_advanced(NOOK_GZIP)
	foreach(package IN ITEMS nook libnook-dev)
		set(folder ${PROJECT_BINARY_DIR}/debian/${package})
		configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/copyright ${folder}/copyright COPYONLY)
		configure_file(${CMAKE_CURRENT_LIST_DIR}/debian/changelog.in ${folder}/changelog @ONLY)
		if(NOOK_GZIP)
			execute_process(COMMAND ${NOOK_GZIP} -9nf changelog WORKING_DIRECTORY ${folder})
		endif()
		install(DIRECTORY ${folder}/ DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${package} COMPONENT ${package}
			FILE_PERMISSIONS OWNER_READ OWNER_WRITE GROUP_READ WORLD_READ)
	endforeach()
endif()
include(CPack)
