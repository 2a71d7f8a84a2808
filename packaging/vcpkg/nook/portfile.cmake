# SPDX-License-Identifier: GPL-3.0-or-later
# For an overlay: vcpkg install nook --overlay-ports=packaging/vcpkg. It builds the sources that this file lies in.
set(VCPKG_POLICY_EMPTY_INCLUDE_FOLDER enabled) # a tool; what is included is made by it
get_filename_component(SOURCE_PATH "${CMAKE_CURRENT_LIST_DIR}/../../.." ABSOLUTE)
vcpkg_cmake_configure(
	SOURCE_PATH "${SOURCE_PATH}"
	OPTIONS
		-DNOOK_COMPONENTS=patterns
		-DNOOK_BUILD_TESTS=OFF
		-DNOOK_BUILD_BENCHMARKS=OFF)
vcpkg_cmake_install()
vcpkg_copy_tools(TOOL_NAMES nook AUTO_CLEAN)
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/nook)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug")
vcpkg_install_copyright(FILE_LIST "${SOURCE_PATH}/LICENSE" "${SOURCE_PATH}/LICENSES/MIT.txt")
