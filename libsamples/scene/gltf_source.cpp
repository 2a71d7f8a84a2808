// SPDX-License-Identifier: GPL-3.0-or-later
// Reads materials, masks, nodes and cameras from a glTF file's JSON.
#include "scene/gltf_file.h"

#include "core/lists.h"
#include "core/math.h"

#include <glm/geometric.hpp>
#include <glm/gtc/type_ptr.hpp>

#include <cmath>
#include <limits>
#include <tuple>

namespace nook
{
namespace
{

Wrap wrapOf(const JsonValue& sampler, std::string_view field)
{
	switch (sampler.whole(field, UINT16_MAX).value_or(10497))
	{
	case 10497: return Wrap::repeat;
	case 33071: return Wrap::clamp;
	case 33648: return Wrap::mirror;
	default: sampler.fail(field, "another number", "33071, 33648 or 10497");
	}
}

// KHR_texture_transform: translation × rotation × scale of (u, v, 1). The sign of the rotation follows the extension's text
// (counter-clockwise, with v downward) and three.js; its GLSL sample rotates the other way.
glm::dmat3 transformOf(const JsonValue& item)
{
	const auto pairOf = [&](std::string_view field, double fallback)
	{
		const std::vector<double> pair = item.numbers(field, 2);
		return pair.empty() ? glm::dvec2(fallback) : glm::dvec2(pair[0], pair[1]);
	};
	const glm::dvec2 offset = pairOf("offset", 0.0);
	const glm::dvec2 scale = pairOf("scale", 1.0);
	const SinCos turn = sinCosOf(item.number("rotation", 0.0));
	const glm::dmat3 scaled(scale.x, 0.0, 0.0, 0.0, scale.y, 0.0, 0.0, 0.0, 1.0);
	const glm::dmat3 turned(turn.cos, -turn.sin, 0.0, turn.sin, turn.cos, 0.0, 0.0, 0.0, 1.0);
	const glm::dmat3 moved(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, offset.x, offset.y, 1.0);
	return moved * turned * scaled;
}

class Reader
{
public:
	Reader(GltfFile& file, LevelSource& source)
		: m_file(file), m_root(file.root()), m_textures(m_root.objects("textures")), m_images(m_root.objects("images")),
		  m_samplers(m_root.objects("samplers")), m_source(source)
	{
	}

	void materials()
	{
		for (const JsonValue& item : m_root.objects("materials"))
		{
			SourceMaterial& made = m_source.materials.emplace_back();
			made.material.name = item.name();
			made.material.extras = extrasOf(item);
			made.material.two_sided = item.boolean("doubleSided", false);
			made.material.cutoff = item.number("alphaCutoff", 0.5);
			if (const std::optional<JsonValue> occlusion = item.object("occlusionTexture"))
			{
				const std::optional<std::size_t> texture = occlusion->index("index", m_root.count("textures"));
				const std::optional<std::size_t> image =
					texture ? m_root.item("textures", *texture).index("source", m_root.count("images")) : std::nullopt;
				made.material.occlusion = image ? static_cast<int>(*image) : -1;
				made.occlusion_set = static_cast<uint32_t>(occlusion->whole("texCoord", UINT32_MAX).value_or(0));
			}
			const std::string mode = item.text("alphaMode", "OPAQUE");
			failIf(mode != "OPAQUE" && mode != "MASK" && mode != "BLEND", item, "alphaMode", "\"" + mode + "\"",
				   "OPAQUE, MASK or BLEND");
			made.material.alpha_mode = mode == "MASK" ? AlphaMode::mask : mode == "BLEND" ? AlphaMode::blend : AlphaMode::opaque;
			if (mode == "BLEND")
			{
				made.material.cutoff = 0.5;
			}
			const std::optional<JsonValue> transmission = extensionOf(item, "KHR_materials_transmission");
			made.transmits = transmission && transmission->number("transmissionFactor", 0.0) > 0.0;
			// Readers that support specular-glossiness use it instead of the core material.
			const std::optional<JsonValue> specular = extensionOf(item, "KHR_materials_pbrSpecularGlossiness");
			const std::optional<JsonValue> pbr = specular ? specular : item.object("pbrMetallicRoughness");
			if (pbr)
			{
				const std::vector<double> factor = pbr->numbers(specular ? "diffuseFactor" : "baseColorFactor", 4);
				made.material.alpha = factor.empty() ? 1.0 : factor[3];
				if (const std::optional<JsonValue> texture = pbr->object(specular ? "diffuseTexture" : "baseColorTexture"))
				{
					colour(*texture, made);
				}
			}
		}
		// For primitives without a material.
		m_source.materials.emplace_back().material.name = "default";
	}

	// All nodes of the scene, parents first, children in order; instances after their node.
	std::vector<PlacedNode> nodes()
	{
		const std::vector<JsonValue> nodes = m_root.objects("nodes");
		const std::size_t scene = m_root.index("scene", m_root.count("scenes")).value_or(0);
		std::vector<PlacedNode> placed;
		std::vector<PlacedNode> open;
		std::size_t left = kMaxInstances;
		const auto push = [&](const std::vector<std::size_t>& indices, const glm::dmat4& world, bool hidden)
		{
			for (auto at = indices.rbegin(); at != indices.rend(); ++at)
			{
				open.push_back({*at, world, {}, !hidden});
			}
		};
		Tally hidden_nodes;
		push(rootsOf(m_root.item("scenes", scene), m_file.parents), glm::dmat4(1.0), false);
		while (!open.empty())
		{
			PlacedNode node = open.back();
			open.pop_back();
			node.world = node.world * localOf(nodes[node.index]);
			const std::optional<JsonValue> visibility = extensionOf(nodes[node.index], "KHR_node_visibility");
			const bool hidden = !node.has_mesh || (visibility && !visibility->boolean("visible", true));
			push(nodes[node.index].indices("children", nodes.size()), node.world, hidden);
			node.has_mesh = !hidden;
			placed.push_back(node);
			if (hidden)
			{
				hidden_nodes.add("node '" + nodes[node.index].name() + "'", nodes[node.index].has("mesh") ? 1 : 0);
				continue;
			}
			const std::optional<std::vector<glm::dmat4>> places = instancesOf(m_file, nodes[node.index], left);
			placed.back().has_mesh = !places;
			for (std::size_t i = 0; places && i < places->size(); ++i)
			{
				placed.push_back({node.index, node.world * (*places)[i], i, true});
			}
			left -= places ? places->size() : 0;
		}
		report(m_source.findings, "hidden-nodes", hidden_nodes);
		return placed;
	}

	void cameras(const std::vector<PlacedNode>& nodes)
	{
		const std::vector<JsonValue> cameras = m_root.objects("cameras");
		for (const PlacedNode& placed : nodes)
		{
			const JsonValue node = m_root.item("nodes", placed.index);
			if (const std::optional<std::size_t> camera = node.index("camera", cameras.size()); camera && !placed.instance)
			{
				take(cameras[*camera], node, placed.world);
			}
		}
	}

private:
	// The nodes that a scene lists, except descendants of other listed ones: against the specification, exporters list all nodes.
	static std::vector<std::size_t> rootsOf(const JsonValue& scene, const std::vector<std::size_t>& parents)
	{
		std::vector<std::size_t> roots = scene.indices("nodes", parents.size());
		std::vector<bool> is_listed(parents.size(), false);
		for (const std::size_t root : roots)
		{
			is_listed[root] = true;
		}
		std::erase_if(roots,
					  [&](std::size_t root)
					  {
						  std::size_t above = parents[root];
						  while (above < parents.size() && !is_listed[above])
						  {
							  above = parents[above];
						  }
						  return above < parents.size();
					  });
		return roots;
	}

	void colour(const JsonValue& info, SourceMaterial& made)
	{
		const std::size_t index = info.at("index").indexInto(m_textures.size());
		const std::optional<std::size_t> image = imageOf(m_textures[index]);
		if (made.material.alpha_mode == AlphaMode::opaque)
		{
			const bool named = image && m_images[*image].has("uri");
			const std::string uri = named ? m_images[*image].text("uri") : "";
			if (named && !uri.starts_with("data:"))
			{
				noteMissingFile(m_source, besideLevel(m_file.path, unescaped(uri)));
			}
			return;
		}
		failIf(!image, m_textures[index], "source", "nothing", "an image, since a material is masked by it");
		made.uv_set = static_cast<uint32_t>(info.whole("texCoord", 7).value_or(0));
		if (const std::optional<JsonValue> transform = extensionOf(info, "KHR_texture_transform"))
		{
			made.uv_set = static_cast<uint32_t>(transform->whole("texCoord", 7).value_or(made.uv_set));
			made.uv_of_set = transformOf(*transform);
		}
		made.mask = maskOf(m_textures[index], *image);
	}

	std::optional<std::size_t> imageOf(const JsonValue& texture) const
	{
		for (const char* const name : {"EXT_texture_webp", "KHR_texture_basisu", "MSFT_texture_dds"})
		{
			const std::optional<JsonValue> extension = extensionOf(texture, name);
			if (extension && !texture.has("source"))
			{
				return extension->index("source", m_images.size());
			}
		}
		return texture.index("source", m_images.size());
	}

	int maskOf(const JsonValue& texture, std::size_t image)
	{
		MaskSource mask;
		if (const std::optional<std::size_t> sampler = texture.index("sampler", m_samplers.size()))
		{
			mask.wrap_u = wrapOf(m_samplers[*sampler], "wrapS");
			mask.wrap_v = wrapOf(m_samplers[*sampler], "wrapT");
			mask.nearest = m_samplers[*sampler].whole("magFilter", UINT16_MAX).value_or(9729) == 9728;
		}
		const JsonValue& item = m_images[image];
		const std::string uri = item.text("uri");
		mask.name = "image " + std::to_string(image) + (item.has("name") ? " '" + item.name() + "'" : "");
		if (item.has("uri") && !uri.starts_with("data:"))
		{
			mask.path = besideLevel(m_file.path, unescaped(uri));
			mask.name = unescaped(uri);
		}
		const auto next = static_cast<int>(m_source.masks.size());
		const auto [known, is_new] = m_masks.try_emplace({mask.name, mask.wrap_u, mask.wrap_v, mask.nearest}, next);
		if (!is_new)
		{
			return known->second;
		}
		if (mask.path.empty())
		{
			mask.bytes = item.has("uri")
							 ? dataOf(uri, item).value_or("")
							 : std::string(viewBytes(m_file, item.at("bufferView").indexInto(m_root.count("bufferViews"))));
		}
		m_source.masks.push_back(std::move(mask));
		return next;
	}

	void take(const JsonValue& camera, const JsonValue& node, const glm::dmat4& world)
	{
		LevelCamera made;
		made.name = node.has("name") ? node.text("name") : camera.text("name");
		made.world_from_camera = world;
		const std::string type = camera.text("type");
		failIf(type != "perspective" && type != "orthographic", camera, "type", "\"" + type + "\"", "perspective or orthographic");
		const JsonValue lens = camera.objectNeeded(type);
		made.lens.orthographic = type == "orthographic";
		made.lens.near_m = lens.at("znear").number();
		made.lens.far_m = lens.number("zfar", std::numeric_limits<double>::infinity());
		if (made.lens.orthographic)
		{
			made.lens.half_height_m = lens.at("ymag").number();
			lens.at("zfar").number();
		}
		else
		{
			made.lens.fov_y_rad = lens.at("yfov").number();
		}
		const bool sees = made.lens.orthographic ? made.lens.half_height_m != 0.0
												 : made.lens.near_m > 0.0 && made.lens.fov_y_rad > 0.0 && made.lens.fov_y_rad < kPi;
		failIf(!sees || !(made.lens.far_m > made.lens.near_m), lens, "", "a lens that sees nothing",
			   "0 < yfov < pi, ymag other than 0, and 0 < znear < zfar");
		made.lens.half_height_m = std::fabs(made.lens.half_height_m);
		m_source.cameras.push_back(made);
	}

	GltfFile& m_file;
	JsonValue m_root;
	std::vector<JsonValue> m_textures;
	std::vector<JsonValue> m_images;
	std::vector<JsonValue> m_samplers;
	LevelSource& m_source;
	std::map<std::tuple<std::string, Wrap, Wrap, bool>, int> m_masks; // by name; index into the masks of m_source
};

} // namespace

glm::dmat4 localOf(const JsonValue& node)
{
	const std::vector<double> matrix = node.numbers("matrix", 16);
	if (!matrix.empty())
	{
		return glm::make_mat4(matrix.data());
	}
	const std::vector<double> t = node.numbers("translation", 3);
	const std::vector<double> r = node.numbers("rotation", 4);
	const std::vector<double> s = node.numbers("scale", 3);
	return placeOf(t.empty() ? glm::dvec3(0.0) : glm::dvec3(t[0], t[1], t[2]),
				   r.empty() ? glm::dvec4(0.0, 0.0, 0.0, 1.0) : glm::dvec4(r[0], r[1], r[2], r[3]),
				   s.empty() ? glm::dvec3(1.0) : glm::dvec3(s[0], s[1], s[2]));
}

std::vector<std::string> extrasOf(const JsonValue& item)
{
	std::vector<std::string> pairs;
	const nlohmann::json extras = item.value->value("extras", nlohmann::json());
	for (auto at = extras.begin(); extras.is_object() && at != extras.end(); ++at)
	{
		pairs.push_back(at.key() + "=" + (at->is_string() ? at->get<std::string>() : at->dump()));
	}
	return pairs;
}

LevelSource readGltf(const std::string& path, const LoadSettings& settings, Level& level, std::optional<uint32_t> second_set)
{
	GltfFile file = openGltf(path);
	file.settings = settings;
	file.second_set = second_set;
	if (settings.undo_bake)
	{
		undoBake(file);
	}
	checkGltf(file);
	LevelSource source;
	addOnce(source.files, path);
	for (const std::string& part : file.files)
	{
		addOnce(source.files, part);
	}
	Reader reader(file, source);
	reader.materials();
	const std::vector<PlacedNode> nodes = reader.nodes();
	reader.cameras(nodes);
	const glm::dmat4 world = worldFromFile(settings);
	const double unit = glm::length(glm::dvec3(world[0]));
	for (LevelCamera& camera : source.cameras)
	{
		camera.world_from_camera = rigidOf(world * camera.world_from_camera);
		camera.lens.near_m *= unit;
		camera.lens.far_m *= unit;
		camera.lens.half_height_m *= unit;
	}
	readMeshes(file, nodes, world, source, level);
	return source;
}

} // namespace nook
