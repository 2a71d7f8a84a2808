// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer.h"

#include "core/lists.h"
#include "core/round.h"
#include "core/text.h"
#include "core/words.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace nook
{
namespace
{

// The file being read, and its errors.
struct GBufferFile
{
	const std::string& path;
	const Image& image;

	// Throw Error (invalid_input).
	[[noreturn]] void refuse(const std::string& element, const std::string& found, const std::string& expected) const
	{
		refuseInput(path + ": " + element, found, expected);
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

// For errors: six digits, or the name of a non-finite value.
std::string shortText(double value)
{
	return std::isfinite(value) ? roundedText(value, 6) : std::isnan(value) ? "NaN" : value > 0.0 ? "infinity" : "-infinity";
}

ImageMatrix imageMatrix(const std::string& key, const glm::dmat4& m, bool wide)
{
	ImageMatrix matrix{key, {}, wide};
	std::copy_n(glm::value_ptr(m), matrix.values.size(), matrix.values.begin());
	return matrix;
}

glm::dmat4 matrixOf(const ImageMatrix& matrix)
{
	return glm::make_mat4(matrix.values.data());
}

Image readWhole(const std::string& path)
{
	Image image = readImage(path);
	refuseInputIf(image.cropped, path + ": data window", "one that differs from the display window", "equal windows");
	return image;
}

// Keeps only a rectangle.
void crop(Image& image, const std::string& path, const std::array<int, 4>& viewport)
{
	const auto [x, y, width, height] = viewport;
	refuseInputIf(x < 0 || y < 0 || width < 1 || height < 1 || x > image.width_px - width || y > image.height_px - height, path,
				  std::to_string(image.width_px) + " x " + std::to_string(image.height_px) + " pixels",
				  "all of the rectangle among them (viewport)");
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
	refuseInputIf(!finite || !(off < 1e-3) || glm::determinant(turn) < 0.0, file.path + ": worldToCamera",
				  finite && off < 1e-3 ? "a mirrored matrix" : "one that is not a rotation and a translation",
				  "a motion in metres, column by column, into a right-handed view space that looks down -z (world-to-camera)");
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

// Three channels of one layer.
struct NormalChannels
{
	std::string name; // "N", "ViewLayer.Normal"
	int x = -1;
	int y = -1;
	int z = -1;
};

// "ViewLayer.Depth.Z": layer "ViewLayer.Depth", last part "z"; the layer's own last part is "depth". Both in lower case.
struct Name
{
	std::string layer; // as written
	std::string last;
	std::string before;
};

Name partsOf(const std::string& channel)
{
	const std::size_t dot = channel.rfind('.');
	if (dot == std::string::npos)
	{
		return {"", lowered(channel), ""};
	}
	const std::string layer = channel.substr(0, dot);
	const std::size_t earlier = layer.rfind('.');
	return {layer, lowered(channel.substr(dot + 1)), lowered(earlier == std::string::npos ? layer : layer.substr(earlier + 1))};
}

void refuseChannelsIf(bool condition, const Image& image, const std::string& path, const std::string& expected)
{
	refuseInputIf(condition, path + ": channels", joinedText(image.channels, ", "), expected);
}

std::optional<NormalChannels> vectorOf(const Image& image, const std::string& layer)
{
	for (const std::string axes : {"XYZ", "RGB"})
	{
		const auto indexOf = [&](std::size_t i) // in either case
		{
			const std::string prefix = layer.empty() ? "" : layer + ".";
			return std::max(image.channel(prefix + axes[i]), image.channel(prefix + lowered(axes.substr(i, 1))));
		};
		const NormalChannels found{layer, indexOf(0), indexOf(1), indexOf(2)};
		if (found.x >= 0 && found.y >= 0 && found.z >= 0)
		{
			return found;
		}
	}
	return std::nullopt;
}

// 1: depth by name; 2: a Z that is not part of a vector; 0: anything else.
int depthRank(const Image& image, const std::string& channel)
{
	const Name name = partsOf(channel);
	const bool scalar = name.last == "z" || name.last == "v" || name.last == "y" || name.last == "r";
	const bool named = name.last == "depth" || (name.before == "depth" && scalar);
	return named ? 1 : name.last == "z" && !vectorOf(image, name.layer) ? 2 : 0;
}

// The index of the only channel with that rank; −1: none, −2: several.
int onlyOfRank(const Image& image, int rank)
{
	int found = -1;
	for (std::size_t i = 0; i < image.channels.size(); ++i)
	{
		if (depthRank(image, image.channels[i]) == rank)
		{
			found = found == -1 ? static_cast<int>(i) : -2;
		}
	}
	return found;
}

// −1: none, −2: several.
int depthByName(const Image& image)
{
	const int z = image.channel("Z");
	const int called = onlyOfRank(image, 1);
	return z >= 0 ? z : called != -1 ? called : onlyOfRank(image, 2);
}

// Every layer that may hold normals, without duplicates.
std::vector<NormalChannels> normalLayers(const Image& image)
{
	std::vector<NormalChannels> layers;
	for (const std::string& channel : image.channels)
	{
		const Name name = partsOf(channel);
		const bool called = name.before == "n" || name.before == "normal" || name.before == "normals";
		const bool first = name.last == "x" || name.last == "r";
		if (const std::optional<NormalChannels> found = vectorOf(image, name.layer); called && first && found)
		{
			layers.push_back(*found);
		}
	}
	return layers;
}

// The layer `wanted`; if that is empty: N, else the only one whose last name part is n, normal or normals (case-insensitive). Its
// channels end in X, Y, Z or R, G, B. Throws Error (invalid_input) with the list of channels.
NormalChannels normalChannels(const Image& image, const std::string& path, const std::string& wanted)
{
	if (!wanted.empty())
	{
		const std::optional<NormalChannels> found = vectorOf(image, wanted);
		refuseChannelsIf(!found, image, path, wanted + ".X, " + wanted + ".Y and " + wanted + ".Z among them");
		return *found;
	}
	if (const std::optional<NormalChannels> found = vectorOf(image, "N"))
	{
		return *found;
	}
	const std::vector<NormalChannels> layers = normalLayers(image);
	refuseChannelsIf(layers.size() != 1, image, path,
					 layers.empty() ? "normals N.X, N.Y, N.Z (normal-channels names others), or from depth (normals from-depth)"
									: "one layer of normals alone (normal-channels picks one)");
	return layers.front();
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
		gbuffer.normals[i] = glm::vec3(glm::normalize(n));
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

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// Reads a length; +inf for sky. Throws like readGBuffer.
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

// Converts depths to metres along the view direction, with error bounds. Keeps references to all its arguments.
class DepthReader
{
public:
	DepthReader(const GBufferFile& file, const GBufferImport& import, int channel, const Projector& projector)
		: m_file(file), m_import(import), m_channel(channel), m_error_channel(file.image.channel("depth_error")),
		  m_projector(projector)
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

	// Metres along the view direction; +inf for sky. Throws like readGBuffer.
	float depthOf(std::size_t pixel) const
	{
		const auto depth = static_cast<float>(alongView(pixel));
		if (!(depth > 0.0F)) // a distance that becomes 0 along this line
		{
			m_file.refusePixel(m_file.channelName(m_channel), pixel,
							   shortText(static_cast<double>(m_file.image.at(pixel, m_channel))),
							   "a depth along the view direction that 32 bits hold, above 0");
		}
		return depth;
	}

	// True if depths may be off by more than their rounding to 32 bits.
	bool hasErrors() const
	{
		return m_error_channel >= 0 || m_import.depth == DepthKind::device || m_rounding > kUnitRoundoff;
	}

	// Upper bound in metres by which a surface pixel's depth may be too large. Throws like readGBuffer.
	float errorOf(std::size_t pixel, float depth_m) const
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

private:
	double ndc(double device) const
	{
		return m_import.clip == ClipRange::zero_to_one ? device : 2.0 * device - 1.0;
	}

	ViewLine lineAt(std::size_t pixel) const
	{
		const auto width = static_cast<std::size_t>(m_file.image.width_px);
		return m_projector.lineOf({static_cast<double>(pixel % width) + 0.5, static_cast<double>(pixel / width) + 0.5});
	}

	// Metres, before rounding to 32 bits.
	double alongView(std::size_t pixel) const
	{
		if (m_import.depth == DepthKind::device)
		{
			return fromDevice(pixel);
		}
		const double metres = metresOf(m_file, m_channel, pixel, m_import.sky_depth_m);
		return m_import.depth == DepthKind::distance ? metres / glm::length(lineAt(pixel).along) : metres;
	}

	double fromDevice(std::size_t pixel) const
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

	const GBufferFile& m_file;
	const GBufferImport& m_import;
	int m_channel;
	int m_error_channel; // −1: none
	const Projector& m_projector;
	double m_rounding = 0.0;  // relative rounding of the file's numbers
	double m_half_step = 0.0; // for device depth
	double m_far_device = 1.0;
};

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
	return exrBytes(std::move(image));
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
	// Position error due to 32-bit entries: |R'ᵀ(p − t') − Rᵀ(p − t)| ≤ ‖ΔR‖ |t − p| + |Δt|, with half a unit in the last place,
	// 2⁻²⁵, for each of R's nine entries and 2⁻²⁵ of its size, at most twice over, for t. The part proportional to |p| is that of
	// 32-bit depth itself.
	gbuffer.view_error_m = view.narrow ? 2.5 * 0x1p-24 * glm::length(glm::dvec3(view.matrix[3])) : 0.0;
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
	const auto isSurface = [&](std::size_t i) -> uint8_t
	{
		return std::isinf(metresOf(file, channel, i, GBufferImport().sky_depth_m)) ? 0 : 1;
	};
	return {image.width_px, image.height_px, listOf(image.values.size() / image.channels.size(), isSurface)};
}

int depthChannel(const Image& image, const std::string& path, const std::string& wanted)
{
	if (!wanted.empty())
	{
		const int index = image.channel(wanted);
		refuseChannelsIf(index < 0, image, path, wanted + " among them");
		return index;
	}
	const int index = depthByName(image);
	if (index >= 0)
	{
		return index;
	}
	refuseChannelsIf(index != -1 || image.channels.size() != 1, image, path,
					 std::string(index == -2 ? "one alone" : "one") +
						 " that is depth by its name, such as Z (depth-channel picks one)");
	return 0;
}

bool looksLikeGBuffer(const Image& image)
{
	return depthByName(image) >= 0;
}

} // namespace nook
