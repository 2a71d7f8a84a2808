// SPDX-License-Identifier: GPL-3.0-or-later
// Receives what level_worker.cpp and fbx_source.cpp send from their worker.
#include "core/base64.h"
#include "core/file.h"
#include "core/image.h"
#include "core/isolate.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/words.h"
#include "scene/load_parts.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <unordered_map>

namespace nook
{
namespace
{

// A corner of an OBJ's face takes two bytes of the file, and most of a hundred while a mesh is sent. The floor covers what a reader
// needs for any file.
constexpr std::size_t kMemoryFloor = std::size_t{512} << 20U;
constexpr std::size_t kMemoryPerByte = 64;

// Processor time: a tenth of the slowest rate measured, with a floor that no small file comes near.
constexpr int kTimeFloor_s = 5;
constexpr std::size_t kBytesPerSecond = 500000;

class Receiver
{
public:
	Receiver(const std::string& path, LevelSource& source, Level& level, ValueReader& from)
		: m_path(path), m_source(source), m_level(level), m_from(from)
	{
	}

	void run()
	{
		materials();
		cameras();
		while (mesh())
		{
		}
		const auto sources = static_cast<std::size_t>(m_from.value<uint64_t>());
		m_level.source_count = sources == 0 ? m_level.positions.size() : sources;
		for (const std::string_view id : kSentFindings)
		{
			Tally tally{.count = m_from.value<uint64_t>(), .first = m_from.text()};
			report(m_source.findings, id, tally);
		}
		report(m_source.findings, "missing-uvs", m_no_uvs);
		for (const std::string& file : names())
		{
			addOnce(m_source.files, file);
		}
		append(m_source.missing, names());
	}

private:
	std::vector<std::string> names()
	{
		std::vector<std::string> sent;
		receive(sent, m_from);
		return sent;
	}

	void materials()
	{
		for (uint64_t left = m_from.value<uint32_t>(); left > 0; --left)
		{
			FileMaterial sent;
			receive(sent, m_from, kMaxFileBytes);
			SourceMaterial& made = m_source.materials.emplace_back();
			made.material.name = sent.name;
			made.material.alpha = static_cast<double>(sent.alpha);
			made.material.two_sided = sent.two_sided;
			made.material.colour = sent.colour;
			made.uv_of_set = sent.opacity.name.empty() ? sent.picture.uv_of_set : sent.opacity.uv_of_set;
			refuseInputIf(!std::isfinite(made.material.alpha) || made.material.alpha < 0.0 || made.material.alpha > 1.0,
						  m_path + ": material '" + made.material.name + "'",
						  "an opacity of " + std::to_string(made.material.alpha), "0 to 1");
			if (!sent.opacity.name.empty())
			{
				made.material.alpha_mode = AlphaMode::mask;
				made.mask = maskOf(std::move(sent.opacity));
			}
			else if (made.material.alpha < 1.0)
			{
				made.material.alpha_mode = AlphaMode::blend;
			}
			made.material.picture = pictureOf(sent.picture);
			made.material.wraps = {sent.picture.wrap_u, sent.picture.wrap_v};
		}
	}

	std::string pictureOf(const MaskSource& texture)
	{
		const std::string_view bytes = texture.bytes;
		if (!bytes.empty())
		{
			const std::string type = bytes.starts_with("\x89PNG") ? "png" : bytes.starts_with("\xff\xd8") ? "jpeg" : "";
			return type.empty() ? ""
								: "data:image/" + type + ";base64," +
									  base64Of({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
		}
		const std::string path = texture.name.empty() ? "" : besideLevel(m_path, texture.name);
		const std::size_t missing = m_source.missing.size();
		if (!path.empty())
		{
			noteMissingFile(m_source, path);
		}
		return m_source.missing.size() > missing ? "" : path;
	}

	int maskOf(MaskSource mask)
	{
		const auto same = std::find_if(m_source.masks.begin(), m_source.masks.end(),
									   [&mask](const MaskSource& other)
									   { return other.name == mask.name && static_cast<const MaskUse&>(other) == mask; });
		const auto index = static_cast<int>(same - m_source.masks.begin());
		if (same == m_source.masks.end())
		{
			mask.path = mask.bytes.empty() ? besideLevel(m_path, mask.name) : "";
			m_source.masks.push_back(std::move(mask));
		}
		return index;
	}

	void cameras()
	{
		for (uint64_t left = m_from.value<uint32_t>(); left > 0; --left)
		{
			m_source.cameras.push_back({m_from.text(), m_from.value<glm::dmat4>(), m_from.value<Lens>()}); // in that order
		}
	}

	bool mesh()
	{
		const auto head = m_from.value<MeshHead>();
		if (head.none)
		{
			return false;
		}
		Mesh& mesh = m_level.meshes.emplace_back();
		mesh.name = m_from.text();
		for (const std::string& name : names())
		{
			const auto next = static_cast<int>(m_level.nodes.size());
			const auto [known, is_new] = m_nodes.try_emplace({mesh.node, name}, next);
			if (is_new)
			{
				m_level.nodes.push_back({known->first.second, mesh.node, {}});
			}
			mesh.node = known->second;
		}
		mesh.first_triangle = m_level.triangles.size();
		const std::size_t before = m_level.positions.size();
		m_from.values(m_level.positions, 3 * kMaxTriangles);
		const std::size_t vertices = m_level.positions.size();
		m_from.values(m_level.normals, 3 * kMaxTriangles);
		m_from.values(m_level.uvs, 3 * kMaxTriangles);
		const std::size_t uvs = m_level.uvs.size() - before;
		if (head.material < m_source.materials.size())
		{
			const glm::dmat3& uv_of_set = m_source.materials[head.material].uv_of_set;
			for (std::size_t i = before; i < m_level.uvs.size() && uv_of_set != glm::dmat3(1.0); ++i)
			{
				m_level.uvs[i] = glm::dvec2(uv_of_set * glm::dvec3(m_level.uvs[i], 1.0));
			}
		}
		m_level.normals.resize(vertices, glm::vec3(0.0F));
		m_level.uvs.resize(vertices, glm::vec2(0.0F));
		std::vector<glm::vec3> colours;
		m_from.values(colours, 3 * kMaxTriangles);
		if (!colours.empty() || !m_level.colours.empty())
		{
			m_level.colours.resize(before, glm::vec3(1.0F));
			append(m_level.colours, colours);
			m_level.colours.resize(vertices, glm::vec3(1.0F));
		}
		m_from.values(m_level.sources, 3 * kMaxTriangles);
		while (m_level.sources.size() < vertices) // numbered as they follow each other
		{
			m_level.sources.push_back(static_cast<uint32_t>(m_level.sources.size()));
		}
		m_from.values(m_level.triangles, kMaxTriangles);
		mesh.triangle_count = m_level.triangles.size() - mesh.first_triangle;
		for (std::size_t i = mesh.first_triangle; i < m_level.triangles.size(); ++i)
		{
			glm::uvec3& triangle = m_level.triangles[i];
			for (int corner = 0; corner < 3; ++corner)
			{
				// Out-of-range indices stay out of range in a level of any size.
				const uint64_t index = uint64_t{before} + triangle[corner];
				triangle[corner] = index < vertices ? static_cast<uint32_t>(index) : ~0U;
			}
		}
		m_level.materials.resize(m_level.triangles.size(), head.material);
		if (uvs == 0 && mesh.triangle_count > 0 && head.material < m_source.materials.size() &&
			m_source.materials[head.material].mask >= 0)
		{
			m_no_uvs.add("mesh '" + mesh.name + "'");
		}
		return true;
	}

	const std::string& m_path;
	LevelSource& m_source;
	Level& m_level;
	ValueReader& m_from;
	Tally m_no_uvs;                                     // masked meshes without coordinates
	std::map<std::pair<int, std::string>, int> m_nodes; // by parent and name
};

// Decodes mask pictures and converts materials and cameras to the level's form.

// Rejects a file that is missing, or outside the level's folder.
void checkThere(const LoadSettings& settings, const LevelSource& source, const std::string& level_path)
{
	for (const MaskSource& mask : source.masks)
	{
		if (mask.path.empty())
		{
			continue;
		}
		std::error_code failed;
		refuseInputIf(!std::filesystem::is_regular_file(nativePath(mask.path), failed), level_path, "no file " + mask.path,
					  "the mask of a material", ExitCode::file);
		checkInside(level_path, "mask '" + mask.name + "'", mask.path, settings);
	}
}

void applyGain(const MaskUse& use, std::vector<uint8_t>& alpha)
{
	if (use.base == 0.0 && use.gain == 1.0)
	{
		return;
	}
	for (uint8_t& texel : alpha)
	{
		texel = static_cast<uint8_t>(255.0 * std::clamp(use.base + use.gain * (texel / 255.0), 0.0, 1.0) + 0.5);
	}
}

void decodeMasks(const LoadSettings& settings, LevelSource& source, Level& level)
{
	const std::string& path = source.files.front();
	checkThere(settings, source, path);
	std::vector<EncodedAlpha> pictures; // each channel once: masks of one channel differ only in wrap modes and gains
	std::unordered_map<std::string, std::size_t> indices;
	std::vector<std::size_t> picture_of_mask;
	for (MaskSource& mask : source.masks)
	{
		if (mask.ramp)
		{
			picture_of_mask.push_back(0);
			continue;
		}
		const std::string channel = std::to_string(static_cast<int>(mask.channel));
		const auto [found, is_new] = indices.try_emplace(channel + mask.path + '\n' + mask.name, pictures.size());
		picture_of_mask.push_back(found->second);
		if (is_new)
		{
			pictures.push_back(
				{mask.path.empty() ? path + ": " + mask.name : mask.path, mask.path, std::move(mask.bytes), mask.channel, 0});
		}
		pictures[found->second].uses += 1;
	}
	std::vector<AlphaImage> images = decodeAlphas(pictures, path, settings.max_texels);
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		Mask& mask = level.masks.emplace_back();
		if (source.masks[i].ramp)
		{
			mask.width_px = 256;
			mask.height_px = 1;
			mask.alpha = countingFrom(uint8_t{0}, 256);
		}
		else
		{
			AlphaImage& image = images[picture_of_mask[i]];
			std::size_t& uses = pictures[picture_of_mask[i]].uses;
			uses -= 1;
			mask.width_px = image.width_px;
			mask.height_px = image.height_px;
			mask.alpha = uses > 0 ? image.alpha : std::move(image.alpha);
			applyGain(source.masks[i], mask.alpha);
		}
		mask.name = source.masks[i].name;
		mask.wrap_u = source.masks[i].wrap_u;
		mask.wrap_v = source.masks[i].wrap_v;
		mask.nearest = source.masks[i].nearest;
	}
}

// For a ramp, how many corners of its triangles have each alpha; the ramp's own values if it has no triangle.
AlphaCounts countCorners(const Level& level, const LevelSource& source, int mask)
{
	const Mask& ramp = level.masks[static_cast<std::size_t>(mask)];
	AlphaCounts counts{};
	bool any = false;
	for (std::size_t i = 0; i < level.triangles.size(); ++i)
	{
		const uint32_t material = level.materials[i];
		for (int corner = 0; corner < 3 && material < source.materials.size() && source.materials[material].mask == mask; ++corner)
		{
			const double alpha = alphaAt(ramp, level.uvs[level.triangles[i][corner]]);
			counts[static_cast<std::size_t>(std::lround(255.0 * alpha))] += 1;
			any = true;
		}
	}
	return any ? counts : countAlpha(ramp);
}

// Removes cameras at non-finite or impossibly far positions.
void dropFarCameras(Level& level, std::vector<Finding>& findings)
{
	Tally dropped;
	std::erase_if(level.cameras,
				  [&](const LevelCamera& camera)
				  {
					  const glm::dvec3 eye(camera.world_from_camera[3]);
					  const bool far = !(std::max({std::fabs(eye.x), std::fabs(eye.y), std::fabs(eye.z)}) <= kFarthest_m);
					  if (far)
					  {
						  dropped.add("camera '" + camera.name + "'");
					  }
					  return far;
				  });
	report(findings, "far-cameras", dropped);
}

} // namespace

IsolationLimits levelLimits(std::size_t bytes)
{
	return {kMemoryFloor + kMemoryPerByte * bytes, kTimeFloor_s + static_cast<int>(bytes / kBytesPerSecond)};
}

void readGeometry(const std::string& path, const LoadSettings& settings, LevelSource& source, Level& level)
{
	std::error_code failed;
	const std::uintmax_t size = std::filesystem::file_size(nativePath(path), failed);
	const std::size_t bytes = failed ? 0 : static_cast<std::size_t>(size);
	isolate(
		{kLevelWorker, kReadLevel}, path, levelLimits(bytes),
		[&](ValueWriter& to)
		{
			to.text(path);
			to.value(static_cast<const FileSettings&>(settings));
		},
		[&](ValueReader& from) { Receiver(path, source, level, from).run(); });
}

void finishMaterials(const LoadSettings& settings, LevelSource& source, Level& level)
{
	if (!source.masks.empty())
	{
		decodeMasks(settings, source, level);
	}
	std::vector<AlphaCounts> counts;
	for (std::size_t i = 0; i < source.masks.size(); ++i)
	{
		counts.push_back(source.masks[i].ramp ? countCorners(level, source, static_cast<int>(i)) : countAlpha(level.masks[i]));
		if (!source.masks[i].path.empty())
		{
			addOnce(source.files, source.masks[i].path);
		}
	}
	for (const SourceMaterial& from : source.materials)
	{
		Material& material = level.material_list.emplace_back(from.material);
		material.mask = from.mask;
		material.picture_outside = !settings.allow_outside && !material.picture.empty() && !material.picture.starts_with("data:") &&
								   !isInside(source.files.front(), material.picture);
		measureAlpha(material, from.mask < 0 ? AlphaCounts{} : counts[static_cast<std::size_t>(from.mask)]);
	}
	if (level.material_list.empty())
	{
		level.material_list.emplace_back().name = "default";
	}
	for (uint32_t& material : level.materials)
	{
		material = material < level.material_list.size() ? material : static_cast<uint32_t>(level.material_list.size() - 1);
	}
	level.cameras = source.cameras;
	nameCameras(level.cameras);
	dropFarCameras(level, source.findings);
}

} // namespace nook
