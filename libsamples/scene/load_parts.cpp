// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load_parts.h"

#include "core/lists.h"
#include "core/system.h"
#include "core/words.h"

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cassert>
#include <filesystem>
#include <limits>
#include <unordered_map>
#include <unordered_set>

namespace nook
{

void noteMissingFile(LevelSource& source, const std::string& path)
{
	std::error_code failed;
	if (!std::filesystem::is_regular_file(nativePath(path), failed))
	{
		source.missing.push_back(path);
	}
}

std::string besideLevel(const std::string& level_path, std::string name)
{
	std::replace(name.begin(), name.end(), '\\', '/');
	const std::filesystem::path folder = nativePath(level_path).parent_path();
	const std::filesystem::path given = folder / nativePath(name); // absolute names stay absolute
	std::error_code failed;
	if (std::filesystem::exists(given, failed))
	{
		return given.generic_string();
	}
	// A path from the machine where the level was made: the picture may be next to the level.
	const std::filesystem::path sibling = folder / nativePath(name).filename();
	return std::filesystem::exists(sibling, failed) ? sibling.generic_string() : given.generic_string();
}

void checkCounts(const std::string& where, uint64_t triangles, uint64_t vertices, const std::string& counted)
{
	refuseInputIf(triangles > kMaxTriangles || vertices > 3 * uint64_t{kMaxTriangles}, where,
				  std::to_string(triangles) + " triangles of " + std::to_string(vertices) + " vertices" + counted,
				  "at most " + std::to_string(kMaxTriangles));
}

std::string endingOf(const std::string& path)
{
	return lowered(nativePath(path).extension().string());
}

glm::dmat4 worldFromFile(const LoadSettings& settings)
{
	const double unit = settings.unit_m == 0.0 ? 1.0 : settings.unit_m;
	// Rows of a rotation without reflection: the named axis becomes y.
	glm::dmat3 axes(1.0);
	if (settings.up == UpAxis::z)
	{
		axes = {glm::dvec3(1.0, 0.0, 0.0), glm::dvec3(0.0, 0.0, -1.0), glm::dvec3(0.0, 1.0, 0.0)};
	}
	else if (settings.up == UpAxis::x)
	{
		axes = {glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(-1.0, 0.0, 0.0), glm::dvec3(0.0, 0.0, 1.0)};
	}
	glm::dmat4 world(axes * unit);
	world[3][3] = 1.0;
	return world;
}

glm::dmat4 worldFromFile(const LoadSettings& settings, const FileAxes& file)
{
	LoadSettings given = settings;
	given.unit_m = given.unit_m == 0.0 ? file.unit_m : given.unit_m;
	glm::dmat4 world(0.0);
	for (std::size_t row = 0; row < 3 && given.up == UpAxis::file; ++row)
	{
		if (file.axes[row] >= 0 && file.axes[row] <= 2)
		{
			world[file.axes[row]][static_cast<int>(row)] = (file.signs[row] < 0 ? -1.0 : 1.0) * given.unit_m;
		}
	}
	world[3][3] = 1.0;
	return glm::determinant(world) == 0.0 ? worldFromFile(given) : world; // explicit axis, or an invalid file that repeats an axis
}

glm::dmat3 normalsFrom(const glm::dmat4& world)
{
	const glm::dmat3 m(world);
	const double side = glm::determinant(m) < 0.0 ? -1.0 : 1.0;
	return {side * glm::cross(m[1], m[2]), side * glm::cross(m[2], m[0]), side * glm::cross(m[0], m[1])};
}

glm::vec3 turnedNormal(const glm::dmat3& turn, glm::dvec3 normal)
{
	const glm::dvec3 turned = turn * normal;
	const double length = glm::length(turned);
	return length > 0.0 ? turned * (glm::length(normal) / length) : glm::dvec3(std::numeric_limits<double>::quiet_NaN());
}

glm::dmat4 rigidOf(const glm::dmat4& matrix)
{
	const glm::dvec3 z(matrix[2]);
	const glm::dvec3 y(matrix[1]);
	if (!(glm::dot(glm::cross(y, z), glm::cross(y, z)) > 0.0))
	{
		return {glm::dvec4(1.0, 0.0, 0.0, 0.0), glm::dvec4(0.0, 1.0, 0.0, 0.0), glm::dvec4(0.0, 0.0, 1.0, 0.0), matrix[3]};
	}
	const glm::dvec3 back = glm::normalize(z);
	const glm::dvec3 right = glm::normalize(glm::cross(y, back));
	return {glm::dvec4(right, 0.0), glm::dvec4(glm::cross(back, right), 0.0), glm::dvec4(back, 0.0),
			glm::dvec4(glm::dvec3(matrix[3]), 1.0)};
}

void nameCameras(std::vector<LevelCamera>& cameras)
{
	std::unordered_set<std::string> taken;
	std::unordered_map<std::string, int> numbers; // last number appended to a name
	for (std::size_t i = 0; i < cameras.size(); ++i)
	{
		const std::string name = cameras[i].name.empty() ? "camera " + std::to_string(i) : cameras[i].name;
		std::string unique = name;
		while (!taken.insert(unique).second)
		{
			int& number = numbers.try_emplace(name, 1).first->second;
			number += 1;
			unique = name + " " + std::to_string(number);
		}
		cameras[i].name = unique;
	}
}

namespace
{

// All kinds of findings, in the order of docs/reference/levels.md.
struct Kind
{
	std::string_view id;
	std::string_view action;
};
constexpr std::array<Kind, 26> kKinds{{
	{"missing-file", "ignored"},
	{"hidden-nodes", "dropped"},
	{"lower-lods", "dropped"},
	{"posed-meshes", "applied"},
	{"not-applied", "ignored"},
	{"transmission", "kept"},
	{"inverted-transparency", "repaired"},
	{"points-or-lines", "dropped"},
	{"bad-polygons", "kept"},
	{"missing-uvs", "kept"},
	{"far-cameras", "dropped"},
	{"index-out-of-range", "dropped"},
	{"non-finite-vertices", "dropped"},
	{"degenerate-triangles", "dropped"},
	{"duplicate-faces", "dropped"},
	{"empty-meshes", "dropped"},
	{"bad-normals", "repaired"},
	{"sliver-triangles", "kept"},
	{"coincident-faces", "kept"},
	{"non-manifold-edges", "kept"},
	{"inconsistent-winding", "kept"},
	{"inside-out-parts", "kept"},
	{"large-coordinates", "kept"},
	{"collision-meshes", "kept"},
	{"skies", "kept"},
	{"strays", "kept"},
}};

std::size_t rankOf(std::string_view id)
{
	const auto* const found = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& kind) { return kind.id == id; });
	assert(found != kKinds.end());
	return static_cast<std::size_t>(found - kKinds.begin());
}

} // namespace

void report(std::vector<Finding>& findings, std::string_view id, const Tally& tally)
{
	if (tally.count > 0)
	{
		findings.push_back({std::string(id), tally.count, tally.first, std::string(kKinds[rankOf(id)].action)});
	}
}

void sendTallies(SentTallies& tallies, ValueWriter& to)
{
	for (const std::string_view id : kSentFindings)
	{
		to.value(tallies[id].count);
		to.text(tallies[id].first);
	}
}

void addFindings(Diagnosis& diagnosis, const std::vector<Finding>& findings)
{
	for (const Finding& finding : findings)
	{
		Finding* const same = firstWhere(diagnosis.findings, [&](const Finding& other) { return other.id == finding.id; });
		if (same == nullptr)
		{
			diagnosis.findings.push_back(finding);
			continue;
		}
		same->count += finding.count;
		same->first = finding.first; // occurred earlier
	}
	std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
					 [](const Finding& a, const Finding& b) { return rankOf(a.id) < rankOf(b.id); });
}

// Restricts a level to files in its own folder. Otherwise a level from elsewhere could copy any file of this machine into a picture
// or a message.

bool isInside(const std::string& level_path, const std::string& path)
{
	std::error_code failed;
	const std::filesystem::path parent = nativePath(level_path).parent_path();
	const std::filesystem::path folder = std::filesystem::canonical(parent.empty() ? "." : parent, failed);
	const std::filesystem::path file = std::filesystem::canonical(nativePath(path), failed);
	return failed || std::mismatch(folder.begin(), folder.end(), file.begin(), file.end()).first == folder.end();
}

void checkInside(const std::string& level_path, const std::string& reference, const std::string& path, const LoadSettings& settings)
{
	refuseInputIf(!settings.allow_outside && !isInside(level_path, path), // a missing file is reported elsewhere
				  level_path + ": " + reference, path + ", which is outside the level's folder",
				  "a file in it (allow-outside permits others)");
}

} // namespace nook
