// SPDX-License-Identifier: GPL-3.0-or-later
#include "level_info.h"

#include "core/math.h"
#include "core/text.h"
#include "scene/advice.h"
#include "scene/level_glb.h"

#include <glm/geometric.hpp>

#include <cmath>

namespace nook
{
namespace
{

std::string counted(std::size_t count, const std::string& one, const std::string& many)
{
	return std::to_string(count) + " " + (count == 1 ? one : many);
}

std::string pointText(glm::dvec3 p)
{
	return "(" + roundedText(p.x, 6) + ", " + roundedText(p.y, 6) + ", " + roundedText(p.z, 6) + ")";
}

std::string_view nameOf(AlphaMode mode)
{
	return mode == AlphaMode::mask ? "mask" : mode == AlphaMode::blend ? "blend" : "opaque";
}

std::string boundsLines(const Bounds& bounds, Summary& summary)
{
	summary.numbers("least_m", {bounds.least.x, bounds.least.y, bounds.least.z});
	summary.numbers("most_m", {bounds.most.x, bounds.most.y, bounds.most.z});
	const glm::dvec3 size = bounds.most - bounds.least;
	const glm::dvec3 origin = glbOrigin(bounds);
	summary.numbers("origin_m", {origin.x, origin.y, origin.z});
	const std::string origin_line = "origin: (" + fixedText(origin.x, 0) + ", " + fixedText(origin.y, 0) + ", " +
									fixedText(origin.z, 0) +
									") m, which files of 32-bit positions count from: the translation of their nodes\n";
	return "bounds: " + pointText(bounds.least) + " to " + pointText(bounds.most) + " m, " + roundedText(size.x, 4) + " x " +
		   roundedText(size.y, 4) + " x " + roundedText(size.z, 4) + " m\n" + (origin == glm::dvec3(0.0) ? "" : origin_line);
}

double areaOf(const Level& level)
{
	double twice = 0.0;
	for (const glm::uvec3& t : level.triangles)
	{
		const glm::dvec3 a = level.positions[t.x];
		twice += glm::length(glm::cross(level.positions[t.y] - a, level.positions[t.z] - a));
	}
	return 0.5 * twice;
}

// Only what lets light through is listed; the others are counted.
std::string materialLines(const Level& level, Summary& summary)
{
	std::vector<std::size_t> triangles(level.material_list.size(), 0);
	for (const uint32_t material : level.materials)
	{
		triangles[material] += 1;
	}
	std::string lines;
	std::vector<Summary> items;
	for (std::size_t i = 0; i < triangles.size(); ++i)
	{
		const Material& material = level.material_list[i];
		if (material.alpha_mode == AlphaMode::opaque)
		{
			continue;
		}
		const std::string mask = material.mask < 0 ? "" : level.masks[static_cast<std::size_t>(material.mask)].name;
		lines += "  " + std::string(nameOf(material.alpha_mode)) + " '" + oneLine(material.name) + "': cut-off " +
				 roundedText(material.cutoff, 4) + ", mean alpha " + roundedText(material.mean_alpha, 4) + ", coverage " +
				 roundedText(material.coverage, 4) + ", " + counted(triangles[i], "triangle", "triangles") +
				 (mask.empty() ? ", no texture" : ", " + oneLine(mask)) + "\n";
		Summary& item = items.emplace_back();
		item.text("name", material.name);
		item.text("mode", nameOf(material.alpha_mode));
		item.number("cutoff", material.cutoff);
		item.number("mean_alpha", material.mean_alpha);
		item.number("coverage", material.coverage);
		item.whole("triangles", triangles[i]);
		item.text("mask", mask);
	}
	summary.whole("materials", level.material_list.size());
	summary.items("see_through", items);
	return "materials: " + std::to_string(level.material_list.size()) + ", " + std::to_string(items.size()) +
		   " that light passes through\n" + lines;
}

std::string cameraLines(const Level& level, Summary& summary)
{
	std::string lines = "cameras: " + std::to_string(level.cameras.size()) + "\n";
	std::vector<Summary> items;
	for (const LevelCamera& camera : level.cameras)
	{
		const glm::dvec3 eye(camera.world_from_camera[3]);
		const glm::dvec3 forward(-camera.world_from_camera[2]);
		const double fov_deg = camera.lens.fov_y_rad * 180.0 / kPi;
		lines += "  '" + oneLine(camera.name) + "': at " + pointText(eye) + " m, looks along " + pointText(forward) + ", " +
				 (camera.lens.orthographic ? "orthographic, " + roundedText(2.0 * camera.lens.half_height_m, 4) + " m high"
										   : roundedText(fov_deg, 4) + " degrees high") +
				 "\n";
		Summary& item = items.emplace_back();
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
	summary.items("cameras", items);
	return lines;
}

std::string megabytes(double bytes)
{
	return roundedText(bytes / 1e6, 3) + " MB";
}

std::string estimateLine(const char* what, const AssetEstimate& estimate)
{
	return std::string("  ") + what + ": about " + megabytes(estimate.bytes) + ", " + roundedText(estimate.seconds, 2) +
		   " s of a core, " + megabytes(estimate.memory_bytes) + " of memory\n";
}

void addEstimate(const std::string& name, const AssetEstimate& estimate, Summary& summary)
{
	summary.number("expected_" + name + "_bytes", std::floor(estimate.bytes));
	summary.number("expected_" + name + "_seconds", estimate.seconds);
	summary.number("expected_" + name + "_memory_bytes", std::floor(estimate.memory_bytes));
}

std::string scaleText(const LevelFacts& facts)
{
	switch (scaleDoubt(facts))
	{
	case ScaleDoubt::small: return "less than a metre across: maybe it is in other units (--unit)";
	case ScaleDoubt::large: return "more than 5 km across: maybe it is in other units (--unit)";
	case ScaleDoubt::none: break;
	}
	return "plausible in metres";
}

void addFacts(const LevelFacts& facts, Summary& summary)
{
	summary.whole("components", facts.components);
	summary.whole("closed_components", facts.closed);
	summary.whole("open_triangles", facts.open_triangles);
	summary.whole("places", facts.places);
	summary.whole("vertices_at_shared_places", facts.sharing);
	summary.whole("patches", facts.patches);
	summary.number("median_edge_m", facts.median_edge_m);
	summary.number("coarse_share", facts.coarse_share);
	summary.text("scale", scaleText(facts));
	summary.number("suggested_distance_m", facts.radius_m);
}

// What suits the level, and about what that takes.
std::string adviceLines(const Level& level, int threads, Summary& summary)
{
	constexpr int kRays = 256; // the default of nook bake
	const LevelFacts facts = levelFacts(level, threads);
	const AssetEstimate volumes = volumesEstimate(level, facts);
	const AssetEstimate bake = bakeEstimate(level, kRays);
	const Advice advice = adviceFor(facts, volumes, bake);
	const std::string suits = advice.asset == Asset::volumes ? "volumes" : "bake";
	const std::string why =
		advice.why + std::string(advice.split ? "; with --max-error, since much of the surface lies in large triangles" : "");
	addFacts(facts, summary);
	addEstimate("volumes", volumes, summary);
	addEstimate("bake", bake, summary);
	summary.text("suits", suits);
	summary.text("why", why);
	const std::size_t open = facts.components - facts.closed;
	return "components: " + std::to_string(facts.components) + ", " + std::to_string(facts.closed) + " closed, " +
		   std::to_string(open) + " open with " + counted(facts.open_triangles, "triangle", "triangles") + "\n" +
		   "positions: " + counted(facts.places, "place", "places") + "; " + counted(facts.sharing, "vertex has", "vertices have") +
		   " that of an earlier one\n" + "scale: " + scaleText(facts) +
		   "; half of the surface lies in triangles smaller than a square of " + roundedText(facts.median_edge_m, 3) + " m\n" +
		   "distance: " + roundedText(facts.radius_m, 3) + " m suggested, for rays and for volumes\n" + "expected:\n" +
		   estimateLine("nook volumes", volumes) + estimateLine("nook bake", bake) + "suits: " + suits + ", since " + why + "\n";
}

} // namespace

std::string findingLines(const Diagnosis& diagnosis)
{
	std::string lines;
	for (const Finding& finding : diagnosis.findings)
	{
		lines += "  " + finding.id + ": " + std::to_string(finding.count) + " " + finding.action + ", first " +
				 oneLine(finding.first) + "\n";
	}
	return lines;
}

std::string describeLevel(const LoadedLevel& loaded, int threads, Summary& summary)
{
	const Level& level = loaded.level;
	summary.text("kind", "level");
	summary.text("name", level.name);
	summary.whole("meshes", level.meshes.size());
	summary.whole("triangles", level.triangles.size());
	summary.whole("vertices", level.positions.size());
	std::string lines = "level: " + oneLine(level.name) + ", " + counted(level.triangles.size(), "triangle", "triangles") + " of " +
						counted(level.positions.size(), "vertex", "vertices") + " in " +
						counted(level.meshes.size(), "mesh", "meshes") + "\n";
	lines += boundsLines(boundsOf(level), summary);
	const double area = areaOf(level);
	summary.number("area_m2", area);
	lines += "surface: " + roundedText(area, 6) + " m2\n";
	lines += materialLines(level, summary);
	lines += cameraLines(level, summary);
	std::vector<Summary> items;
	for (const Finding& finding : loaded.diagnosis.findings)
	{
		Summary& item = items.emplace_back();
		item.text("id", finding.id);
		item.whole("count", finding.count);
		item.text("first", finding.first);
		item.text("action", finding.action);
	}
	summary.items("findings", items);
	lines += adviceLines(level, threads, summary);
	return lines + "findings: " + (items.empty() ? "none" : std::to_string(items.size())) + "\n" + findingLines(loaded.diagnosis);
}

} // namespace nook
