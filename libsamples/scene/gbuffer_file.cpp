// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer.h"

#include "core/error.h"
#include "scene/gbuffer_channels.h"

#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ImageMatrix imageMatrix(const std::string& key, const glm::dmat4& m, bool wide)
{
	ImageMatrix matrix{key, {}, wide};
	for (int i = 0; i < 16; ++i)
	{
		matrix.values[static_cast<std::size_t>(i)] = m[i / 4][i % 4];
	}
	return matrix;
}

glm::dmat4 matrixOf(const ImageMatrix& matrix)
{
	glm::dmat4 m;
	for (int i = 0; i < 16; ++i)
	{
		m[i / 4][i % 4] = matrix.values[static_cast<std::size_t>(i)];
	}
	return m;
}

std::string numberText(double value)
{
	if (!std::isfinite(value))
	{
		return std::isnan(value) ? "NaN" : value > 0.0 ? "infinity" : "-infinity";
	}
	char text[32];
	std::snprintf(text, sizeof text, "%.6g", value);
	return text;
}

// Errors about one file.
struct Reader
{
	const std::string& path;
	const Image& image;

	[[noreturn]] void refuse(const std::string& element, const std::string& found, const std::string& expected) const
	{
		throw Error(ExitCode::invalid_input, path + ": " + element + ": found " + found + ", expected " + expected);
	}

	[[noreturn]] void refusePixel(const std::string& channel, std::size_t pixel, const std::string& found,
								  const std::string& expected) const
	{
		const auto width = static_cast<std::size_t>(image.width_px);
		refuse(channel + ", pixel " + std::to_string(pixel % width) + "," + std::to_string(pixel / width), found, expected);
	}

	std::string channelName(int index) const
	{
		return "channel " + image.channels[static_cast<std::size_t>(index)];
	}
};

Image readWhole(const std::string& path)
{
	Image image = readImage(path);
	if (image.cropped)
	{
		throw Error(ExitCode::invalid_input,
					path + ": data window: found another one than the display window, expected the whole picture and no more");
	}
	return image;
}

// The matrix given, else the one of the file, in 64 bits where it has them.
struct FoundMatrix
{
	glm::dmat4 matrix{1.0};
	bool narrow = false; // 32 bits
};

FoundMatrix findMatrix(const Reader& reader, const std::string& key, const std::string& option,
					   const std::optional<glm::dmat4>& given)
{
	if (given)
	{
		return {*given, false};
	}
	if (const ImageMatrix* const wide = reader.image.matrix(key + "64"))
	{
		return {matrixOf(*wide), false};
	}
	if (const ImageMatrix* const matrix = reader.image.matrix(key))
	{
		return {matrixOf(*matrix), !matrix->wide};
	}
	reader.refuse(key, "none", "a 4x4 matrix of that name in the file, or " + option);
}

// World → view has to be a motion: lengths are metres on both sides, and both are right-handed.
void checkRigid(const Reader& reader, const glm::dmat4& m)
{
	const glm::dmat3 turn(m);
	const glm::dmat3 square = glm::transpose(turn) * turn;
	double off = std::fabs(m[0][3]) + std::fabs(m[1][3]) + std::fabs(m[2][3]) + std::fabs(m[3][3] - 1.0);
	for (int i = 0; i < 9; ++i)
	{
		off = std::max(off, std::fabs(square[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)));
	}
	const bool finite = std::isfinite(glm::dot(m[3], m[3]));
	// 1e-3: matrices that went through half floats pass, a scale of a per cent does not.
	if (!finite || !(off < 1e-3) || glm::determinant(turn) < 0.0)
	{
		reader.refuse(
			"worldToCamera", finite && off < 1e-3 ? "a mirrored matrix" : "one that is no rotation with a translation",
			"a motion in metres, column by column, into a right-handed view space that looks down -z (--world-to-camera)");
	}
}

// How far 32-bit entries move a position: |R'ᵀ(p − t') − Rᵀ(p − t)| ≤ ‖ΔR‖ |t − p| + |Δt|, with half a unit of the last place,
// 2⁻²⁵, for each of R's nine entries and 2⁻²⁵ of its size, at most twice over, for t. The share of |p| is that of depth in 32 bits
// itself.
double viewError(const FoundMatrix& found)
{
	return found.narrow ? 2.5 * 0x1p-24 * glm::length(glm::dvec3(found.matrix[3])) : 0.0;
}

Projector projectorFor(const Reader& reader, const glm::dmat4& projection)
{
	try
	{
		return {projection, reader.image.width_px, reader.image.height_px};
	}
	catch (const Error& error)
	{
		throw Error(error.code(), reader.path + ": " + error.what());
	}
}

// A length of the file, +inf for sky.
double metresOf(const Reader& reader, int channel, std::size_t pixel, double sky_depth_m)
{
	const auto value = static_cast<double>(reader.image.at(pixel, channel));
	if (!(value > 0.0))
	{
		reader.refusePixel(reader.channelName(channel), pixel, numberText(value),
						   "metres in front of the camera, above 0, or infinity for sky");
	}
	return value >= sky_depth_m ? kInfinity : value;
}

// A value of the file → metres along the view direction, +inf for sky.
class DepthReader
{
public:
	DepthReader(const Reader& reader, const GBufferImport& import, int channel, const Projector& projector)
		: m_reader(reader), m_import(import), m_channel(channel), m_projector(projector)
	{
		if (import.depth == DepthKind::device)
		{
			const ViewLine centre = lineAt(reader.image.values.size() / reader.image.channels.size() / 2);
			const double at0 = projector.depthOfDevice(ndc(0.0), centre);
			const double at1 = projector.depthOfDevice(ndc(1.0), centre);
			// A depth below 0 lies beyond infinity: infinite projections whose far plane was moved a little.
			m_far_device = at1 < 0.0 || (at0 >= 0.0 && at1 > at0) ? 1.0 : 0.0;
		}
	}

	float depthOf(std::size_t pixel) const
	{
		if (m_import.depth == DepthKind::device)
		{
			return static_cast<float>(fromDevice(pixel));
		}
		const double metres = metresOf(m_reader, m_channel, pixel, m_import.sky_depth_m);
		return static_cast<float>(m_import.depth == DepthKind::distance ? metres / glm::length(lineAt(pixel).along) : metres);
	}

private:
	double ndc(double device) const
	{
		return m_import.clip == ClipRange::zero_to_one ? device : 2.0 * device - 1.0;
	}

	ViewLine lineAt(std::size_t pixel) const
	{
		const auto width = static_cast<std::size_t>(m_reader.image.width_px);
		return m_projector.lineOf({static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5});
	}

	double fromDevice(std::size_t pixel) const
	{
		const auto value = static_cast<double>(m_reader.image.at(pixel, m_channel));
		if (!(value >= 0.0 && value <= 1.0))
		{
			m_reader.refusePixel(m_reader.channelName(m_channel), pixel, numberText(value), "device depth from 0 to 1");
		}
		if (value == m_far_device)
		{
			return kInfinity;
		}
		const double depth = m_projector.depthOfDevice(ndc(value), lineAt(pixel));
		if (!(depth > 0.0))
		{
			m_reader.refusePixel(m_reader.channelName(m_channel), pixel,
								 numberText(value) + ", which is behind the camera of this projection",
								 "device depth of the projection and the clip range given (--clip)");
		}
		return depth >= m_import.sky_depth_m ? kInfinity : depth;
	}

	const Reader& m_reader;
	const GBufferImport& m_import;
	int m_channel;
	const Projector& m_projector;
	double m_far_device = 1.0;
};

glm::vec3 toUnit(const glm::dvec3& n)
{
	return glm::vec3(glm::normalize(n));
}

// Normals of the file, in view space and of length 1.
void readNormals(GBuffer& gbuffer, const Reader& reader, const GBufferImport& import, const Projector& projector)
{
	const NormalChannels channels = normalChannels(reader.image, reader.path, import.normal_channels);
	const glm::dmat3 turn(gbuffer.view.camera_from_world);
	std::size_t seen = 0;
	std::size_t averted = 0;
	gbuffer.normals.assign(gbuffer.depth.size(), glm::vec3(0.0F));
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		if (std::isinf(gbuffer.depth[i]))
		{
			continue;
		}
		glm::dvec3 n(reader.image.at(i, channels.x), reader.image.at(i, channels.y), reader.image.at(i, channels.z));
		if (import.normal_range == NormalRange::zero_to_one)
		{
			n = 2.0 * n - glm::dvec3(1.0);
		}
		const double length = glm::length(n);
		// Interpolated normals shorten where vertices disagree, by half at 120°; anything beyond is no normal in this encoding.
		if (!(length > 0.5 && length < 1.5))
		{
			reader.refusePixel("normals " + channels.name, i, "a length of " + numberText(length),
							   "1 (--normal-range zero-to-one where 0 to 1 stands for -1 to 1)");
		}
		n = import.normal_space == NormalSpace::world ? turn * n : n;
		gbuffer.normals[i] = toUnit(n);
		const auto width = static_cast<std::size_t>(gbuffer.width_px);
		const ViewLine line = projector.lineOf({static_cast<double>(i % width) + 0.5, static_cast<double>(i / width) + 0.5});
		seen += 1;
		averted += glm::dot(n, line.along) > 0.0 ? 1U : 0U;
	}
	if (2 * averted > seen)
	{
		reader.refuse("normals " + channels.name, std::to_string(100 * averted / seen) + " % of them turned away from the camera",
					  "normals of what the camera sees, in view space with +z towards the camera (or --normal-space world)");
	}
}

} // namespace

std::string gbufferBytes(const GBuffer& gbuffer, const Notes& notes)
{
	Image image;
	image.width_px = gbuffer.width_px;
	image.height_px = gbuffer.height_px;
	image.notes = notes;
	const bool normals = !gbuffer.normals.empty();
	image.channels = normals ? std::vector<std::string>{"N.X", "N.Y", "N.Z", "Z"} : std::vector<std::string>{"Z"};
	image.values.reserve(gbuffer.depth.size() * image.channels.size());
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		if (normals)
		{
			const glm::vec3& n = gbuffer.normals[i];
			image.values.insert(image.values.end(), {n.x, n.y, n.z});
		}
		image.values.push_back(gbuffer.depth[i]);
	}
	const View& view = gbuffer.view;
	image.matrices = {imageMatrix("worldToCamera", view.camera_from_world, false),
					  imageMatrix("worldToNDC", view.projection * view.camera_from_world, false),
					  imageMatrix("projection", view.projection, false),
					  imageMatrix("worldToCamera64", view.camera_from_world, true),
					  imageMatrix("projection64", view.projection, true)};
	return exrBytes(image);
}

GBuffer readGBuffer(const std::string& path, const GBufferImport& import)
{
	const Image image = readWhole(path);
	const Reader reader{path, image};
	const int channel = depthChannel(image, path, import.depth_channel);
	const FoundMatrix projection = findMatrix(reader, "projection", "--projection", import.projection);
	const FoundMatrix view = findMatrix(reader, "worldToCamera", "--world-to-camera", import.camera_from_world);
	checkRigid(reader, view.matrix);
	const Projector projector = projectorFor(reader, projection.matrix);
	GBuffer gbuffer;
	gbuffer.width_px = image.width_px;
	gbuffer.height_px = image.height_px;
	gbuffer.view = {view.matrix, projection.matrix};
	gbuffer.view_error_m = viewError(view);
	gbuffer.depth.resize(image.values.size() / image.channels.size());
	const DepthReader depth(reader, import, channel, projector);
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		gbuffer.depth[i] = depth.depthOf(i);
	}
	if (import.normals_from_depth)
	{
		normalsFromDepth(gbuffer);
	}
	else
	{
		readNormals(gbuffer, reader, import, projector);
	}
	return gbuffer;
}

SurfaceMask readSurfaceMask(const std::string& path)
{
	const Image image = readWhole(path);
	const Reader reader{path, image};
	const int channel = depthChannel(image, path, "");
	SurfaceMask mask{image.width_px, image.height_px, {}};
	mask.surface.resize(image.values.size() / image.channels.size());
	for (std::size_t i = 0; i < mask.surface.size(); ++i)
	{
		mask.surface[i] = std::isinf(metresOf(reader, channel, i, GBufferImport().sky_depth_m)) ? 0 : 1;
	}
	return mask;
}

} // namespace nook
