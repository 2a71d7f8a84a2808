// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/describe.h"

#include "core/lists.h"
#include "core/math.h"
#include "core/random.h"
#include "core/text.h"
#include "core/words.h"
#include "scene/gbuffer.h"
#include "scene/level_glb.h"
#include "scene/load_parts.h"
#include "scene/ray_triangle.h"
#include "scene/topology.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

namespace nook
{
namespace
{

std::string pointText(glm::dvec3 p)
{
	return "(" + roundedText(p.x, 6) + ", " + roundedText(p.y, 6) + ", " + roundedText(p.z, 6) + ")";
}

std::string_view nameOf(AlphaMode mode)
{
	return mode == AlphaMode::mask ? "mask" : mode == AlphaMode::blend ? "blend" : "opaque";
}

void addBounds(const Level& level, Facts& facts)
{
	const Bounds bounds = boundsOf(level);
	facts.numbers("least_m", {bounds.least.x, bounds.least.y, bounds.least.z});
	facts.numbers("most_m", {bounds.most.x, bounds.most.y, bounds.most.z});
	const glm::dvec3 size = bounds.most - bounds.least;
	const glm::dvec3 origin = glbOrigin(preciseBounds(level));
	facts.numbers("origin_m", {origin.x, origin.y, origin.z});
	facts.line("bounds: " + pointText(bounds.least) + " to " + pointText(bounds.most) + " m, " + roundedText(size.x, 4) + " x " +
			   roundedText(size.y, 4) + " x " + roundedText(size.z, 4) + " m");
	if (origin != glm::dvec3(0.0))
	{
		facts.line("origin: (" + fixedText(origin.x, 0) + ", " + fixedText(origin.y, 0) + ", " + fixedText(origin.z, 0) +
				   ") m, which files of 32-bit positions count from: the translation of their nodes");
	}
}

// Paths of parts as patterns may name them, each once.
void addParts(const Level& level, Facts& facts)
{
	constexpr std::size_t kMostParts = 1000;
	std::set<std::string> paths;
	for (std::size_t i = 0; i < level.meshes.size() && paths.size() < kMostParts; ++i)
	{
		paths.insert(pathOf(level, level.meshes[i]));
	}
	facts.texts("parts", {paths.begin(), paths.end()});
	facts.line("parts: " + std::string(paths.size() < kMostParts ? "" : "at least ") + std::to_string(paths.size()) + ", as " +
			   oneLine(*paths.begin()));
}

// Lists only materials that let light through, and counts the others.
void addMaterials(const Level& level, Facts& facts)
{
	std::vector<std::size_t> triangles(level.material_list.size(), 0);
	for (const uint32_t material : level.materials)
	{
		triangles[material] += 1;
	}
	const auto is_seen_through = [](const Material& material)
	{
		return material.alpha_mode != AlphaMode::opaque;
	};
	const auto seen_through = std::count_if(level.material_list.begin(), level.material_list.end(), is_seen_through);
	facts.whole("materials", level.material_list.size());
	facts.line("materials: " + std::to_string(level.material_list.size()) + ", " + std::to_string(seen_through) +
			   " that light passes through");
	std::vector<Facts> items;
	for (std::size_t i = 0; i < triangles.size(); ++i)
	{
		const Material& material = level.material_list[i];
		if (!is_seen_through(material))
		{
			continue;
		}
		const std::string mask = material.mask < 0 ? "" : level.masks[static_cast<std::size_t>(material.mask)].name;
		facts.line("  " + std::string(nameOf(material.alpha_mode)) + " '" + oneLine(material.name) + "': cut-off " +
				   roundedText(material.cutoff, 4) + ", mean alpha " + roundedText(material.mean_alpha, 4) + ", coverage " +
				   roundedText(material.coverage, 4) + ", " + counted(triangles[i], "triangle", "triangles") +
				   (mask.empty() ? ", no texture" : ", " + oneLine(mask)));
		Facts& item = items.emplace_back();
		item.text("name", material.name);
		item.text("mode", nameOf(material.alpha_mode));
		item.number("cutoff", material.cutoff);
		item.number("mean_alpha", material.mean_alpha);
		item.number("coverage", material.coverage);
		item.whole("triangles", triangles[i]);
		item.text("mask", mask);
	}
	facts.items("see_through", std::move(items));
}

void addCameras(const Level& level, Facts& facts)
{
	facts.line("cameras: " + std::to_string(level.cameras.size()));
	std::vector<Facts> items;
	for (const LevelCamera& camera : level.cameras)
	{
		const glm::dvec3 eye(camera.world_from_camera[3]);
		const glm::dvec3 forward(-camera.world_from_camera[2]);
		const double fov_deg = camera.lens.fov_y_rad * 180.0 / kPi;
		facts.line("  '" + oneLine(camera.name) + "': at " + pointText(eye) + " m, looks along " + pointText(forward) + ", " +
				   (camera.lens.orthographic ? "orthographic, " + roundedText(2.0 * camera.lens.half_height_m, 4) + " m high"
											 : roundedText(fov_deg, 4) + " degrees high"));
		Facts& item = items.emplace_back();
		item.text("name", camera.name);
		item.numbers("eye_m", {eye.x, eye.y, eye.z});
		item.numbers("forward", {forward.x, forward.y, forward.z});
		if (camera.lens.orthographic)
		{
			item.number("half_height_m", camera.lens.half_height_m);
		}
		else
		{
			item.number("fov_y_deg", fov_deg);
		}
		item.number("near_m", camera.lens.near_m);
		item.number("far_m", camera.lens.far_m);
	}
	facts.items("cameras", std::move(items));
}

std::string megabytes(double bytes)
{
	return roundedText(bytes / 1e6, 3) + " MB";
}

void addEstimate(const std::string& command, const std::string& name, const AssetEstimate& estimate, Facts& facts)
{
	facts.line("  " + command + ": about " + megabytes(estimate.bytes) + ", " + roundedText(estimate.seconds, 2) +
			   " s of a core, " + megabytes(estimate.memory_bytes) + " of memory");
	facts.number("expected_" + name + "_bytes", std::floor(estimate.bytes));
	facts.number("expected_" + name + "_seconds", estimate.seconds);
	facts.number("expected_" + name + "_memory_bytes", std::floor(estimate.memory_bytes));
}

// The asset that suits the level, with estimates of its cost.
void addAdvice(const LevelFacts& found, const AssetEstimate& masks, const AssetEstimate& bake, Facts& facts)
{
	const Advice advice = adviceFor(found, masks);
	const std::string suits = advice.bake ? "bake" : "masks"; // masks err less than sums on every level measured
	const std::string why =
		advice.why + std::string(advice.split ? "; with --max-error, since much of the surface lies in large triangles" : "");
	facts.whole("components", found.components);
	facts.whole("closed_components", found.closed);
	facts.whole("open_triangles", found.open_triangles);
	facts.line("components: " + std::to_string(found.components) + ", " + std::to_string(found.closed) + " closed, " +
			   std::to_string(found.components - found.closed) + " open with " +
			   counted(found.open_triangles, "triangle", "triangles"));
	facts.whole("places", found.places);
	facts.whole("vertices_at_shared_places", found.sharing);
	facts.line("positions: " + counted(found.places, "place", "places") + "; " +
			   counted(found.sharing, "vertex has", "vertices have") + " that of an earlier one");
	facts.whole("patches", found.patches);
	facts.number("median_edge_m", found.median_edge_m);
	facts.number("coarse_share", found.coarse_share);
	facts.text("scale", scaleText(found));
	facts.line("scale: " + scaleText(found) + "; half of the surface lies in triangles smaller than a square of " +
			   roundedText(found.median_edge_m, 3) + " m");
	facts.number("suggested_distance_m", found.radius_m);
	facts.line("distance: " + roundedText(found.radius_m, 3) + " m suggested, for rays and for volumes");
	facts.line("expected:");
	addEstimate("nook volumes --masks", "volumes", masks, facts);
	addEstimate("nook bake", "bake", bake, facts);
	facts.text("suits", suits);
	facts.text("why", why);
	facts.line("suits: " + suits + ", since " + why);
	facts.line(advice.bake ? "  nook bake makes the file; nook volumes --masks --detail auto errs less and takes more bytes"
						   : "  nook volumes --masks makes the file, --method aov-mask draws it");
	if (advice.bake)
	{
		facts.line("  nook volumes --visible-from outside drops what no camera beyond the bounds sees");
	}
}

// The values of a channel, over all pixels.
struct ChannelFacts
{
	double least = std::numeric_limits<double>::infinity(); // of the finite values
	double most = -std::numeric_limits<double>::infinity();
	double sum = 0.0;
	std::size_t finite = 0;
	std::size_t infinite = 0;
	std::size_t nan = 0;
};

ChannelFacts factsOf(const Image& image, int channel)
{
	ChannelFacts facts;
	for (std::size_t i = 0; i < image.values.size() / image.channels.size(); ++i)
	{
		const auto value = static_cast<double>(image.at(i, channel));
		if (!std::isfinite(value))
		{
			(std::isnan(value) ? facts.nan : facts.infinite) += 1;
			continue;
		}
		facts.least = std::min(facts.least, value);
		facts.most = std::max(facts.most, value);
		facts.sum += value;
		facts.finite += 1;
	}
	return facts;
}

void addChannels(const Image& image, Facts& facts)
{
	std::size_t width = 0;
	for (const std::string& channel : image.channels)
	{
		width = std::max(width, channel.size());
	}
	facts.line("channels:");
	std::vector<Facts> items;
	const std::size_t pixels = image.values.size() / image.channels.size();
	for (std::size_t c = 0; c < image.channels.size(); ++c)
	{
		const std::string& name = image.channels[c];
		const ChannelFacts found = factsOf(image, static_cast<int>(c));
		const double mean =
			found.finite > 0 ? found.sum / static_cast<double>(found.finite) : std::numeric_limits<double>::quiet_NaN();
		std::string line = "  " + oneLine(name) + std::string(width - name.size() + 2, ' ');
		line += found.finite > 0
					? roundedText(found.least, 6) + " to " + roundedText(found.most, 6) + ", mean " + roundedText(mean, 6)
					: "no finite value";
		line += found.infinite > 0
					? ", infinite in " + roundedText(100.0 * static_cast<double>(found.infinite) / static_cast<double>(pixels), 3) +
						  " %"
					: "";
		line += found.nan > 0 ? ", NaN in " + counted(found.nan, "pixel", "pixels") : "";
		facts.line(line);
		Facts& item = items.emplace_back();
		item.text("name", name);
		item.number("least", found.least);
		item.number("most", found.most);
		item.number("mean", mean);
		item.whole("infinite", found.infinite);
		item.whole("nan", found.nan);
	}
	facts.items("channels", std::move(items));
}

// Row by row, as matrices are written on paper.
void addMatrices(const Image& image, Facts& facts)
{
	std::vector<Facts> items;
	for (const ImageMatrix& matrix : image.matrices)
	{
		facts.line(oneLine(matrix.key) + " (" + (matrix.wide ? "64" : "32") + " bits):");
		for (std::size_t row = 0; row < 4; ++row)
		{
			std::string line;
			for (std::size_t column = 0; column < 4; ++column)
			{
				const double value = matrix.values[4 * column + row] + 0.0; // no -0
				const std::string text = matrix.wide ? roundedText(value, 12) : roundedText(value, 7);
				const std::size_t wide = matrix.wide ? 20 : 14;
				line += std::string(text.size() < wide ? wide - text.size() : 1, ' ') + text;
			}
			facts.line(line);
		}
		Facts& item = items.emplace_back();
		item.text("name", matrix.key);
		item.whole("bits", matrix.wide ? 64 : 32);
		item.numbers("values", {matrix.values.begin(), matrix.values.end()});
	}
	facts.items("matrices", std::move(items));
}

void addNotes(const Image& image, Facts& facts)
{
	std::vector<Facts> items;
	for (const Note& note : image.notes)
	{
		// The library's own remarks about how the file was stored say nothing about the picture.
		if (note.value.empty() || note.key.find("oiio:") == 0)
		{
			continue;
		}
		facts.line(oneLine(note.key) + ": " + oneLine(note.value));
		Facts& item = items.emplace_back();
		item.text("name", note.key);
		item.text("value", note.value);
	}
	facts.items("notes", std::move(items));
}

constexpr double kOnePlane = 1e-4; // sine of the angle up to which neighbours are a patch

constexpr double kOffPlane = 1e-4; // of the distance: how far off its plane neighbours become parts of a volume

// Whether the smaller one of an edge's two triangles lies in the plane of the larger one; a and b are twice their areas.
bool areInPlane(const Level& level, std::span<const HalfEdge> edge, glm::dvec3 a, glm::dvec3 b, double flat_m)
{
	const std::size_t larger_side = glm::dot(a, a) >= glm::dot(b, b) ? 0 : 1;
	const glm::dvec3 across = larger_side == 0 ? a : b;
	const glm::uvec3 larger = level.triangles[edge[larger_side].triangle()];
	const glm::uvec3 smaller = level.triangles[edge[1 - larger_side].triangle()];
	double most = 0.0;
	for (int corner = 0; corner < 3; ++corner)
	{
		most = std::max(most, std::fabs(glm::dot(level.positions[smaller[corner]] - level.positions[larger.x], across)));
	}
	return most <= flat_m * glm::length(across);
}

void findComponents(const Level& level, const std::vector<uint32_t>& place, LevelFacts& facts, int threads)
{
	const std::size_t count = level.triangles.size();
	const EdgeTable edges(mapped(level.triangles, [&](glm::uvec3 t) { return glm::uvec3(place[t.x], place[t.y], place[t.z]); }), {},
						  place.size(), threads);
	Groups components(count);
	Groups patches(count);
	Groups flats(count);
	std::vector<uint8_t> open(count, 0);
	edges.each(0, edges.vertexCount(),
			   [&](std::span<const HalfEdge> edge)
			   {
				   const bool pair = isPair(edge);
				   for (const HalfEdge& side : edge)
				   {
					   components.join(edge[0].triangle(), side.triangle());
					   open[side.triangle()] |= pair ? 0 : 1;
				   }
				   const glm::dvec3 a = twiceAreaOf(level, edge.front().triangle());
				   const glm::dvec3 b = twiceAreaOf(level, edge.back().triangle());
				   if (!pair || !(glm::dot(a, b) > 0.0))
				   {
					   return;
				   }
				   if (glm::length(glm::cross(a, b)) <= kOnePlane * glm::length(a) * glm::length(b))
				   {
					   patches.join(edge[0].triangle(), edge[1].triangle());
				   }
				   if (areInPlane(level, edge, a, b, kOffPlane * facts.radius_m))
				   {
					   flats.join(edge[0].triangle(), edge[1].triangle());
				   }
			   });
	std::vector<uint8_t> open_component(count, 0);
	for (std::size_t t = 0; t < count; ++t)
	{
		open_component[components.rootOf(static_cast<uint32_t>(t))] |= open[t];
	}
	for (std::size_t t = 0; t < count; ++t)
	{
		const uint32_t root = components.rootOf(static_cast<uint32_t>(t));
		facts.components += root == t ? 1U : 0U;
		facts.patches += patches.rootOf(static_cast<uint32_t>(t)) == t ? 1U : 0U;
		facts.closed += root == t && open_component[t] == 0 ? 1U : 0U;
		facts.open_triangles += open_component[root];
		facts.sheets += level.material_list[level.materials[t]].two_sided ? 1U : 0U;
	}
	facts.flat_of = std::move(flats).roots();
}

// A few hundred points of the surface, half of them evenly over the triangles and half by area, as a bake has them.
std::vector<glm::dvec3> somePoints(const Level& level, std::span<const double> areas)
{
	constexpr std::size_t kHalfPoints = 128;
	std::vector<glm::dvec3> points;
	const auto add = [&](std::size_t triangle)
	{
		// M. Roberts' sequence R2.
		const auto turn = static_cast<double>(points.size() + 1);
		const double b = fraction(0.5 + 0.7548776662466927 * turn);
		const double c = fraction(0.5 + 0.5698402909980532 * turn);
		const bool beyond = b + c > 1.0;
		const glm::dvec2 at = beyond ? glm::dvec2(1.0 - b, 1.0 - c) : glm::dvec2(b, c);
		const glm::uvec3 corner = level.triangles[triangle];
		points.push_back((1.0 - at.x - at.y) * level.positions[corner.x] + at.x * level.positions[corner.y] +
						 at.y * level.positions[corner.z]);
	};
	for (std::size_t i = 0; i < kHalfPoints; ++i)
	{
		add((2 * i + 1) * areas.size() / (2 * kHalfPoints));
	}
	const double step_m2 = sumOver(std::vector<double>(areas.begin(), areas.end())) / kHalfPoints;
	double passed_m2 = 0.5 * step_m2;
	for (std::size_t t = 0; t < areas.size() && step_m2 > 0.0; passed_m2 -= areas[t], ++t)
	{
		for (; passed_m2 < areas[t] && points.size() < 2 * kHalfPoints; passed_m2 += step_m2)
		{
			add(t);
		}
	}
	return points;
}

void findNear(const Level& level, std::span<const double> areas, LevelFacts& facts)
{
	std::vector<glm::dvec3> points = somePoints(level, areas);
	const auto is_before = [](const glm::dvec3& a, const glm::dvec3& b)
	{
		return a.x < b.x;
	};
	std::sort(points.begin(), points.end(), is_before);
	const double disc_m2 = kPi * facts.radius_m * facts.radius_m;
	for (std::size_t t = 0; t < areas.size(); ++t)
	{
		const Bounds box = boundsOf(level, t);
		const glm::dvec3 least = box.least - facts.radius_m;
		const glm::dvec3 most = box.most + facts.radius_m;
		const double discs = level.material_list[level.materials[t]].alpha_mode == AlphaMode::opaque ? 0.0 : areas[t] / disc_m2;
		for (auto at = std::lower_bound(points.begin(), points.end(), least, is_before); at != points.end() && at->x <= most.x;
			 ++at)
		{
			const bool is_near = at->y >= least.y && at->y <= most.y && at->z >= least.z && at->z <= most.z;
			facts.near += is_near ? 1.0 : 0.0;
			facts.near_cover += is_near ? std::min(discs, 1.0) : 0.0;
		}
	}
	facts.near /= static_cast<double>(points.size());
	facts.near_cover /= static_cast<double>(points.size());
}

void findSizes(const Level& level, LevelFacts& facts)
{
	std::vector<double> areas = areasOf(level);
	findNear(level, areas, facts);
	std::sort(areas.begin(), areas.end());
	const double total = std::accumulate(areas.begin(), areas.end(), 0.0);
	const double coarse_m2 = 0.25 * facts.radius_m * facts.radius_m;
	double below = 0.0;
	double coarse = 0.0;
	for (const double area : areas)
	{
		below += area;
		coarse += area > coarse_m2 ? area : 0.0;
		if (facts.median_edge_m == 0.0 && below >= 0.5 * total)
		{
			facts.median_edge_m = std::sqrt(area);
		}
	}
	facts.coarse_share = total > 0.0 ? coarse / total : 0.0;
}

} // namespace

bool isImageName(const std::string& path)
{
	constexpr std::array<std::string_view, 9> kEndings{".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".hdr", ".tga", ".bmp"};
	return std::find(kEndings.begin(), kEndings.end(), endingOf(path)) != kEndings.end();
}

void describeImage(const Image& image, Facts& facts)
{
	const std::string kind = looksLikeGBuffer(image) ? "G-buffer" : image.channel("visibility") >= 0 ? "visibility" : "image";
	facts.text("kind", kind);
	facts.whole("width", image.width_px);
	facts.whole("height", image.height_px);
	facts.line(kind + ": " + std::to_string(image.width_px) + " x " + std::to_string(image.height_px) + " pixels" +
			   (image.cropped ? ", only a part of the picture, or more" : ""));
	addChannels(image, facts);
	addMatrices(image, facts);
	addNotes(image, facts);
}

void describeLevel(const LoadedLevel& loaded, const LevelFacts& found, const AssetEstimate& masks, const AssetEstimate& bake,
				   Facts& facts)
{
	const Level& level = loaded.level;
	facts.text("kind", "level");
	facts.text("name", level.name);
	facts.whole("meshes", level.meshes.size());
	facts.whole("triangles", level.triangles.size());
	facts.whole("vertices", level.positions.size());
	facts.line("level: " + oneLine(level.name) + ", " + counted(level.triangles.size(), "triangle", "triangles") + " of " +
			   counted(level.positions.size(), "vertex", "vertices") + " in " + counted(level.meshes.size(), "mesh", "meshes"));
	addBounds(level, facts);
	const double area = sumOver(areasOf(level));
	facts.number("area_m2", area);
	facts.line("surface: " + roundedText(area, 6) + " m2");
	addParts(level, facts);
	addMaterials(level, facts);
	addCameras(level, facts);
	std::vector<Facts> items;
	std::string lines;
	for (const Finding& finding : loaded.diagnosis.findings)
	{
		Facts& item = items.emplace_back();
		item.text("id", finding.id);
		item.whole("count", finding.count);
		item.text("first", finding.first);
		item.text("action", finding.action);
		lines +=
			"\n  " + finding.id + ": " + std::to_string(finding.count) + " " + finding.action + ", first " + oneLine(finding.first);
	}
	const std::string count = items.empty() ? "none" : std::to_string(items.size());
	facts.items("findings", std::move(items));
	addAdvice(found, masks, bake, facts);
	facts.line("findings: " + count + lines);
}

double suggestedRadius(const Level& level)
{
	const Bounds bounds = mainBounds(level);
	const double wanted = glm::length(bounds.most - bounds.least) / 40.0;
	if (!(wanted > 1e-5))
	{
		return 1e-5;
	}
	for (const double step : {1.5, 1.0, 0.5, 0.25})
	{
		if (step <= wanted)
		{
			return step;
		}
	}
	double radius_m = 0.1;
	while (radius_m > wanted)
	{
		radius_m *= 0.5;
	}
	return radius_m;
}

LevelFacts levelFacts(const Level& level, int threads)
{
	LevelFacts facts;
	const Bounds bounds = mainBounds(level);
	facts.diagonal_m = glm::length(bounds.most - bounds.least);
	facts.radius_m = suggestedRadius(level);
	facts.place_of = weldPositions(level.positions, threads);
	const std::vector<uint32_t>& place = facts.place_of;
	for (std::size_t v = 0; v < place.size(); ++v)
	{
		facts.places += place[v] == v ? 1U : 0U;
	}
	facts.sharing = place.size() - facts.places;
	findComponents(level, place, facts, threads);
	findSizes(level, facts);
	return facts;
}

Advice adviceFor(const LevelFacts& facts, const AssetEstimate& masks)
{
	constexpr double kSmoothMesh =
		1.54; // patches per vertex: caves and terrain have 1.8 to 1.9, Sponza 1.1, other architecture 0.3 to 0.4
	constexpr double kMuch_bytes = 16e6; // size of volumes that took minutes per picture
	const bool split = facts.coarse_share >= 0.25;
	if (masks.bytes > kMuch_bytes)
	{
		return {true,
				"volumes of so many polygons take minutes a picture and tens of megabytes unless --detail auto simplifies them",
				split};
	}
	if (static_cast<double>(facts.patches) > kSmoothMesh * static_cast<double>(facts.places + facts.sharing))
	{
		return {true, "each facet of its smooth surface would be a volume, while vertices are few", split};
	}
	if (facts.coarse_share < 0.5)
	{
		return {true, "most of the surface lies in triangles that are small against the distance", split};
	}
	return {false, "most of the surface lies in triangles that are larger than its shadows", false};
}

std::string scaleText(const LevelFacts& facts)
{
	const std::string size = facts.diagonal_m < 1.0 ? "less than a metre" : facts.diagonal_m > 5000.0 ? "more than 5 km" : "";
	return size.empty() ? "plausible in metres" : size + " across: maybe it is in other units (--unit)";
}

} // namespace nook
