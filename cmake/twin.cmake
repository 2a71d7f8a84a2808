# SPDX-License-Identifier: GPL-3.0-or-later
# nook_twin(KERNEL CONSTANTS FOLDER): a kernel's text (kernels/NAME.glsl) → FOLDER/NAME.h for C++, line by line. Directives become
# statements, and the constants they ask for, listed in the header CONSTANTS, members of the block.
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
