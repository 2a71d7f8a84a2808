// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer_depth.h"

#include "core/error.h"
#include "core/round.h"
#include "core/text.h"

#include <glm/geometric.hpp>

#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Half a step of an integer depth buffer; 0 for floats. A 16- or 24-bit buffer holds multiples of 1/(2ᵇ − 1), rounded to the file's
// floats; at 24 bits all floats above ½ are such multiples, and half a step is their own rounding.
double halfStepOf(const Image& image, int channel)
{
	for (const double greatest : {65535.0, 16777215.0})
	{
		bool whole = true;
		for (std::size_t i = 0; whole && i < image.values.size() / image.channels.size(); ++i)
		{
			const double steps = static_cast<double>(image.at(i, channel)) * greatest;
			whole = std::fabs(steps - std::floor(steps + 0.5)) <= steps * kUnitRoundoff;
		}
		if (whole)
		{
			return 0.5 / greatest;
		}
	}
	return 0.0;
}

} // namespace

std::string shortText(double value)
{
	if (!std::isfinite(value))
	{
		return std::isnan(value) ? "NaN" : value > 0.0 ? "infinity" : "-infinity";
	}
	return roundedText(value, 6);
}

void GBufferFile::refuse(const std::string& element, const std::string& found, const std::string& expected) const
{
	throw Error(ExitCode::invalid_input, path + ": " + element + ": found " + found + ", expected " + expected);
}

void GBufferFile::refusePixel(const std::string& channel, std::size_t pixel, const std::string& found,
							  const std::string& expected) const
{
	const auto width = static_cast<std::size_t>(image.width_px);
	refuse(channel + ", pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width), found, expected);
}

double metresOf(const GBufferFile& file, int channel, std::size_t pixel, double sky_depth_m)
{
	const auto value = static_cast<double>(file.image.at(pixel, channel));
	if (!(value > 0.0))
	{
		file.refusePixel(file.channelName(channel), pixel, shortText(value),
						 "metres in front of the camera, above 0, or infinity for sky");
	}
	return value >= sky_depth_m ? kInfinity : value;
}

DepthReader::DepthReader(const GBufferFile& file, const GBufferImport& import, int channel, const Projector& projector)
	: m_file(file), m_import(import), m_channel(channel), m_error_channel(file.image.channel("depth_error")), m_projector(projector)
{
	const std::vector<uint8_t>& halves = file.image.halves;
	m_rounding = !halves.empty() && halves[static_cast<std::size_t>(channel)] != 0 ? kHalfRoundoff : kUnitRoundoff;
	if (import.depth == DepthKind::device)
	{
		const ViewLine centre = lineAt(file.image.values.size() / file.image.channels.size() / 2);
		const double at0 = projector.depthOfDevice(ndc(0.0), centre);
		const double at1 = projector.depthOfDevice(ndc(1.0), centre);
		// A depth below 0 lies beyond infinity: infinite projections with a slightly moved far plane.
		m_far_device = at1 < 0.0 || (at0 >= 0.0 && at1 > at0) ? 1.0 : 0.0;
		m_half_step = halfStepOf(file.image, channel);
	}
}

float DepthReader::depthOf(std::size_t pixel) const
{
	const auto depth = static_cast<float>(alongView(pixel));
	if (!(depth > 0.0F)) // a distance that becomes 0 along this line
	{
		m_file.refusePixel(m_file.channelName(m_channel), pixel, shortText(static_cast<double>(m_file.image.at(pixel, m_channel))),
						   "a depth along the view direction that 32 bits hold, above 0");
	}
	return depth;
}

double DepthReader::alongView(std::size_t pixel) const
{
	if (m_import.depth == DepthKind::device)
	{
		return fromDevice(pixel);
	}
	const double metres = metresOf(m_file, m_channel, pixel, m_import.sky_depth_m);
	return m_import.depth == DepthKind::distance ? metres / glm::length(lineAt(pixel).along) : metres;
}

bool DepthReader::hasErrors() const
{
	return m_error_channel >= 0 || m_import.depth == DepthKind::device || m_rounding > kUnitRoundoff;
}

float DepthReader::errorOf(std::size_t pixel, float depth_m) const
{
	if (m_error_channel >= 0)
	{
		const float error_m = m_file.image.at(pixel, m_error_channel);
		if (!(error_m >= 0.0F && std::isfinite(error_m)))
		{
			m_file.refusePixel("channel depth_error", pixel, shortText(static_cast<double>(error_m)),
							   "metres by which the depth may be off, from 0");
		}
		return error_m;
	}
	const auto depth = static_cast<double>(depth_m);
	if (m_import.depth != DepthKind::device)
	{
		return static_cast<float>(depth * m_rounding);
	}
	// Rounding of the file, of the buffer, and of the interpolation in 32 bits.
	const auto value = static_cast<double>(m_file.image.at(pixel, m_channel));
	const double error = value * (m_rounding + kUnitRoundoff) + m_half_step;
	const double nearer = m_projector.depthOfDevice(ndc(m_far_device > 0.5 ? value - error : value + error), lineAt(pixel));
	const double too_great = nearer > 0.0 && nearer < depth ? depth - nearer : 0.0;
	return static_cast<float>(too_great + depth * kUnitRoundoff); // `depth_m` is rounded too
}

double DepthReader::ndc(double device) const
{
	return m_import.clip == ClipRange::zero_to_one ? device : 2.0 * device - 1.0;
}

ViewLine DepthReader::lineAt(std::size_t pixel) const
{
	const auto width = static_cast<std::size_t>(m_file.image.width_px);
	return m_projector.lineOf({static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5});
}

double DepthReader::fromDevice(std::size_t pixel) const
{
	const auto value = static_cast<double>(m_file.image.at(pixel, m_channel));
	if (!(value >= 0.0 && value <= 1.0))
	{
		m_file.refusePixel(m_file.channelName(m_channel), pixel, shortText(value), "device depth from 0 to 1");
	}
	if (value == m_far_device)
	{
		return kInfinity;
	}
	const double depth = m_projector.depthOfDevice(ndc(value), lineAt(pixel));
	if (!(depth > 0.0))
	{
		m_file.refusePixel(m_file.channelName(m_channel), pixel,
						   shortText(value) + ", which is behind the camera of this projection",
						   "device depth of the projection and the clip range given (clip)");
	}
	return depth >= m_import.sky_depth_m ? kInfinity : depth;
}

} // namespace nook
