# SPDX-License-Identifier: GPL-3.0-or-later
# nook_twin(KERNEL CONSTANTS FOLDER): converts a kernel (kernels/NAME.glsl) to C++ in FOLDER/NAME.h, line by line. Directives become
# statements, and the constants they test, listed in the header CONSTANTS, become members of the block.
function(nook_twin kernel constants folder)
	file(READ ${kernel} text)
	string(REGEX REPLACE "\n[ \t]*#if ([^\n]*)" "\nif (\\1) {" text "${text}")
	string(REGEX REPLACE "\n[ \t]*#elif ([^\n]*)" "\n} else if (\\1) {" text "${text}")
	string(REGEX REPLACE "\n[ \t]*#else" "\n} else {" text "${text}")
	string(REGEX REPLACE "\n[ \t]*#endif" "\n}" text "${text}")
	file(READ ${constants} list)
	string(REGEX MATCHALL "CONSTANT\\([a-z_]+" rows "${list}")
	foreach(row IN LISTS rows)
		string(REPLACE "CONSTANT(" "" name ${row})
		string(TOUPPER NOOK_${name} constant)
		string(REGEX REPLACE "${constant}([^A-Z_])" "nook.${name}\\1" text "${text}")
	endforeach()
	get_filename_component(stem ${kernel} NAME_WE)
	file(CONFIGURE OUTPUT ${folder}/${stem}.h CONTENT "${text}" @ONLY)
endfunction()

# nook_own_members(HEADER KERNEL...): what the heads of kernels declare, a line "//   float NAME: MEANING" each, as the rows of
# NOOK_OWN_MEMBERS(MEMBER) in HEADER.
function(nook_own_members header)
	set(rows "#define NOOK_OWN_MEMBERS(MEMBER)")
	foreach(kernel IN LISTS ARGN)
		file(STRINGS ${kernel} lines REGEX "^//   float [a-z0-9_]+: ")
		foreach(line IN LISTS lines)
			string(REGEX REPLACE "^//   float ([a-z0-9_]+): (.*)$" " \\\\\n\tMEMBER(float, \\1, \"\\2\")" row "${line}")
			string(APPEND rows "${row}")
		endforeach()
	endforeach()
	file(CONFIGURE OUTPUT ${header} CONTENT "${rows}\n" @ONLY)
endfunction()
