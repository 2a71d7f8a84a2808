# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DSOURCE=FOLDER -DOUTPUT=FILE.cpp -P commit.cmake
# The commit of a source folder → a C++ source; written only where it changes, so that nothing else is compiled again.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
	OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR commit STREQUAL "")
	set(commit "unknown") # no repository: an archive of the sources, say
endif()
set(text "#include \"commit.h\"\n\nnamespace nook\n{\n\nconst char* const kCommit = \"${commit}\";\n\n} // namespace nook\n")
set(before "")
if(EXISTS ${OUTPUT})
	file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
	file(WRITE ${OUTPUT} "${text}")
endif()
