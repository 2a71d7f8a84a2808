// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load.h"

#include "core/error.h"
#include "scene/builtin.h"
#include "scene/load_parts.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 6> kEndings{".gltf", ".glb", ".obj", ".fbx", ".ply", ".stl"};

// The system's reason, before a reader hides it; and nothing that is no file, since pipes and devices have no end.
void checkReadable(const std::string& path)
{
	std::FILE* const file = std::fopen(path.c_str(), "rb");
	if (file == nullptr)
	{
		throw Error(ExitCode::file, path + ": cannot be read: " + std::strerror(errno));
	}
	std::fclose(file);
}

void checkRegular(const std::string& path)
{
	std::error_code failed;
	const std::filesystem::file_status status = std::filesystem::status(path, failed);
	if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
	{
		throw Error(ExitCode::file, path + ": cannot be read: found a folder or device, expected a file");
	}
	checkReadable(path);
}

Level readLevel(const std::string& path, const LoadSettings& settings, std::vector<Finding>& findings)
{
	checkRegular(path);
	const std::string ending = endingOf(path);
	const bool is_gltf = ending == ".gltf" || ending == ".glb";
	LevelSource source;
	if (is_gltf)
	{
		source = readGltf(path);
		const glm::dmat4 world = worldFromFile(settings);
		const double unit = glm::length(glm::dvec3(world[0]));
		for (LevelCamera& camera : source.cameras)
		{
			camera.world_from_camera = rigidOf(world * camera.world_from_camera);
			camera.lens.near_m *= unit;
			camera.lens.far_m *= unit;
			camera.lens.half_height_m *= unit;
		}
	}
	addFile(source.files, path);
	Level level;
	level.name = std::filesystem::path(path).filename().string();
	readGeometry(path, settings, is_gltf, source, level);
	if (level.triangles.empty())
	{
		throw Error(ExitCode::invalid_input, path + ": found no triangle, expected a surface");
	}
	finishMaterials(source, level);
	Tally missing;
	for (const std::string& file : source.missing)
	{
		missing.add(file);
	}
	report(source.findings, "missing-file", missing);
	level.files = std::move(source.files);
	findings = std::move(source.findings);
	return level;
}

} // namespace

bool isLevelName(const std::string& name)
{
	return name.starts_with(kBuiltinPrefix) || std::find(kEndings.begin(), kEndings.end(), endingOf(name)) != kEndings.end();
}

LoadedLevel loadLevel(const std::string& name, const LoadSettings& settings, const RunSettings& run)
{
	LoadedLevel loaded;
	std::vector<Finding> findings;
	if (name.starts_with(kBuiltinPrefix))
	{
		loaded.level = builtinLevel(std::string_view(name).substr(kBuiltinPrefix.size()));
	}
	else if (isLevelName(name))
	{
		loaded.level = readLevel(name, settings, findings);
	}
	else
	{
		throw Error(ExitCode::invalid_input, name + ": found the ending '" + endingOf(name) +
												 "', expected .gltf, .glb, .obj, .fbx, .ply, .stl or builtin:NAME");
	}
	loaded.diagnosis = cleanLevel(loaded.level, run);
	addFindings(loaded.diagnosis, findings);
	if (loaded.level.triangles.empty())
	{
		const Finding& first = loaded.diagnosis.findings.front();
		throw Error(ExitCode::invalid_input,
					name + ": " + first.first + ": found " + first.id + " and no triangle that is left, expected a surface");
	}
	if (settings.strict && !loaded.diagnosis.findings.empty())
	{
		const std::vector<Finding>& found = loaded.diagnosis.findings;
		throw Error(ExitCode::invalid_input, name + ": " + found.front().first + ": found " + found.front().id + " (" +
												 std::to_string(found.front().count) + " times) and " +
												 std::to_string(found.size() - 1) +
												 " other kinds of findings, expected none with --strict");
	}
	return loaded;
}

} // namespace nook
