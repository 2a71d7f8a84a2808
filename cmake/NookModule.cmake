# SPDX-License-Identifier: GPL-3.0-or-later
#[[
Emits a shader module while the project builds, with patterns made for it, and lets a target include what it needs.

	nook_add_module(TARGET NAME name METHODS vo-line|vo-point|vo-area|alchemy|statvo|slices...|aov|aov-mask
		[COUNTS N...|PATTERNS file...] GLSL 330|430|es300|vulkan|HLSL 60|WGSL [RECIPE rays|paper|file] [TILE size] [PATTERN_OPTIONS ...]
		[TILE_OPTIONS ...] [OPTIONS ...] [FORMATS js|cs|py|json...] [EMBED] [SCRIPT] [OUTPUTS variable] [SAMPLES variable])

TARGET           a target of this project; it is built after the files and finds them by #include "NAME.h"
NAME             of the files: NAME.glsl, and NAME.h, which fills the module's uniform block and holds its tiles
METHODS          what the module offers; or alone: aov or aov-mask, the stages that draw the files of nook_add_volumes, without
                 NAME.h; aov-mask not for es300 and WGSL
COUNTS           samples of each method but statvo and slices, in the same order: patterns and tiles are made for them; with slices
                 counted in as well, a tile is made of that many slices in each pixel, in place of the kernel's own
PATTERNS         or else a file for each of them, of nook pattern or nook tile
GLSL, HLSL, WGSL the module's language; the file is NAME.glsl, NAME.hlsl or NAME.wgsl
RECIPE           where settings come from: rays where absent, paper, or a file of nook fit
TILE             with COUNTS: side of the window in which every pixel has samples of its own; 4 where absent, 1 for none
PATTERN_OPTIONS  with COUNTS: more options of `nook pattern`: --starts 64, --seed 3, ...
TILE_OPTIONS     with COUNTS: more options of `nook tile`: --kind random, ...
OPTIONS          more options of `nook emit`: --filter bilateral, --resolution half, --namespace low, ...
FORMATS          endings of more files: js, cs and py fill the block in JavaScript, C# and Python, json describes it
EMBED            NAME.glsl.h as well, for programs that keep their shaders inside: the same text as the array NAME_glsl
SCRIPT           the same as FORMATS js
OUTPUTS          variable that receives the paths of NAME.glsl and NAME.h, of the FORMATS, and of NAME.glsl.h
SAMPLES          variable that receives the files of the samples: PATTERNS of another module of the same target

A file is made again when its options, its patterns, its recipe or the program change, and not otherwise.
]]
function(nook_add_module target)
	set(one NAME GLSL HLSL RECIPE TILE OUTPUTS SAMPLES)
	set(many METHODS COUNTS PATTERNS PATTERN_OPTIONS TILE_OPTIONS OPTIONS FORMATS)
	cmake_parse_arguments(PARSE_ARGV 1 arg "EMBED;SCRIPT;WGSL" "${one}" "${many}")
	if(arg_UNPARSED_ARGUMENTS)
		message(FATAL_ERROR "nook_add_module: found '${arg_UNPARSED_ARGUMENTS}', expected EMBED, SCRIPT, WGSL, ${one} or ${many}")
	endif()
	if(NOT TARGET ${target})
		message(FATAL_ERROR "nook_add_module: found no target '${target}', expected one of this project")
	endif()
	if(NOT "${arg_NAME}" MATCHES "^[A-Za-z][A-Za-z0-9_]*$")
		message(FATAL_ERROR "nook_add_module: NAME: found '${arg_NAME}', expected a name as C takes it")
	endif()
	set(language glsl)
	if(arg_WGSL)
		if(DEFINED arg_GLSL OR DEFINED arg_HLSL)
			message(FATAL_ERROR "nook_add_module: found WGSL with GLSL or HLSL, expected one language")
		endif()
		set(language wgsl)
	elseif(DEFINED arg_HLSL)
		if(NOT arg_HLSL STREQUAL "60" OR DEFINED arg_GLSL)
			message(FATAL_ERROR "nook_add_module: HLSL: found '${arg_HLSL}', expected 60, without GLSL")
		endif()
		set(language hlsl)
	elseif(NOT arg_GLSL MATCHES "^(330|430|es300|vulkan)$")
		message(FATAL_ERROR "nook_add_module: GLSL: found '${arg_GLSL}', expected 330, 430, es300 or vulkan")
	endif()
	_nook_check_methods("${arg_METHODS}" "${arg_COUNTS}" "${arg_PATTERNS}" sampled)
	_nook_check_options(nook_add_module "${arg_OPTIONS}" -o --methods --patterns --glsl --hlsl --wgsl --recipe)
	if(arg_METHODS STREQUAL "aov-mask" AND (arg_GLSL STREQUAL "es300" OR arg_WGSL))
		message(FATAL_ERROR "nook_add_module: GLSL: found '${arg_GLSL}', expected 330, 430 or vulkan, or HLSL, for aov-mask")
	endif()
	if(arg_PATTERNS AND (DEFINED arg_TILE OR arg_PATTERN_OPTIONS OR arg_TILE_OPTIONS))
		message(FATAL_ERROR "nook_add_module: found TILE, PATTERN_OPTIONS or TILE_OPTIONS with PATTERNS, expected them with COUNTS")
	endif()
	if(NOT DEFINED arg_TILE)
		set(arg_TILE 4)
	endif()
	if(NOT arg_TILE MATCHES "^[1-9][0-9]*$")
		message(FATAL_ERROR "nook_add_module: TILE: found '${arg_TILE}', expected the side of a window, 1 or more")
	endif()
	if(arg_SCRIPT)
		list(APPEND arg_FORMATS js)
		list(REMOVE_DUPLICATES arg_FORMATS)
	endif()
	foreach(format IN LISTS arg_FORMATS)
		if(NOT format MATCHES "^(js|cs|py|json)$")
			message(FATAL_ERROR "nook_add_module: FORMATS: found '${format}', expected some of js, cs, py, json")
		endif()
	endforeach()
	if(arg_METHODS MATCHES "^aov" AND (DEFINED arg_RECIPE OR arg_FORMATS))
		message(FATAL_ERROR "nook_add_module: found RECIPE, FORMATS or SCRIPT with ${arg_METHODS}, expected none of them")
	endif()
	if(arg_COUNTS AND "slices" IN_LIST sampled AND arg_TILE EQUAL 1)
		message(FATAL_ERROR "nook_add_module: TILE: found '1' with COUNTS of slices, expected 2 or more, since theirs is a tile")
	endif()
	_nook_folder(${target} folder)
	get_target_property(names ${target} NOOK_MODULES)
	_nook_name_once(nook_add_module ${target} NOOK_MODULES ${arg_NAME})

	set(patterns "")
	foreach(file IN LISTS arg_PATTERNS)
		get_filename_component(file "${file}" ABSOLUTE)
		list(APPEND patterns "${file}")
	endforeach()
	if(arg_COUNTS)
		foreach(method count IN ZIP_LISTS sampled arg_COUNTS)
			_nook_module_samples("${folder}/${arg_NAME}_${method}" ${method} ${count} file)
			list(APPEND patterns "${file}")
		endforeach()
	endif()

	set(glsl "${folder}/${arg_NAME}.${language}")
	set(outputs "${glsl}")
	set(header "")
	if(NOT arg_METHODS MATCHES "^aov")
		list(APPEND outputs "${folder}/${arg_NAME}.h")
		set(header -o "${folder}/${arg_NAME}.h")
	endif()
	foreach(format IN LISTS arg_FORMATS)
		list(APPEND outputs "${folder}/${arg_NAME}.${format}")
		list(APPEND header -o "${folder}/${arg_NAME}.${format}")
	endforeach()
	list(JOIN arg_METHODS "," methods)
	set(recipe "")
	set(read ${patterns})
	if(DEFINED arg_RECIPE)
		if(NOT arg_RECIPE MATCHES "^(rays|paper)$")
			get_filename_component(arg_RECIPE "${arg_RECIPE}" ABSOLUTE)
			list(APPEND read "${arg_RECIPE}")
		endif()
		set(recipe --recipe "${arg_RECIPE}")
	endif()
	set(inputs "")
	if(patterns)
		list(JOIN patterns "," inputs)
		set(inputs --patterns "${inputs}")
	endif()
	_nook_make("${folder}/${arg_NAME}" "nook: ${methods} (${arg_NAME})" "${outputs}" "${read}"
		emit --methods ${methods} ${inputs} ${recipe} --${language} ${arg_GLSL}${arg_HLSL} ${arg_OPTIONS} -o "${glsl}" ${header})
	if(arg_EMBED)
		set(script "${CMAKE_CURRENT_FUNCTION_LIST_DIR}/NookEmbed.cmake")
		add_custom_command(OUTPUT "${glsl}.h"
			COMMAND ${CMAKE_COMMAND} "-DINPUT=${glsl}" -DNAME=${arg_NAME}_${language} "-DOUTPUT=${glsl}.h" -P "${script}"
			DEPENDS "${glsl}" "${script}"
			COMMENT "Embedding ${arg_NAME}.${language}"
			VERBATIM)
		list(APPEND outputs "${glsl}.h")
	endif()
	add_custom_target(${target}_nook_module_${arg_NAME} DEPENDS ${outputs})
	add_dependencies(${target} ${target}_nook_module_${arg_NAME})
	foreach(name IN LISTS names) # earlier methods whose samples can be shared
		if(name)
			add_dependencies(${target}_nook_module_${arg_NAME} ${target}_nook_module_${name})
		endif()
	endforeach()
	if(arg_OUTPUTS)
		set(${arg_OUTPUTS} ${outputs} PARENT_SCOPE)
	endif()
	if(arg_SAMPLES)
		set(${arg_SAMPLES} ${patterns} PARENT_SCOPE)
	endif()
endfunction()

# Sets `result` to the domain of a method's samples, as an argument of `nook emit`.
function(_nook_domain method result)
	set(methods vo-line vo-point vo-area alchemy statvo slices)
	set(domains disk ball disk hemisphere none slice)
	list(FIND methods "${method}" at)
	if(at EQUAL -1)
		list(JOIN methods ", " known)
		message(FATAL_ERROR "nook_add_module: METHODS: found '${method}', expected some of ${known}, or aov or aov-mask alone")
	endif()
	list(GET domains ${at} domain)
	set(${result} ${domain} PARENT_SCOPE)
endfunction()

# Sets `sampled` to the methods that COUNTS or PATTERNS apply to; slices need neither.
function(_nook_check_methods methods counts patterns sampled)
	set(${sampled} "" PARENT_SCOPE)
	if(NOT methods)
		message(FATAL_ERROR "nook_add_module: METHODS: found none, expected what nook emit offers")
	endif()
	if(methods MATCHES "^(aov|aov-mask)$")
		if(counts OR patterns)
			message(FATAL_ERROR "nook_add_module: found COUNTS or PATTERNS with ${methods}, which takes no samples, expected none")
		endif()
		return()
	endif()
	foreach(method IN LISTS methods)
		_nook_domain("${method}" domain)
	endforeach()
	list(REMOVE_ITEM methods statvo)
	list(LENGTH counts with_counts)
	list(LENGTH patterns with_patterns)
	list(LENGTH methods most)
	math(EXPR given "${with_counts} + ${with_patterns}")
	if(NOT given EQUAL most)
		list(REMOVE_ITEM methods slices)
	endif()
	list(LENGTH methods expected)
	if(NOT given EQUAL expected OR (counts AND patterns))
		set(with_slices "")
		if(most GREATER expected)
			set(with_slices ", or ${most} with slices")
		endif()
		message(FATAL_ERROR "nook_add_module: found ${with_counts} COUNTS and ${with_patterns} PATTERNS, expected ${expected} of one of them, as METHODS that take samples${with_slices}")
	endif()
	set(${sampled} ${methods} PARENT_SCOPE)
	foreach(count IN LISTS counts)
		if(NOT count MATCHES "^[1-9][0-9]*$" OR count GREATER 4096)
			message(FATAL_ERROR "nook_add_module: COUNTS: found '${count}', expected a number from 1 to 4096")
		endif()
	endforeach()
endfunction()

# Makes a pattern, and its tile on request; sets `result` to the file with the samples.
function(_nook_module_samples stem method count result)
	_nook_domain(${method} domain)
	set(file "${stem}.json")
	if(domain STREQUAL "slice") # a tile without a base pattern
		_nook_make("${stem}" "nook: tile of ${count} slices (${arg_NAME})" "${file}" ""
			tile --domain slice --count ${count} --size ${arg_TILE} ${arg_TILE_OPTIONS} -o "${file}")
		set(${result} "${file}" PARENT_SCOPE)
		return()
	endif()
	_nook_make("${stem}" "nook: ${domain} ${count} (${arg_NAME}, ${method})" "${file}" ""
		pattern --domain ${domain} --count ${count} ${arg_PATTERN_OPTIONS} -o "${file}")
	if(arg_TILE GREATER 1)
		_nook_make("${stem}_tile" "nook: tile of ${domain} ${count} (${arg_NAME}, ${method})" "${stem}_tile.json" "${file}"
			tile --pattern "${file}" --size ${arg_TILE} ${arg_TILE_OPTIONS} -o "${stem}_tile.json")
		set(file "${stem}_tile.json")
	endif()
	set(${result} "${file}" PARENT_SCOPE)
endfunction()
