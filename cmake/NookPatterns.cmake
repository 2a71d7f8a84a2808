# SPDX-License-Identifier: GPL-3.0-or-later
#[[
Makes patterns while the project builds, and lets a target include them.

	nook_add_patterns(TARGET DOMAIN disk|ball|sphere|hemisphere COUNTS N...
		[OPTIONS ...] [NAME name] [FORMATS h glsl ...] [OUTPUTS variable])

TARGET    a target of this project; it finds the files by #include "NAME_NNN.h" and is built after them
COUNTS    samples, one pattern each
OPTIONS   more options of `nook pattern`: --symmetric, --method electro, --seed 3, ...
NAME      what files and arrays are named after: NAME_9_points in NAME_009.h; where absent, nook_disk_9_points in
          disk_009.h. Two calls for one target with the same domain and count need names of their own.
FORMATS   endings of the files to make; h glsl where absent
OUTPUTS   variable that receives their paths

A file is made again when its options change or the program does, and not otherwise.
]]
function(nook_add_patterns target)
	cmake_parse_arguments(PARSE_ARGV 1 arg "" "DOMAIN;NAME;OUTPUTS" "COUNTS;OPTIONS;FORMATS")
	if(arg_UNPARSED_ARGUMENTS)
		message(FATAL_ERROR "nook_add_patterns: found '${arg_UNPARSED_ARGUMENTS}', expected DOMAIN, COUNTS, OPTIONS, NAME, FORMATS or OUTPUTS")
	endif()
	if(NOT TARGET ${target})
		message(FATAL_ERROR "nook_add_patterns: found no target '${target}', expected one of this project")
	endif()
	if(NOT arg_DOMAIN MATCHES "^(disk|ball|sphere|hemisphere)$")
		message(FATAL_ERROR "nook_add_patterns: DOMAIN: found '${arg_DOMAIN}', expected disk, ball, sphere or hemisphere")
	endif()
	if(NOT arg_COUNTS)
		message(FATAL_ERROR "nook_add_patterns: COUNTS: found none, expected numbers from 1 to 4096")
	endif()
	set(identifier "${arg_NAME}")
	if(NOT arg_NAME)
		set(arg_NAME ${arg_DOMAIN})
		set(identifier nook_${arg_DOMAIN})
	endif()
	if(NOT arg_NAME MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
		message(FATAL_ERROR "nook_add_patterns: NAME: found '${arg_NAME}', expected a name as C and GLSL take it")
	endif()
	if(NOT arg_FORMATS)
		set(arg_FORMATS h glsl)
	endif()

	_nook_check_options(nook_add_patterns "${arg_OPTIONS}" -o --domain --count --name)
	_nook_folder(${target} folder)

	set(all_files "")
	foreach(count IN LISTS arg_COUNTS)
		if(NOT count MATCHES "^[1-9][0-9]*$" OR count GREATER 4096)
			message(FATAL_ERROR "nook_add_patterns: COUNTS: found '${count}', expected a number from 1 to 4096")
		endif()
		string(LENGTH ${count} digits)
		set(padded ${count})
		while(digits LESS 3)
			string(PREPEND padded 0)
			math(EXPR digits "${digits} + 1")
		endwhile()
		set(stem "${arg_NAME}_${padded}")
		_nook_name_once(nook_add_patterns ${target} NOOK_PATTERN_STEMS ${stem})

		set(files "")
		set(outputs "")
		foreach(format IN LISTS arg_FORMATS)
			list(APPEND files "${folder}/${stem}.${format}")
			list(APPEND outputs -o "${folder}/${stem}.${format}")
		endforeach()
		_nook_make("${folder}/${stem}" "nook: ${arg_DOMAIN} ${count} (${stem})" "${files}" ""
			pattern --domain ${arg_DOMAIN} --count ${count} ${arg_OPTIONS} --name ${identifier}_${count} ${outputs})
		list(APPEND all_files ${files})
	endforeach()

	# In a separate target, since the target that includes the files may belong to another folder.
	get_target_property(stems ${target} NOOK_PATTERN_STEMS)
	list(LENGTH stems made)
	add_custom_target(${target}_nook_patterns_${made} DEPENDS ${all_files})
	add_dependencies(${target} ${target}_nook_patterns_${made})
	if(arg_OUTPUTS)
		set(${arg_OUTPUTS} ${all_files} PARENT_SCOPE)
	endif()
endfunction()

# Rejects options that the function sets itself: nook's error would name the option, not the function's argument.
function(_nook_check_options function options)
	foreach(option IN LISTS options)
		string(REGEX REPLACE "=.*" "" name "${option}")
		if(name IN_LIST ARGN)
			message(FATAL_ERROR "${function}: OPTIONS: found '${name}', expected options that ${function} does not give itself (${ARGN})")
		endif()
	endforeach()
endfunction()

# Records a name in a property of the target and rejects duplicates.
function(_nook_name_once function target property name)
	get_target_property(names ${target} ${property})
	if(name IN_LIST names)
		message(FATAL_ERROR "${function}: ${target}: found '${name}' twice, expected a NAME of its own for the second")
	endif()
	set_property(TARGET ${target} APPEND PROPERTY ${property} "${name}")
endfunction()

# Sets `result` to the folder of generated files and adds it to the target's include path.
function(_nook_folder target result)
	get_target_property(folder ${target} NOOK_PATTERN_FOLDER)
	if(NOT folder)
		set(folder "${CMAKE_CURRENT_BINARY_DIR}/nook_patterns/${target}")
		set_target_properties(${target} PROPERTIES NOOK_PATTERN_FOLDER "${folder}")
		get_target_property(type ${target} TYPE)
		set(scope PUBLIC)
		if(type STREQUAL "INTERFACE_LIBRARY")
			set(scope INTERFACE)
		endif()
		target_include_directories(${target} ${scope} "$<BUILD_INTERFACE:${folder}>")
	endif()
	file(MAKE_DIRECTORY "${folder}")
	set(${result} "${folder}" PARENT_SCOPE)
endfunction()

# _nook_make(STEM COMMENT OUTPUTS INPUTS ARGUMENT...): runs nook with these arguments to make files. INPUTS may continue with
# further arguments of add_custom_command.
function(_nook_make stem comment outputs inputs)
	# Unlike Ninja, Make does not compare command lines: this file changes when the arguments do.
	string(REPLACE ";" " " recipe "${ARGN}")
	file(CONFIGURE OUTPUT "${stem}.recipe" CONTENT "nook ${recipe}\n" @ONLY)
	add_custom_command(OUTPUT ${outputs}
		COMMAND nook::tool ${ARGN}
		DEPENDS "$<TARGET_FILE:nook::tool>" "${stem}.recipe" ${inputs}
		COMMENT "${comment}"
		VERBATIM)
endfunction()
