# SPDX-License-Identifier: GPL-3.0-or-later
# cmake -DINPUT=FILE -DNAME=identifier -DOUTPUT=FILE.h -P NookEmbed.cmake
# Writes a C++ header with the text as a zero-terminated character array.
file(READ "${INPUT}" content HEX)
get_filename_component(file "${INPUT}" NAME)
string(TOUPPER "${NAME}_EMBEDDED_H" guard)
# Writes character codes: compilers limit the length of string literals, MSVC to 65535 characters.
string(REGEX REPLACE "([0-9a-f][0-9a-f])" "'\\\\x\\1'," content "${content}")
string(REGEX REPLACE "(('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',)('.x[0-9a-f][0-9a-f]',))" "\\1\n" content "${content}")
file(WRITE "${OUTPUT}" "// ${file} as an array; not to be edited.\n// SPDX-License-Identifier: MIT\n#ifndef ${guard}\n#define ${guard}\n\ninline constexpr char ${NAME}[] = {\n${content}'\\0'};\n\n#endif // ${guard}\n")
