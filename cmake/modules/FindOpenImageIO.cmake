# SPDX-License-Identifier: GPL-3.0-or-later
# Defines OpenImageIO::OpenImageIO from the header and the libraries alone. Debian 12's own package configuration also requires
# OpenCV's headers, the command line tools and Imath's Python binding, none of which is needed to read and write images.
find_path(OpenImageIO_INCLUDE_DIR OpenImageIO/imageio.h)
find_library(OpenImageIO_LIBRARY OpenImageIO)
find_library(OpenImageIO_Util_LIBRARY OpenImageIO_Util)
find_path(OpenImageIO_Imath_INCLUDE_DIR Imath/half.h)
mark_as_advanced(OpenImageIO_INCLUDE_DIR OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY OpenImageIO_Imath_INCLUDE_DIR)

if(OpenImageIO_INCLUDE_DIR)
	file(STRINGS ${OpenImageIO_INCLUDE_DIR}/OpenImageIO/oiioversion.h OpenImageIO_VERSION_LINES
		REGEX "^#define OIIO_VERSION_(MAJOR|MINOR|PATCH) +[0-9]+")
	string(REGEX REPLACE "[^;]*(MAJOR|MINOR|PATCH) +([0-9]+)[^;]*" "\\2" OpenImageIO_VERSION "${OpenImageIO_VERSION_LINES}")
	string(REPLACE ";" "." OpenImageIO_VERSION "${OpenImageIO_VERSION}")
endif()

include(FindPackageHandleStandardArgs)
find_package_handle_standard_args(OpenImageIO
	REQUIRED_VARS OpenImageIO_LIBRARY OpenImageIO_Util_LIBRARY OpenImageIO_INCLUDE_DIR OpenImageIO_Imath_INCLUDE_DIR
	VERSION_VAR OpenImageIO_VERSION)

if(OpenImageIO_FOUND AND NOT TARGET OpenImageIO::OpenImageIO)
	add_library(OpenImageIO::OpenImageIO UNKNOWN IMPORTED)
	set_target_properties(OpenImageIO::OpenImageIO PROPERTIES
		IMPORTED_LOCATION "${OpenImageIO_LIBRARY}"
		INTERFACE_INCLUDE_DIRECTORIES "${OpenImageIO_INCLUDE_DIR};${OpenImageIO_Imath_INCLUDE_DIR}"
		INTERFACE_LINK_LIBRARIES "${OpenImageIO_Util_LIBRARY}")
endif()
