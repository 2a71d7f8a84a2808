// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/kept_level.h"

#include "core/byte_lists.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/file_hash.h"
#include "core/kept_answers.h"
#include "core/work_units.h"

#include <algorithm>
#include <filesystem>
#include <optional>

namespace nook
{
namespace
{

// One list of members for both directions.
class Saver
{
public:
	template <class Item> void list(std::vector<Item>& items)
	{
		addList(m_out, items);
	}
	template <class Item, class Each> void each(std::vector<Item>& items, const Each& visit)
	{
		m_out.whole(items.size());
		for (Item& item : items)
		{
			visit(item);
		}
	}
	void text(std::string& value)
	{
		m_out.text(value);
	}
	void number(double& value)
	{
		m_out.number(value);
	}
	template <class Whole> void whole(Whole& value)
	{
		m_out.whole(static_cast<uint64_t>(value));
	}
	std::string take()
	{
		return m_out.take();
	}

private:
	ByteWriter m_out;
};

class Loader
{
public:
	explicit Loader(std::string_view bytes) : m_in(bytes) {}

	template <class Item> void list(std::vector<Item>& items)
	{
		takeList(m_in, items);
	}
	template <class Item, class Each> void each(std::vector<Item>& items, const Each& visit)
	{
		items.resize(m_in.count(1));
		for (Item& item : items)
		{
			visit(item);
		}
	}
	void text(std::string& value)
	{
		value = m_in.text();
	}
	void number(double& value)
	{
		value = m_in.number();
	}
	template <class Whole> void whole(Whole& value)
	{
		value = static_cast<Whole>(m_in.whole());
	}
	bool isAtEnd() const
	{
		return m_in.isAtEnd();
	}

private:
	ByteReader m_in;
};

template <class Way> void passMaterials(Way& way, Level& level)
{
	way.each(level.material_list,
			 [&](Material& material)
			 {
				 way.text(material.name);
				 way.whole(material.alpha_mode);
				 way.number(material.cutoff);
				 way.number(material.alpha);
				 way.whole(material.mask);
				 way.number(material.mean_alpha);
				 way.number(material.coverage);
				 way.whole(material.two_sided);
			 });
	way.each(level.masks,
			 [&](Mask& mask)
			 {
				 way.text(mask.name);
				 way.whole(mask.width_px);
				 way.whole(mask.height_px);
				 way.whole(mask.wrap_u);
				 way.whole(mask.wrap_v);
				 way.whole(mask.nearest);
				 way.list(mask.alpha);
			 });
}

template <class Way> void passCameras(Way& way, Level& level)
{
	way.each(level.cameras,
			 [&](LevelCamera& camera)
			 {
				 way.text(camera.name);
				 for (int i = 0; i < 16; ++i)
				 {
					 way.number(camera.world_from_camera[i / 4][i % 4]);
				 }
				 way.whole(camera.lens.orthographic);
				 way.number(camera.lens.fov_y_rad);
				 way.number(camera.lens.half_height_m);
				 way.number(camera.lens.near_m);
				 way.number(camera.lens.far_m);
			 });
}

// `hashes`: of the level's files.
template <class Way> void pass(Way& way, LoadedLevel& loaded, std::vector<std::string>& hashes)
{
	Level& level = loaded.level;
	const auto text = [&](std::string& value)
	{
		way.text(value);
	};
	way.each(level.files, text);
	way.each(hashes, text);
	way.text(level.name);
	way.list(level.positions);
	way.list(level.normals);
	way.list(level.uvs);
	way.list(level.triangles);
	way.list(level.materials);
	way.each(level.meshes,
			 [&](Mesh& mesh)
			 {
				 way.text(mesh.name);
				 way.whole(mesh.first_triangle);
				 way.whole(mesh.triangle_count);
				 way.whole(mesh.around);
				 way.whole(mesh.closed);
			 });
	passMaterials(way, level);
	passCameras(way, level);
	way.each(loaded.diagnosis.findings,
			 [&](Finding& finding)
			 {
				 way.text(finding.id);
				 way.whole(finding.count);
				 way.text(finding.first);
				 way.text(finding.action);
			 });
}

// None where a file cannot be read: reading the level says why.
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

std::optional<LoadedLevel> levelFrom(std::string_view bytes)
{
	LoadedLevel loaded;
	std::vector<std::string> hashes;
	Loader loader(bytes);
	pass(loader, loaded, hashes);
	return loader.isAtEnd() && hashes == hashesOf(loaded.level.files) ? std::optional(std::move(loaded)) : std::nullopt;
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
	if (run.units == nullptr || run.units->isKept() || !keepsAnswers())
	{
		return read();
	}
	const KeptAnswer kept(keyOf(levels, settings));
	if (kept.answer())
	{
		const ProgressCounter stage(run.progress, "level");
		if (std::optional<LoadedLevel> loaded = levelFrom(*kept.answer()))
		{
			return std::move(*loaded);
		}
	}
	LoadedLevel loaded = read();
	std::vector<std::string> hashes = hashesOf(loaded.level.files);
	if (isWhole(loaded) && hashes.size() == loaded.level.files.size())
	{
		Saver saver;
		pass(saver, loaded, hashes);
		kept.keep(saver.take());
	}
	return loaded;
}

} // namespace nook
