# SPDX-License-Identifier: GPL-3.0-or-later
# Links the header-only libraries of the build machine's /usr/include into the build folder, for a compiler that must not see the
# rest of that folder.
get_property(in_test GLOBAL PROPERTY IN_TRY_COMPILE)
if(NOT in_test)
	set(NOOK_HEADERS ${CMAKE_BINARY_DIR}/headers CACHE PATH "")
	foreach(name IN ITEMS CGAL CLI boost eigen3/Eigen glm nlohmann)
		get_filename_component(link ${name} NAME)
		if(EXISTS /usr/include/${name} AND NOT EXISTS ${NOOK_HEADERS}/${link})
			file(MAKE_DIRECTORY ${NOOK_HEADERS})
			file(CREATE_LINK /usr/include/${name} ${NOOK_HEADERS}/${link} SYMBOLIC)
		endif()
	endforeach()
endif()
# Never use the build machine's libraries.
set(CMAKE_FIND_ROOT_PATH_MODE_PROGRAM NEVER)
set(CMAKE_FIND_ROOT_PATH_MODE_LIBRARY ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_INCLUDE ONLY)
set(CMAKE_FIND_ROOT_PATH_MODE_PACKAGE ONLY)
