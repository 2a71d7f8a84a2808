# SPDX-License-Identifier: GPL-3.0-or-later
#[[
Converts a level while the project builds.

	nook_add_level(TARGET LEVEL file|builtin:NAME OUTPUT variable [NAME name] [OPTIONS ...])

TARGET   a target of this project; it is built after the file
LEVEL    what nook reads: .gltf .glb .obj .fbx .ply .stl, or builtin:NAME; a path from the current source folder
OUTPUT   variable that receives the path of the file, NAME.glb
NAME     the level's own where absent
OPTIONS  more options of `nook level`: --unit 0.01, --strict, ...

The file is made again when the level, a file that it names, the options or the program change, and not otherwise.
]]
function(nook_add_level target)
	cmake_parse_arguments(PARSE_ARGV 1 arg "" "LEVEL;OUTPUT;NAME" "OPTIONS")
	if(arg_UNPARSED_ARGUMENTS)
		message(FATAL_ERROR "nook_add_level: found '${arg_UNPARSED_ARGUMENTS}', expected LEVEL, OUTPUT, NAME or OPTIONS")
	endif()
	if(NOT TARGET ${target})
		message(FATAL_ERROR "nook_add_level: found no target '${target}', expected one of this project")
	endif()
	if(NOT arg_LEVEL OR NOT arg_OUTPUT)
		message(FATAL_ERROR "nook_add_level: found no LEVEL or no OUTPUT, expected both")
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
	_nook_folder(${target} folder)
	set(file "${folder}/${name}.glb")
	# What a level of a file reads is known only then; one that is built in reads nothing, and CMake takes no empty list.
	set(inputs "")
	if(NOT arg_LEVEL MATCHES "^builtin:")
		set(inputs "${level}" DEPFILE "${file}.d")
	endif()
	_nook_make("${folder}/${name}" "nook: ${arg_LEVEL}" "${file}" "${inputs}"
		level "${level}" ${arg_OPTIONS} -o "${file}" --depfile "${file}.d")
	string(MAKE_C_IDENTIFIER "${name}" identifier)
	add_custom_target(${target}_nook_level_${identifier} DEPENDS "${file}")
	add_dependencies(${target} ${target}_nook_level_${identifier})
	set(${arg_OUTPUT} "${file}" PARENT_SCOPE)
endfunction()
