# SPDX-License-Identifier: GPL-3.0-or-later
#[[
Makes the occlusion volumes of a level while the project builds, and lets a target include what reads them.

	nook_add_volumes(TARGET LEVEL file|builtin:NAME DISTANCE metres OUTPUT variable [NAME name] [LAYOUT polygons|prisms]
		[OPTIONS ...])

TARGET    a target of this project; it is built after the file, and finds <nook/nook_volumes.h> and <nook/nook_volumes_draw.h>
LEVEL     what nook reads: .gltf .glb .obj .fbx .ply .stl, or builtin:NAME; a path from the current source folder
DISTANCE  how far a polygon darkens what lies before it, metres
OUTPUT    variable that receives the path of the file, NAME.volumes.glb; what was dropped and why is beside it, NAME.volumes.json
NAME      the level's own where absent
LAYOUT    polygons where absent
OPTIONS   more options of `nook volumes`: --compress, --compensate, --drop-below 1/512, ...

The file is made again when the level, a file that it names, the options or the program change, and not otherwise.
]]
function(nook_add_volumes target)
	cmake_parse_arguments(PARSE_ARGV 1 arg "" "LEVEL;DISTANCE;OUTPUT;NAME;LAYOUT" "OPTIONS")
	if(arg_UNPARSED_ARGUMENTS)
		message(FATAL_ERROR "nook_add_volumes: found '${arg_UNPARSED_ARGUMENTS}', expected LEVEL, DISTANCE, OUTPUT, NAME, LAYOUT or OPTIONS")
	endif()
	if(NOT TARGET ${target})
		message(FATAL_ERROR "nook_add_volumes: found no target '${target}', expected one of this project")
	endif()
	if(NOT arg_LEVEL OR NOT arg_OUTPUT)
		message(FATAL_ERROR "nook_add_volumes: found no LEVEL or no OUTPUT, expected both")
	endif()
	if(NOT arg_DISTANCE MATCHES "^([0-9]+[.]?[0-9]*|[.][0-9]+)(e[-+]?[0-9]+)?$" OR NOT arg_DISTANCE MATCHES "^[0.]*[1-9]")
		message(FATAL_ERROR "nook_add_volumes: DISTANCE: found '${arg_DISTANCE}', expected metres above 0")
	endif()
	if(NOT DEFINED arg_LAYOUT)
		set(arg_LAYOUT polygons)
	endif()
	if(NOT arg_LAYOUT MATCHES "^(polygons|prisms)$")
		message(FATAL_ERROR "nook_add_volumes: LAYOUT: found '${arg_LAYOUT}', expected polygons or prisms")
	endif()
	set(level "${arg_LEVEL}")
	if(level MATCHES "^builtin:")
		string(REGEX REPLACE "^builtin:" "" name "${level}")
	else()
		get_filename_component(level "${level}" ABSOLUTE)
		get_filename_component(name "${level}" NAME_WLE)
	endif()
	if(arg_NAME)
		set(name "${arg_NAME}")
	endif()
	get_target_property(names ${target} NOOK_VOLUMES)
	if(name IN_LIST names)
		message(FATAL_ERROR "nook_add_volumes: ${target}: found '${name}' twice, expected a NAME of its own for the second")
	endif()
	set_property(TARGET ${target} APPEND PROPERTY NOOK_VOLUMES "${name}")
	_nook_folder(${target} folder)
	set(file "${folder}/${name}.volumes.glb")
	# What a level of a file reads is known only then; one that is built in reads nothing, and CMake takes no empty list.
	# Ninja takes the file of a DEPFILE away: that is no byproduct.
	set(statement "${folder}/${name}.volumes.json")
	set(inputs BYPRODUCTS "${statement}" "${file}.d")
	if(NOT arg_LEVEL MATCHES "^builtin:")
		set(inputs "${level}" DEPFILE "${file}.d" BYPRODUCTS "${statement}")
	endif()
	_nook_make("${folder}/${name}.volumes" "nook: volumes of ${arg_LEVEL}" "${file}" "${inputs}"
		volumes "${level}" --distance ${arg_DISTANCE} --layout ${arg_LAYOUT} ${arg_OPTIONS}
		-o "${file}" --json "${statement}" --depfile "${file}.d")
	string(MAKE_C_IDENTIFIER "${name}" identifier)
	add_custom_target(${target}_nook_volumes_${identifier} DEPENDS "${file}")
	add_dependencies(${target} ${target}_nook_volumes_${identifier})
	get_target_property(type ${target} TYPE)
	set(scope PUBLIC)
	if(type STREQUAL "INTERFACE_LIBRARY")
		set(scope INTERFACE)
	endif()
	target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${NOOK_INCLUDE_DIR}>")
	set(${arg_OUTPUT} "${file}" PARENT_SCOPE)
endfunction()
