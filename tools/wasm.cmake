# SPDX-License-Identifier: GPL-3.0-or-later
# The program as WebAssembly, twice around the same code: nook.js runs in Node.js on the machine's files; nook_module.mjs is a module
# with a file system in memory, for Node.js and browsers (npm/).
set(common -O2 # of the link: -O3 takes 1.7 times as long for as fast a program and 1 % more bytes
	-sEXIT_RUNTIME=1 -sALLOW_MEMORY_GROWTH=1 -sTOTAL_STACK=1MB -sINITIAL_MEMORY=16MB)
target_link_options(nook PRIVATE ${common} -sEXPORTED_RUNTIME_METHODS=callMain -sNODERAWFS=1 -sENVIRONMENT=node)
add_executable(nook_module main.cpp)
target_link_libraries(nook_module PRIVATE nook_verbs nook_flags)
nook_plain(nook_module -O1) # as nook: else the bytes of both differ
target_link_options(nook_module PRIVATE ${common} -sFORCE_FILESYSTEM=1 -sENVIRONMENT=web -sMODULARIZE=1 -sEXPORT_ES6=1 -sINVOKE_RUN=0
	-sUSE_ES6_IMPORT_META=0 -sEXPORTED_RUNTIME_METHODS=callMain,FS)
set_target_properties(nook_module PROPERTIES SUFFIX .mjs)

# The folder of the npm package; `npm pack` makes one file of it.
configure_file(${PROJECT_SOURCE_DIR}/npm/package.json.in ${PROJECT_BINARY_DIR}/npm/package.json @ONLY)
foreach(name IN ITEMS .attw.json README.md browser.js calls.js cli.cjs index.d.ts index.js node_worker.js nook_wasm.d.ts nook_worker.d.ts
		nook_worker.js)
	configure_file(${PROJECT_SOURCE_DIR}/npm/${name} ${PROJECT_BINARY_DIR}/npm/${name} COPYONLY)
endforeach()
configure_file(${PROJECT_SOURCE_DIR}/LICENSE ${PROJECT_BINARY_DIR}/npm/LICENSE COPYONLY)
configure_file(${PROJECT_SOURCE_DIR}/LICENSES/MIT.txt ${PROJECT_BINARY_DIR}/npm/MIT.txt COPYONLY)
# Both links make the same bytes of WebAssembly.
add_custom_target(nook_npm ALL
	COMMAND ${CMAKE_COMMAND} -E compare_files nook.wasm nook_module.wasm
	COMMAND ${CMAKE_COMMAND} -E copy nook.js ${PROJECT_BINARY_DIR}/npm/nook.cjs
	COMMAND ${CMAKE_COMMAND} -E copy nook.wasm ${PROJECT_BINARY_DIR}/npm/nook.wasm
	COMMAND ${CMAKE_COMMAND} -E copy nook_module.mjs ${PROJECT_BINARY_DIR}/npm/nook_module.js
	DEPENDS nook nook_module
	WORKING_DIRECTORY ${CMAKE_CURRENT_BINARY_DIR}
	COMMENT "npm package" VERBATIM)
