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
	_nook_level_of(nook_add_level level name)
	_nook_check_options(nook_add_level "${arg_OPTIONS}" -o --depfile)
	_nook_name_once(nook_add_level ${target} NOOK_LEVELS "${name}")
	_nook_folder(${target} folder)
	set(file "${folder}/${name}.glb")
	_nook_level_inputs("${level}" "${file}.d" inputs)
	_nook_make("${folder}/${name}" "nook: ${arg_LEVEL}" "${file}" "${inputs}"
		level "${level}" ${arg_OPTIONS} -o "${file}" --depfile "${file}.d")
	_nook_target(${target} level "${name}" "${file}" "${level}")
	set(${arg_OUTPUT} "${file}" PARENT_SCOPE)
endfunction()

# Checks LEVEL and OUTPUT of a function that reads a level; sets `level` to nook's argument and `name` to the stem of file names.
macro(_nook_level_of function level name)
	if(NOT TARGET ${target})
		message(FATAL_ERROR "${function}: found no target '${target}', expected one of this project")
	endif()
	if(NOT arg_LEVEL OR NOT arg_OUTPUT)
		message(FATAL_ERROR "${function}: found no LEVEL or no OUTPUT, expected both")
	endif()
	set(${level} "${arg_LEVEL}")
	if(arg_LEVEL MATCHES "^builtin:")
		string(REGEX REPLACE "^builtin:" "" ${name} "${arg_LEVEL}")
	else()
		get_filename_component(${level} "${arg_LEVEL}" ABSOLUTE)
		get_filename_component(${name} "${arg_LEVEL}" NAME_WLE)
	endif()
	if(arg_NAME)
		set(${name} "${arg_NAME}")
	endif()
endmacro()

# Checks an argument that must be a length.
macro(_nook_check_length function argument expected)
	if(NOT arg_${argument} MATCHES "^([0-9]+[.]?[0-9]*|[.][0-9]+)(e[-+]?[0-9]+)?$" OR NOT arg_${argument} MATCHES "^[0.]*[1-9]")
		message(FATAL_ERROR "${function}: ${argument}: found '${arg_${argument}}', expected ${expected}")
	endif()
endmacro()

# Sets `result` to the INPUTS argument of _nook_make for a level and other files. A level's files are known only once it is read; a
# built-in level has none, and CMake accepts no empty list. Ninja removes the DEPFILE, so it is not a byproduct.
function(_nook_level_inputs level depfile result)
	if(level MATCHES "^builtin:")
		set(${result} ${ARGN} BYPRODUCTS "${depfile}" PARENT_SCOPE)
	else()
		set(${result} "${level}" ${ARGN} DEPFILE "${depfile}" PARENT_SCOPE)
	endif()
endfunction()

# Creates a separate target for files made for a target. It depends on the targets whose files it reads, since Make would otherwise
# make these twice.
function(_nook_target target kind name files read)
	string(MAKE_C_IDENTIFIER "${name}" identifier)
	set(own ${target}_nook_${kind}_${identifier})
	add_custom_target(${own} DEPENDS ${files})
	add_dependencies(${target} ${own})
	get_target_property(others ${target} NOOK_TARGETS)
	foreach(other IN LISTS others)
		if(NOT other)
			continue()
		endif()
		get_target_property(made ${other} NOOK_FILES)
		foreach(file IN LISTS read)
			if(file IN_LIST made)
				add_dependencies(${own} ${other})
			endif()
		endforeach()
	endforeach()
	set_target_properties(${own} PROPERTIES NOOK_FILES "${files}")
	set_property(TARGET ${target} APPEND PROPERTY NOOK_TARGETS ${own})
endfunction()
