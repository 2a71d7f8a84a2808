// SPDX-License-Identifier: GPL-3.0-or-later
// Converts the depth channel of a G-buffer's file to metres along the view direction, with error bounds.
#pragma once

#include "core/image.h"
#include "scene/gbuffer.h"

#include <cstddef>
#include <string>

namespace nook
{

// The file being read, and its errors.
struct GBufferFile
{
	const std::string& path;
	const Image& image;

	// Throw Error (invalid_input).
	[[noreturn]] void refuse(const std::string& element, const std::string& found, const std::string& expected) const;
	[[noreturn]] void refusePixel(const std::string& channel, std::size_t pixel, const std::string& found,
								  const std::string& expected) const;

	std::string channelName(int index) const
	{
		return "channel " + image.channels[static_cast<std::size_t>(index)];
	}
};

// For errors: six digits, or the name of a non-finite value.
std::string shortText(double value);

// Keeps references to all its arguments.
class DepthReader
{
public:
	DepthReader(const GBufferFile& file, const GBufferImport& import, int channel, const Projector& projector);

	// Metres along the view direction; +inf for sky. Throws like readGBuffer.
	float depthOf(std::size_t pixel) const;

	// True if depths may be off by more than their rounding to 32 bits.
	bool hasErrors() const;

	// Upper bound in metres by which a surface pixel's depth may be too large. Throws like readGBuffer.
	float errorOf(std::size_t pixel, float depth_m) const;

private:
	double ndc(double device) const;
	ViewLine lineAt(std::size_t pixel) const;
	double alongView(std::size_t pixel) const; // metres, before rounding to 32 bits
	double fromDevice(std::size_t pixel) const;

	const GBufferFile& m_file;
	const GBufferImport& m_import;
	int m_channel;
	int m_error_channel; // −1: none
	const Projector& m_projector;
	double m_rounding = 0.0;  // relative rounding of the file's numbers
	double m_half_step = 0.0; // for device depth
	double m_far_device = 1.0;
};

// True if a depth channel and normals can be recognised by name.
bool looksLikeGBuffer(const Image& image);

} // namespace nook
