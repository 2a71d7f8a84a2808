// SPDX-License-Identifier: GPL-3.0-or-later
// Gives the materials of a glTF file a baked texture, and primitives the coordinates for it.
#include "core/file.h"
#include "core/image.h"
#include "core/lists.h"
#include "scene/gltf_bake.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace nook
{
namespace
{

using Document = GltfEditor::Document;

constexpr const char* kRough = "metallicRoughnessTexture";

// Gives materials a texture of the bake.
class TextureBaker
{
public:
	TextureBaker(GltfEditor& editor, const GltfBake& bake, std::vector<GltfPlace>& parts)
		: m_editor(editor), m_bake(bake), m_parts(parts)
	{
	}

	void check(const std::vector<MeshUnit>& units)
	{
		for (const MeshUnit& unit : units)
		{
			for (const auto& [number, at] : unit.primitives)
			{
				if (const std::size_t rough = roughOf(numberIn(m_editor.primitiveOf(unit.mesh, number), "material"));
					rough != kNoNumber)
				{
					pictureOf(rough);
				}
			}
		}
		if (!m_bake.charts.empty())
		{
			freeSet(units);
		}
	}

	std::size_t add(std::span<const GltfPlace> places, const std::vector<MeshUnit>& units,
					const std::map<std::size_t, int>& set_of_material)
	{
		const bool has_charts = !m_bake.charts.empty();
		if (has_charts || m_bake.others_stay)
		{
			keepOthers(units);
		}
		for (std::size_t i = 0; has_charts && i < places.size(); ++i)
		{
			if (!m_bake.charts[i].rest.empty())
			{
				const std::size_t mesh = numberIn(m_editor.items("nodes")[places[i].node], "mesh");
				m_taken.insert(numberIn(m_editor.primitiveOf(mesh, places[i].primitive), "material"));
			}
		}
		const std::size_t free = has_charts ? freeSet(units) : 0;
		OwnMeshes own(m_editor);
		for (const MeshUnit& unit : units)
		{
			const std::size_t node = unit.nodes.front();
			const std::size_t mesh = has_charts ? own.meshOf(node) : numberIn(m_editor.items("nodes")[node], "mesh");
			for (const auto& [number, at] : unit.primitives)
			{
				if (has_charts)
				{
					const auto place = static_cast<std::size_t>(at.front() - places.data());
					addCharts(unit, places[place], mesh, m_bake.charts[place], free);
					continue;
				}
				const std::size_t before = numberIn(m_editor.primitiveOf(mesh, number), "material");
				const auto set = set_of_material.find(before);
				const auto of_file = static_cast<std::size_t>(m_bake.uv_set.value_or(0));
				m_editor.primitiveOf(mesh, number)["material"] =
					textured(before, 0, m_bake.png, set != set_of_material.end() ? static_cast<std::size_t>(set->second) : of_file);
			}
		}
		return own.copies;
	}

private:
	std::size_t addImage(const std::string& name, std::string_view png)
	{
		const std::size_t view = m_editor.addView(Document::object(), png);
		Document image{{"name", name}, {"mimeType", "image/png"}, {"bufferView", view}};
		m_editor.items("images").push_back(std::move(image));
		return m_editor.items("images").size() - 1;
	}

	// The index of a texture made of a PNG file.
	std::size_t textureOf(std::string_view png)
	{
		const std::size_t image = addImage(kBakedImage, png);
		if (m_sampler == kNoNumber)
		{
			m_sampler = m_editor.items("samplers").size();
			m_editor.items("samplers")
				.push_back({{"magFilter", 9729U}, {"minFilter", 9987U}, {"wrapS", 33071U}, {"wrapT", 33071U}});
		}
		m_editor.items("textures").push_back({{"sampler", m_sampler}, {"source", image}});
		return m_editor.items("textures").size() - 1;
	}

	// The texture that takes the values in its red channel, if any.
	std::size_t roughOf(std::size_t material)
	{
		const Document item = material == kNoNumber || !m_bake.in_red ? Document::object() : m_editor.items("materials")[material];
		const Document pbr = item.value("pbrMetallicRoughness", Document::object());
		return pbr.contains(kRough) ? numberIn(pbr[kRough], "index") : kNoNumber;
	}

	// Its picture; throws unless that has 8 bits per channel.
	Image pictureOf(std::size_t texture)
	{
		const std::size_t number = numberIn(m_editor.items("textures")[texture], "source");
		const std::string where = "textures[" + std::to_string(texture) + "]";
		failIf(number == kNoNumber, m_editor, where, "no image of the core format", "a PNG or JPEG for the red channel",
			   ExitCode::unsupported);
		const JsonValue item = m_editor.file.root().item("images", number);
		const std::string uri = item.text("uri");
		const std::string path = uri.empty() || uri.starts_with("data:") ? "" : besideLevel(m_editor.file.path, unescaped(uri));
		checkInside(m_editor.file.path, "images[" + std::to_string(number) + "]", path, m_editor.file.settings);
		const std::string bytes =
			!path.empty() ? readFile(path)
			: uri.empty() ? std::string(viewBytes(m_editor.file, numberIn(m_editor.items("images")[number], "bufferView")))
						  : dataOf(uri, item).value_or("");
		Image image = decodeImage(bytes, path.empty() ? "image.png" : path);
		failIf(std::any_of(image.values.begin(), image.values.end(),
						   [](float value) { return std::fabs(255.0F * value - std::round(255.0F * value)) > 0.01F; }),
			   m_editor, where, "more than 8 bits per channel", "8 bits, for the red channel", ExitCode::unsupported);
		return image;
	}

	// A copy of a texture with another picture, scaled to its size, as its red channel.
	std::size_t withRed(std::size_t texture, std::string_view png)
	{
		Document made = m_editor.items("textures")[texture];
		std::vector<AlphaImage> red =
			decodeAlphas({{"visibility.png", "", std::string(png), MaskChannel::red}}, m_editor.file.path);
		const Mask values{"", red[0].width_px, red[0].height_px, Wrap::clamp, Wrap::clamp, std::move(red[0].alpha)};
		made["source"] = addImage(textIn(m_editor.items("images")[numberIn(made, "source")], "name"),
								  pngWithChannel(pictureOf(texture), 0, values));
		m_editor.items("textures").push_back(made);
		return m_editor.items("textures").size() - 1;
	}

	// Gives a material the texture, and keeps the strength of an earlier one.
	void setTexture(std::size_t material, std::string_view png, std::size_t set)
	{
		const std::size_t rough = roughOf(material);
		const auto [known, is_new] = m_textures.try_emplace({png.data(), rough}, 0);
		if (is_new)
		{
			known->second = rough == kNoNumber ? textureOf(png) : withRed(rough, png);
		}
		Document& item = m_editor.items("materials")[material];
		if (rough != kNoNumber)
		{
			item["pbrMetallicRoughness"][kRough]["index"] = known->second;
		}
		Document& to = item["occlusionTexture"];
		Document use{{"index", known->second}, {"texCoord", set}};
		if (to.contains("strength"))
		{
			use["strength"] = to["strength"];
		}
		to = std::move(use);
	}

	// The material of a primitive with a page of the texture: a copy if others keep it as it is, or it has another page.
	std::size_t textured(std::size_t before, std::size_t page, std::string_view png, std::size_t set)
	{
		const auto [known, is_new] = m_materials.try_emplace({before, page}, before);
		const std::size_t next = m_editor.items("materials").size();
		if (is_new)
		{
			if (before == kNoNumber || !m_taken.insert(before).second)
			{
				known->second = next;
				m_editor.items("materials")
					.push_back(before == kNoNumber ? Document::object() : m_editor.items("materials")[before]);
			}
			setTexture(known->second, png, set);
			m_materials.emplace(std::pair(known->second, page), known->second);
		}
		return known->second;
	}

	// The first set of coordinates that no primitive has.
	std::size_t freeSet(const std::vector<MeshUnit>& units)
	{
		int set = 0;
		for (const MeshUnit& unit : units)
		{
			for (const auto& [primitive, at] : unit.primitives)
			{
				set = std::max(set, firstFreeSet(m_editor.primitiveOf(unit.mesh, primitive)["attributes"]));
			}
		}
		failIf(set > kMostSet, m_editor, "meshes",
			   "no free set of texture coordinates, with TEXCOORD_" + std::to_string(kMostSet) + " in use",
			   "at most " + std::to_string(kMostSet) + " of them");
		return static_cast<std::size_t>(set);
	}

	// Materials that other primitives have stay as they are.
	void keepOthers(const std::vector<MeshUnit>& units)
	{
		const std::set<std::size_t> meshes = meshesOfOthers(m_editor, units);
		std::set<std::pair<std::size_t, std::size_t>> textured;
		for (const MeshUnit& unit : units)
		{
			for (const auto& [primitive, at] : unit.primitives)
			{
				textured.emplace(unit.mesh, primitive);
			}
		}
		for (std::size_t mesh = 0; mesh < m_editor.items("meshes").size(); ++mesh)
		{
			for (std::size_t i = 0; i < m_editor.items("meshes")[mesh]["primitives"].size(); ++i)
			{
				if ((m_bake.others_stay && meshes.contains(mesh)) || !textured.contains({mesh, i}))
				{
					m_taken.insert(numberIn(m_editor.primitiveOf(mesh, i), "material"));
				}
			}
		}
	}

	// An accessor of indices, the same for the same ones; in 16 bits if `is_short`.
	std::size_t indicesOf(const std::vector<uint32_t>& indices, bool is_short)
	{
		const auto [accessor, is_new] = m_indices.try_emplace({is_short, indices}, 0);
		if (is_new)
		{
			const uint64_t component = is_short ? 5123 : 5125;
			std::string bytes;
			std::for_each(indices.begin(), indices.end(), [&](uint32_t index) { appendComponent(bytes, component, index, false); });
			padTo4(bytes);
			accessor->second = m_editor.addAccessor("SCALAR", component, indices.size(), bytes, true);
		}
		return accessor->second;
	}

	// The file's own accessor of a primitive's indices, from a triangle on.
	std::size_t runOf(std::size_t indices, std::size_t first, std::size_t count)
	{
		const auto [accessor, is_new] = m_runs.try_emplace({indices, first, count}, m_editor.items("accessors").size());
		if (is_new)
		{
			const Document& all = m_editor.items("accessors")[indices];
			const std::size_t component = numberIn(all, "componentType");
			Document run{{"bufferView", all["bufferView"]},
						 {"byteOffset", numberIn(all, "byteOffset", 0) + 3 * first * bytesOfComponent(component)},
						 {"componentType", component},
						 {"count", 3 * count},
						 {"type", "SCALAR"}};
			m_editor.items("accessors").push_back(std::move(run));
		}
		return accessor->second;
	}

	// Accessors for the triangles that no page has: long runs of the file's indices, and new indices for the others.
	std::vector<std::size_t> restOf(const Document& primitive, const std::vector<uint32_t>& rest, bool is_short)
	{
		const std::size_t indices = numberIn(primitive, "indices");
		std::vector<bool> remains; // of the file's triangles
		std::size_t next = 0;      // in `rest`, which has their order
		if (hasList(m_editor, primitive))
		{
			const GltfValues values(m_editor.file, indices);
			for (std::size_t i = 0; i + 3 <= values.count(); i += 3)
			{
				remains.push_back(next < rest.size() && values.index(i) == rest[next] && values.index(i + 1) == rest[next + 1] &&
								  values.index(i + 2) == rest[next + 2]);
				next += remains.back() ? 3U : 0U;
			}
		}
		if (next < rest.size())
		{
			return {indicesOf(rest, is_short)};
		}
		const TriangleRuns kept = runsOf(remains);
		std::vector<std::size_t> accessors =
			mapped(kept.runs, [&](const auto& run) { return runOf(indices, run.first, run.second); });
		if (!kept.others.empty())
		{
			const GltfValues values(m_editor.file, indices);
			std::vector<uint32_t> others;
			for (const std::size_t t : kept.others)
			{
				others.insert(others.end(), {values.index(3 * t), values.index(3 * t + 1), values.index(3 * t + 2)});
			}
			accessors.push_back(indicesOf(others, is_short));
		}
		return accessors;
	}

	// Coordinates on pages; in 16 bits if `is_short`: a sixteenth of a texel of 4096.
	std::size_t coordinatesOf(const std::vector<glm::vec2>& uvs, bool is_short)
	{
		const uint64_t component = is_short ? 5123 : 5126;
		std::string bytes;
		for (const glm::vec2 uv : uvs)
		{
			appendComponent(bytes, component, static_cast<double>(uv.x), is_short);
			appendComponent(bytes, component, static_cast<double>(uv.y), is_short);
		}
		const std::size_t made = m_editor.addAccessor("VEC2", component, uvs.size(), bytes);
		if (is_short)
		{
			m_editor.items("accessors")[made]["normalized"] = true;
		}
		return made;
	}

	// A primitive of a node's own mesh: one for each page, and one for the rest if values go there.
	void addCharts(const MeshUnit& unit, const GltfPlace& place, std::size_t mesh, const GltfCharts& charts, std::size_t set)
	{
		constexpr std::size_t kShort = 65535; // vertices of 16-bit indices, of which the greatest is reserved
		const std::size_t number = place.primitive;
		const bool alone = !charts.page_vertices.empty();
		Document primitive = m_editor.primitiveOf(mesh, number);
		if (alone)
		{
			addVertices(m_editor, primitive, charts.copied, true);
		}
		else
		{
			const auto [shared, is_new] = m_split.try_emplace({unit.mesh, number}, primitive);
			if (is_new)
			{
				addVertices(m_editor, shared->second, charts.copied);
			}
			primitive = shared->second;
		}
		const std::size_t before = numberIn(primitive, "material");
		const std::size_t coordinates = coordinatesOf(charts.uvs, alone);
		for (std::size_t i = 0; i <= set; ++i) // sets have no gaps
		{
			Document& to = primitive["attributes"][setName(static_cast<int>(i))];
			to = to.is_null() ? Document(coordinates) : to;
		}
		primitive["mode"] = 4U;
		std::size_t at = number; // further pages go behind the mesh's primitives
		if (!charts.rest.empty())
		{
			Document rest = m_editor.primitiveOf(mesh, number);
			rest["mode"] = 4U;
			for (const std::size_t indices : restOf(rest, charts.rest, place.count <= kShort))
			{
				rest["indices"] = indices;
				Document& all = m_editor.items("meshes")[mesh]["primitives"];
				all[at] = rest;
				m_parts.push_back({place.node, {}, at, place.count, 0, {}, place.mesh, false, charts.rest_vertices, {}});
				at = all.size();
			}
		}
		for (std::size_t page = 0; page < charts.pages.size(); ++page)
		{
			const std::vector<uint32_t>& indices = charts.pages[page];
			if (indices.empty())
			{
				continue;
			}
			primitive["indices"] = indicesOf(indices, alone && charts.copied.size() <= kShort);
			primitive["material"] = textured(before, page, m_bake.pages[page], set);
			Document& all = m_editor.items("meshes")[mesh]["primitives"];
			all[at] = primitive;
			if (alone)
			{
				m_parts.push_back(
					{place.node, {}, at, charts.copied.size(), 0, {}, place.mesh, false, charts.page_vertices[page], {}});
			}
			at = all.size();
		}
	}

	GltfEditor& m_editor;
	const GltfBake& m_bake;
	std::size_t m_sampler = kNoNumber;                                       // of the textures
	std::map<std::pair<const char*, std::size_t>, std::size_t> m_textures;   // by picture and metallic-roughness texture
	std::map<std::pair<std::size_t, std::size_t>, std::size_t> m_materials;  // by the one before and the page
	std::set<std::size_t> m_taken;                                           // materials that got a page, or stay as they are
	std::map<std::pair<std::size_t, std::size_t>, Document> m_split;         // primitives with added vertices
	std::map<std::pair<bool, std::vector<uint32_t>>, std::size_t> m_indices; // accessors
	std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> m_runs; // accessors, by the one of all, first, count
	std::vector<GltfPlace>& m_parts;
};

} // namespace

void checkTextures(GltfEditor& editor, const GltfBake& bake, const std::vector<MeshUnit>& units)
{
	std::vector<GltfPlace> none;
	TextureBaker(editor, bake, none).check(units);
}

std::size_t addTextures(GltfEditor& editor, const GltfBake& bake, std::span<const GltfPlace> places,
						const std::vector<MeshUnit>& units, const std::map<std::size_t, int>& set_of_material,
						std::vector<GltfPlace>& parts)
{
	return TextureBaker(editor, bake, parts).add(places, units, set_of_material);
}

} // namespace nook
