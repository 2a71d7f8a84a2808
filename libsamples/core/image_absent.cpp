// SPDX-License-Identifier: GPL-3.0-or-later
// Used if the component levels is not built: no library for writing pictures.
#include "core/error.h"
#include "core/image.h"

namespace nook
{
namespace
{

[[noreturn]] void refusePicture(const char* format)
{
	throw Error(ExitCode::unsupported, std::string(format) + ": found a build without the component levels, expected one with it");
}

} // namespace

std::string exrBytes(Image /*image*/, const char* /*compression*/)
{
	refusePicture("EXR");
}

std::string pngBytes(int /*width_px*/, int /*height_px*/, std::span<const uint8_t> /*values*/, const Notes& /*notes*/)
{
	refusePicture("PNG");
}

std::string pngBytes(int /*width_px*/, int /*height_px*/, std::span<const uint16_t> /*rgba*/, const Notes& /*notes*/)
{
	refusePicture("PNG");
}

} // namespace nook
