// SPDX-License-Identifier: GPL-3.0-or-later
// The depth channel of a G-buffer's file → metres along the view direction, and by how much they may be off.
#pragma once

#include "core/image.h"
#include "scene/gbuffer.h"

#include <cstddef>
#include <string>

namespace nook
{

// A file that is being read, and errors about it.
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

// For errors: six digits, or the name of what is not finite.
std::string shortText(double value);

// A length of the file, +inf for sky. Throws as readGBuffer.
double metresOf(const GBufferFile& file, int channel, std::size_t pixel, double sky_depth_m);

// Keeps references to all its arguments.
class DepthReader
{
public:
	DepthReader(const GBufferFile& file, const GBufferImport& import, int channel, const Projector& projector);

	// Metres along the view direction, +inf for sky. Throws as readGBuffer.
	float depthOf(std::size_t pixel) const;

	// Whether depths may be off by more than their rounding to 32 bits.
	bool hasErrors() const;

	// Metres by which the depth of a pixel with a surface may be too great. Throws as readGBuffer.
	float errorOf(std::size_t pixel, float depth_m) const;

private:
	double ndc(double device) const;
	ViewLine lineAt(std::size_t pixel) const;
	double alongView(std::size_t pixel) const; // metres, before they are rounded to 32 bits
	double fromDevice(std::size_t pixel) const;

	const GBufferFile& m_file;
	const GBufferImport& m_import;
	int m_channel;
	int m_error_channel; // −1: none
	const Projector& m_projector;
	double m_rounding = 0.0;  // of the file's numbers, as a share of them
	double m_half_step = 0.0; // of device depth
	double m_far_device = 1.0;
};

} // namespace nook
