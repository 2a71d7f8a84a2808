// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load_parts.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/work_units.h"

#include <algorithm>
#include <filesystem>

namespace nook
{
void visit(Archive& archive, Material& material)
{
	archive(material.name, material.alpha_mode, material.cutoff, material.alpha, material.mask, material.mean_alpha,
			material.coverage, material.two_sided);
}

void visit(Archive& archive, Mask& mask)
{
	archive(mask.name, mask.width_px, mask.height_px, mask.wrap_u, mask.wrap_v, mask.nearest, mask.alpha);
}

void visit(Archive& archive, Mesh& mesh)
{
	archive(mesh.name, mesh.first_triangle, mesh.triangle_count, mesh.around, mesh.closed);
}

void visit(Archive& archive, LevelCamera& camera)
{
	archive(camera.name, camera.world_from_camera, camera.lens.orthographic, camera.lens.fov_y_rad, camera.lens.half_height_m,
			camera.lens.near_m, camera.lens.far_m);
}

void visit(Archive& archive, Finding& finding)
{
	archive(finding.id, finding.count, finding.first, finding.action);
}

void visit(Archive& archive, LoadedLevel& loaded)
{
	Level& level = loaded.level;
	archive(level.files, level.name, level.positions, level.normals, level.uvs, level.triangles, level.materials, level.meshes,
			level.material_list, level.masks, level.cameras, loaded.diagnosis.findings);
}

namespace
{

// Empty if a file cannot be read; reading the level reports why.
std::vector<std::string> hashesOf(const std::vector<std::string>& files)
{
	std::vector<std::string> hashes;
	for (const std::string& file : files)
	{
		std::error_code failed;
		if (!std::filesystem::is_regular_file(file, failed))
		{
			return {};
		}
		try
		{
			hashes.push_back(hashOfFile(file));
		}
		catch (const Error&)
		{
			return {};
		}
	}
	return hashes;
}

std::string keyOf(std::span<const PlacedLevel> levels, const LoadSettings& settings)
{
	ContentHash key;
	key.add("level");
	for (const PlacedLevel& placed : levels)
	{
		key.add(placed.name);
		key.add(placed.move.x);
		key.add(placed.move.y);
		key.add(placed.move.z);
	}
	key.add(settings.unit_m);
	key.add(static_cast<double>(settings.up));
	key.add(settings.strict ? 1.0 : 0.0);
	key.add(static_cast<double>(settings.max_texels));
	key.add(settings.allow_outside ? 1.0 : 0.0);
	key.add(static_cast<double>(settings.pose));
	key.add(static_cast<double>(settings.tr));
	return key.text();
}

bool isWhole(const LoadedLevel& loaded)
{
	return std::none_of(loaded.diagnosis.findings.begin(), loaded.diagnosis.findings.end(),
						[](const Finding& finding) { return finding.id == "missing-file"; });
}

} // namespace

LoadedLevel keptLevel(std::span<const PlacedLevel> levels, const LoadSettings& settings, const RunSettings& run,
					  const std::function<LoadedLevel()>& read)
{
	if (run.units == nullptr)
	{
		return read();
	}
	LoadedLevel loaded;
	std::vector<std::string> hashes;
	const ProgressCounter stage(run.progress, "level");
	run.units->store().once(
		keyOf(levels, settings),
		[&]
		{
			loaded = read();
			hashes = hashesOf(loaded.level.files);
			return isWhole(loaded) && hashes.size() == loaded.level.files.size();
		},
		[&](Archive& archive)
		{
			archive(hashes, loaded);
			archive.require(!archive.reads() || hashes == hashesOf(loaded.level.files));
		});
	return loaded;
}

} // namespace nook
