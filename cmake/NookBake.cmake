# SPDX-License-Identifier: GPL-3.0-or-later
#[[
Bakes the visibility of a level while the project builds.

	nook_add_bake(TARGET LEVEL file|builtin:NAME RADIUS metres|inf OUTPUT variable [NAME name] [PROBES metres] [VOLUMES file]
		[OPTIONS ...])

TARGET   a target of this project; it is built after the files, and finds them by their names
LEVEL    what nook reads: .gltf .glb .obj .fbx .ply .stl, or builtin:NAME; a path from the current source folder
RADIUS   length of the rays, metres; inf: without end
OUTPUT   variable that receives the path of the file, NAME.bake.glb: the level with visibility at its vertices (a glTF as it is, with
         additions); with PROBES a list of two, NAME.probes.ktx2 and NAME.probes.glsl
NAME     the level's own where absent; two bakes of one kind for one target need names of their own
PROBES   spacing of a grid of probes, metres, in place of vertices
VOLUMES  a file of nook_add_volumes that is drawn as well: what is baked is the difference to it
OPTIONS  more options of `nook bake`: --rays 64, --bent, --to color, --texture 512, ...

The files are made again when the level, a file that it names, the volumes, the options or the program change, and not otherwise.
]]
function(nook_add_bake target)
	cmake_parse_arguments(PARSE_ARGV 1 arg "" "LEVEL;RADIUS;OUTPUT;NAME;PROBES;VOLUMES" "OPTIONS")
	if(arg_UNPARSED_ARGUMENTS)
		message(FATAL_ERROR "nook_add_bake: found '${arg_UNPARSED_ARGUMENTS}', expected LEVEL, RADIUS, OUTPUT, NAME, PROBES, VOLUMES or OPTIONS")
	endif()
	_nook_level_of(nook_add_bake level name)
	if(NOT arg_RADIUS STREQUAL "inf")
		_nook_check_length(nook_add_bake RADIUS "metres above 0, or inf")
	endif()
	set(ending bake.glb)
	set(probes "")
	if(DEFINED arg_PROBES)
		_nook_check_length(nook_add_bake PROBES "metres above 0")
		set(ending probes.ktx2)
		set(probes --probes ${arg_PROBES})
	endif()
	_nook_check_options(nook_add_bake "${arg_OPTIONS}" -o --depfile --radius --probes --volumes)
	_nook_folder(${target} folder)
	_nook_name_once(nook_add_bake ${target} NOOK_BAKES ${name}.${ending})
	set(file "${folder}/${name}.${ending}")
	set(files "${file}")
	if(probes)
		list(APPEND files "${folder}/${name}.probes.glsl")
	endif()
	set(outputs "")
	foreach(output IN LISTS files)
		list(APPEND outputs -o "${output}")
	endforeach()
	set(volumes "")
	set(read "")
	if(arg_VOLUMES)
		get_filename_component(read "${arg_VOLUMES}" ABSOLUTE)
		set(volumes --volumes "${read}")
	endif()
	_nook_level_inputs("${level}" "${file}.d" inputs ${read})
	_nook_make("${file}" "nook: bake of ${arg_LEVEL} (${name}.${ending})" "${files}" "${inputs}"
		bake "${level}" --radius ${arg_RADIUS} ${probes} ${volumes} ${arg_OPTIONS} ${outputs} --depfile "${file}.d")
	_nook_target(${target} bake "${name}.${ending}" "${files}" "${level};${read}")
	set(${arg_OUTPUT} "${files}" PARENT_SCOPE)
endfunction()
