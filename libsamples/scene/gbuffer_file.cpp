// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer.h"

#include "core/error.h"
#include "scene/gbuffer_channels.h"
#include "scene/gbuffer_depth.h"

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

Image readWhole(const std::string& path)
{
	Image image = readImage(path);
	if (image.cropped)
	{
		throw Error(ExitCode::invalid_input,
					path + ": data window: found one that differs from the display window, expected equal windows");
	}
	return image;
}

// Keeps only a rectangle.
void crop(Image& image, const std::string& path, const std::array<int, 4>& viewport)
{
	const auto [x, y, width, height] = viewport;
	if (x < 0 || y < 0 || width < 1 || height < 1 || x > image.width_px - width || y > image.height_px - height)
	{
		throw Error(ExitCode::invalid_input, path + ": found " + std::to_string(image.width_px) + " x " +
												 std::to_string(image.height_px) +
												 " pixels, expected all of the rectangle among them (viewport)");
	}
	const auto channels = static_cast<std::ptrdiff_t>(image.channels.size());
	std::vector<float> values;
	for (int row = y; row < y + height; ++row)
	{
		const auto first = image.values.begin() + (static_cast<std::ptrdiff_t>(row) * image.width_px + x) * channels;
		values.insert(values.end(), first, first + width * channels);
	}
	image.values = std::move(values);
	image.width_px = width;
	image.height_px = height;
}

// The given matrix, else the file's, with 64 bits if available.
struct FoundMatrix
{
	glm::dmat4 matrix{1.0};
	bool narrow = false; // 32 bits
};

FoundMatrix findMatrix(const GBufferFile& file, const std::string& key, const std::string& option,
					   const std::optional<glm::dmat4>& given)
{
	if (given)
	{
		return {*given, false};
	}
	if (const ImageMatrix* const wide = file.image.matrix(key + "64"))
	{
		return {matrixOf(*wide), false};
	}
	if (const ImageMatrix* const matrix = file.image.matrix(key))
	{
		return {matrixOf(*matrix), !matrix->wide};
	}
	file.refuse(key, "none", "a 4x4 matrix of that name in the file, or one that is given (" + option + ")");
}

// World → view must be rigid: both sides are in metres and right-handed.
void checkRigid(const GBufferFile& file, const glm::dmat4& m)
{
	const glm::dmat3 turn(m);
	const glm::dmat3 square = glm::transpose(turn) * turn;
	double off = std::fabs(m[0][3]) + std::fabs(m[1][3]) + std::fabs(m[2][3]) + std::fabs(m[3][3] - 1.0);
	for (int i = 0; i < 9; ++i)
	{
		off = std::max(off, std::fabs(square[i / 3][i % 3] - (i % 4 == 0 ? 1.0 : 0.0)));
	}
	const bool finite = std::isfinite(glm::dot(m[3], m[3]));
	// 1e-3 accepts matrices that went through half floats, but not a scale of a per cent.
	if (!finite || !(off < 1e-3) || glm::determinant(turn) < 0.0)
	{
		file.refuse("worldToCamera", finite && off < 1e-3 ? "a mirrored matrix" : "one that is not a rotation and a translation",
					"a motion in metres, column by column, into a right-handed view space that looks down -z (world-to-camera)");
	}
}

// Position error due to 32-bit entries: |R'ᵀ(p − t') − Rᵀ(p − t)| ≤ ‖ΔR‖ |t − p| + |Δt|, with half a unit in the last place, 2⁻²⁵,
// for each of R's nine entries and 2⁻²⁵ of its size, at most twice over, for t. The part proportional to |p| is that of 32-bit
// depth itself.
double viewError(const FoundMatrix& found)
{
	return found.narrow ? 2.5 * 0x1p-24 * glm::length(glm::dvec3(found.matrix[3])) : 0.0;
}

Projector projectorFor(const GBufferFile& file, const glm::dmat4& projection)
{
	try
	{
		return {projection, file.image.width_px, file.image.height_px};
	}
	catch (const Error& error)
	{
		throw Error(error.code(), file.path + ": " + error.what());
	}
}

glm::vec3 toUnit(const glm::dvec3& n)
{
	return glm::vec3(glm::normalize(n));
}

// Reads the file's normals into unit vectors in view space.
void readNormals(GBuffer& gbuffer, const GBufferFile& file, const GBufferImport& import, const Projector& projector)
{
	const NormalChannels channels = normalChannels(file.image, file.path, import.normal_channels);
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
		glm::dvec3 n(file.image.at(i, channels.x), file.image.at(i, channels.y), file.image.at(i, channels.z));
		if (import.normal_range == NormalRange::zero_to_one)
		{
			n = 2.0 * n - glm::dvec3(1.0);
		}
		const double length = glm::length(n);
		// Interpolated normals are shorter if vertices disagree, by half at 120°; anything beyond is no normal in this encoding.
		if (!(length > 0.5 && length < 1.5))
		{
			file.refusePixel("normals " + channels.name, i, "a length of " + shortText(length),
							 "1 (normal-range zero-to-one where 0 to 1 stands for -1 to 1)");
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
		file.refuse("normals " + channels.name, std::to_string(100 * averted / seen) + " % of them turned away from the camera",
					"normals of what the camera sees, in view space with +z towards the camera, or in world space (normal-space)");
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
	const bool errors = !gbuffer.depth_error_m.empty();
	if (errors)
	{
		image.channels.emplace_back("depth_error");
	}
	image.values.reserve(gbuffer.depth.size() * image.channels.size());
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		if (normals)
		{
			const glm::vec3& n = gbuffer.normals[i];
			image.values.insert(image.values.end(), {n.x, n.y, n.z});
		}
		image.values.push_back(gbuffer.depth[i]);
		if (errors)
		{
			image.values.push_back(gbuffer.depth_error_m[i]);
		}
	}
	const View& view = gbuffer.view;
	image.matrices = {imageMatrix("worldToCamera", view.camera_from_world, false),
					  imageMatrix("worldToNDC", view.projection * view.camera_from_world, false),
					  imageMatrix("projection", view.projection, false), imageMatrix("projection64", view.projection, true)};
	if (gbuffer.view_error_m == 0.0)
	{
		image.matrices.push_back(imageMatrix("worldToCamera64", view.camera_from_world, true));
	}
	return exrBytes(image);
}

GBuffer readGBuffer(const std::string& path, const GBufferImport& import)
{
	return gbufferFrom(readWhole(path), path, import);
}

GBuffer gbufferFrom(Image image, const std::string& path, const GBufferImport& import)
{
	if (import.viewport)
	{
		crop(image, path, *import.viewport);
	}
	const GBufferFile file{path, image};
	const int channel = depthChannel(image, path, import.depth_channel);
	const FoundMatrix projection = findMatrix(file, "projection", "projection", import.projection);
	const FoundMatrix view = findMatrix(file, "worldToCamera", "world-to-camera", import.camera_from_world);
	checkRigid(file, view.matrix);
	const Projector projector = projectorFor(file, projection.matrix);
	GBuffer gbuffer;
	gbuffer.width_px = image.width_px;
	gbuffer.height_px = image.height_px;
	gbuffer.view = {view.matrix, projection.matrix};
	gbuffer.view_error_m = viewError(view);
	gbuffer.depth.resize(image.values.size() / image.channels.size());
	const DepthReader depth(file, import, channel, projector);
	for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
	{
		gbuffer.depth[i] = depth.depthOf(i);
		if (depth.hasErrors())
		{
			gbuffer.depth_error_m.push_back(std::isfinite(gbuffer.depth[i]) ? depth.errorOf(i, gbuffer.depth[i]) : 0.0F);
		}
	}
	if (import.normals_from_depth)
	{
		normalsFromDepth(gbuffer);
	}
	else
	{
		readNormals(gbuffer, file, import, projector);
	}
	return gbuffer;
}

SurfaceMask readSurfaceMask(const std::string& path)
{
	const Image image = readWhole(path);
	const GBufferFile file{path, image};
	const int channel = depthChannel(image, path, "");
	SurfaceMask mask{image.width_px, image.height_px, {}};
	mask.surface.resize(image.values.size() / image.channels.size());
	for (std::size_t i = 0; i < mask.surface.size(); ++i)
	{
		mask.surface[i] = std::isinf(metresOf(file, channel, i, GBufferImport().sky_depth_m)) ? 0 : 1;
	}
	return mask;
}

} // namespace nook
