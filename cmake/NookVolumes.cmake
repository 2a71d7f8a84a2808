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
	_nook_level_of(nook_add_volumes level name)
	_nook_check_length(nook_add_volumes DISTANCE "metres above 0")
	if(NOT DEFINED arg_LAYOUT)
		set(arg_LAYOUT polygons)
	endif()
	if(NOT arg_LAYOUT MATCHES "^(polygons|prisms)$")
		message(FATAL_ERROR "nook_add_volumes: LAYOUT: found '${arg_LAYOUT}', expected polygons or prisms")
	endif()
	_nook_check_options(nook_add_volumes "${arg_OPTIONS}" -o --json --depfile --distance --layout)
	_nook_name_once(nook_add_volumes ${target} NOOK_VOLUMES "${name}")
	_nook_folder(${target} folder)
	set(file "${folder}/${name}.volumes.glb")
	set(statement "${folder}/${name}.volumes.json")
	_nook_level_inputs("${level}" "${file}.d" inputs)
	list(APPEND inputs BYPRODUCTS "${statement}")
	_nook_make("${folder}/${name}.volumes" "nook: volumes of ${arg_LEVEL}" "${file}" "${inputs}"
		volumes "${level}" --distance ${arg_DISTANCE} --layout ${arg_LAYOUT} ${arg_OPTIONS}
		-o "${file}" --json "${statement}" --depfile "${file}.d")
	_nook_target(${target} volumes "${name}" "${file}" "${level}")
	get_target_property(type ${target} TYPE)
	set(scope PUBLIC)
	if(type STREQUAL "INTERFACE_LIBRARY")
		set(scope INTERFACE)
	endif()
	target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${NOOK_INCLUDE_DIR}>")
	set(${arg_OUTPUT} "${file}" PARENT_SCOPE)
endfunction()
