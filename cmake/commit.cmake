# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DSOURCE=FOLDER -DOUTPUT=FILE.cpp -P commit.cmake
# Writes a source folder's commit to a C++ source, only if it changed, to avoid recompiling.
execute_process(COMMAND git -C ${SOURCE} rev-parse --short=12 HEAD
	OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET RESULT_VARIABLE failed)
if(failed OR commit STREQUAL "")
	set(commit "unknown") # not a repository, for example a source archive
endif()
set(text "#include \"program.h\"\n\nnamespace nook\n{\n\nconst char* const kCommit = \"${commit}\";\n\n} // namespace nook\n")
set(before "")
if(EXISTS ${OUTPUT})
	file(READ ${OUTPUT} before)
endif()
if(NOT before STREQUAL text)
	file(WRITE ${OUTPUT} "${text}")
endif()
