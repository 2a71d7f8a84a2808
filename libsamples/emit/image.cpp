// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/image.h"

#include "core/error.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <cassert>
#include <vector>

namespace nook
{
namespace
{

[[noreturn]] void fail(const std::string& reason)
{
	throw Error(ExitCode::runtime, "image: " + reason);
}

std::string encoded(const char* ending, OIIO::ImageSpec spec, const void* pixels, const Notes& notes)
{
	for (const Note& note : notes)
	{
		spec.attribute(note.key, note.value);
	}
	std::vector<unsigned char> bytes;
	OIIO::Filesystem::IOVecOutput memory(bytes);
	const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(ending, &memory);
	if (output == nullptr)
	{
		fail("found no writer for " + std::string(ending) + " files: " + OIIO::geterror());
	}
	if (!output->open(ending, spec) || !output->write_image(spec.format, pixels) || !output->close())
	{
		fail(output->geterror());
	}
	return {bytes.begin(), bytes.end()};
}

[[maybe_unused]] std::size_t valuesOf(int width_px, int height_px, int channels)
{
	return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * static_cast<std::size_t>(channels);
}

} // namespace

std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes)
{
	assert(rgb.size() == valuesOf(width_px, height_px, 3));
	OIIO::ImageSpec spec(width_px, height_px, 3, OIIO::TypeDesc::UINT8);
	spec.attribute("oiio:ColorSpace", "sRGB");
	return encoded("nook.png", std::move(spec), rgb.data(), notes);
}

std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::UINT16);
	spec.attribute("oiio:ColorSpace", "Linear");
	spec.attribute("oiio:UnassociatedAlpha", 1);
	return encoded("nook.png", std::move(spec), rgba.data(), notes);
}

std::string exrBytes(int width_px, int height_px, std::span<const float> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::FLOAT);
	spec.attribute("compression", "none");
	spec.attribute("oiio:ColorSpace", "Linear");
	spec.attribute("DateTime", ""); // else the library writes the time of day
	return encoded("nook.exr", std::move(spec), rgba.data(), notes);
}

} // namespace nook
