// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "glTF 2.0 Specification", ISO/IEC 12113:2022.
#include "scene/level_glb.h"

#include "core/base64.h"
#include "core/decimal.h"
#include "core/file.h"
#include "core/image.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/system.h"
#include "core/words.h"
#include "scene/gltf_file.h"

#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <tuple>

namespace nook
{
namespace
{

using Json = nlohmann::ordered_json;

// Relative to the folder where the program runs.
std::string nearUri(const std::string& path)
{
	std::error_code failed;
	const std::filesystem::path near = std::filesystem::proximate(nativePath(path), failed);
	return (failed ? nativePath(path) : near).generic_string();
}

int wrapCode(Wrap wrap)
{
	return wrap == Wrap::clamp ? 33071 : wrap == Wrap::mirror ? 33648 : 10497;
}

// glTF 2.0, sections 3.8 and 3.9.
class GlbMaterials
{
public:
	// `level` must outlive this object.
	GlbMaterials(const Level& level, bool with_pictures)
		: m_level(level), m_with_pictures(with_pictures), m_material(level.material_list.size(), -1)
	{
	}

	// Does a material use texture coordinates?
	bool hasPicture(uint32_t index) const
	{
		const Material& material = m_level.material_list[index];
		return material.mask >= 0 || (m_with_pictures && !material.picture.empty());
	}

	// The file's number of a level's material, created on first use.
	int indexOf(uint32_t index)
	{
		int& made = m_material[index];
		if (made >= 0)
		{
			return made;
		}
		made = static_cast<int>(materials.size());
		const Material& material = m_level.material_list[index];
		Json pbr = Json::object();
		pbr["metallicFactor"] = 0.0; // metal is black without surroundings
		const bool opaque = material.alpha_mode == AlphaMode::opaque;
		const glm::vec3 colour = m_with_pictures && !material.picture.empty() ? glm::vec3(1.0F) : material.colour;
		if (!opaque || colour != glm::vec3(1.0F))
		{
			const auto decimal = [](float value) // 0.8, not 0.800000011920929
			{
				return numberFrom<double>(shortestDecimal(value)).value();
			};
			pbr["baseColorFactor"] = {decimal(colour.x), decimal(colour.y), decimal(colour.z), opaque ? 1.0 : material.alpha};
		}
		if (hasPicture(index))
		{
			pbr["baseColorTexture"]["index"] = textureOf(material);
		}
		Json item{{"name", material.name}, {"pbrMetallicRoughness", pbr}};
		if (!opaque)
		{
			item["alphaMode"] = material.alpha_mode == AlphaMode::mask ? "MASK" : "BLEND";
		}
		if (material.alpha_mode == AlphaMode::mask)
		{
			item["alphaCutoff"] = material.cutoff;
		}
		item["doubleSided"] = material.two_sided;
		materials.push_back(item);
		return made;
	}

	Json materials = Json::array();
	Json textures = Json::array();
	Json samplers = Json::array();
	Json images = Json::array();       // "bufferView" is set later
	std::vector<std::string> pictures; // PNG files of the images; empty for those with a "uri"

private:
	// Texture, sampler and image share one number.
	int textureOf(const Material& material)
	{
		const std::string picture = m_with_pictures ? material.picture : "";
		const auto [known, is_new] =
			m_textures.try_emplace({material.mask, picture, material.wraps}, static_cast<int>(textures.size()));
		const int made = known->second;
		if (!is_new)
		{
			return made;
		}
		const Mask* const mask = material.mask < 0 ? nullptr : &m_level.masks[static_cast<std::size_t>(material.mask)];
		const int filter = mask != nullptr && mask->nearest ? 9728 : 9729;
		const int distant = mask != nullptr ? filter : 9987;
		const std::array<Wrap, 2> wraps = mask != nullptr ? std::array{mask->wrap_u, mask->wrap_v} : material.wraps;
		textures.push_back({{"sampler", made}, {"source", made}});
		samplers.push_back(
			{{"magFilter", filter}, {"minFilter", distant}, {"wrapS", wrapCode(wraps[0])}, {"wrapT", wrapCode(wraps[1])}});
		if (mask == nullptr)
		{
			images.push_back(
				{{"name", material.name}, {"uri", picture.starts_with("data:") ? picture : escapedUri(nearUri(picture))}});
			pictures.emplace_back();
			return made;
		}
		images.push_back({{"name", mask->name}, {"mimeType", "image/png"}});
		pictures.push_back(picture.empty() ? alphaPngBytes(mask->width_px, mask->height_px, mask->alpha) : masked(*mask, picture));
		return made;
	}

	// A colour picture with a mask as its alpha.
	static std::string masked(const Mask& mask, const std::string& picture)
	{
		const std::vector<uint8_t> bytes = bytesOfBase64(picture.substr(picture.find(',') + 1)).value_or(std::vector<uint8_t>());
		const Image image = picture.starts_with("data:")
								? decodeImage({reinterpret_cast<const char*>(bytes.data()), bytes.size()}, mask.name)
								: readImage(picture);
		return pngWithChannel(image, 3, mask);
	}

	const Level& m_level;
	bool m_with_pictures;
	std::vector<int> m_material; // file number of each material, or −1
	std::map<std::tuple<int, std::string, std::array<Wrap, 2>>, int> m_textures;
};

static_assert(std::endian::native == std::endian::little, "glTF is little-endian, and numbers are written as they lie in memory");

constexpr int kFloats = 5126; // component types
constexpr int kUints = 5125;
constexpr int kVertexData = 34962; // targets of buffer views
constexpr int kIndexData = 34963;

Json listed(glm::dvec3 v)
{
	return {v.x, v.y, v.z};
}

class Writer
{
public:
	// `places`: null, or filled with where the level's vertices are; surroundings then stay out.
	Writer(const Level& level, std::vector<GltfPlace>* places)
		: m_level(level), m_places(places), m_origin(glbOrigin(preciseBounds(level))), m_materials(level, places != nullptr)
	{
		m_slot.resize(level.positions.size());
		m_slot_of.resize(level.positions.size(), 0);
	}

	std::string bytes(std::string_view generator)
	{
		for (const Mesh& mesh : m_level.meshes)
		{
			if (!mesh.around || m_places == nullptr) // belongs to another cell
			{
				add(mesh);
			}
		}
		for (const LevelCamera& camera : m_level.cameras)
		{
			add(camera);
		}
		const std::string chunk = takeBuffer();
		const Json nodes = listOf(m_nodes.size(), [](std::size_t i) { return i; });
		Json root{{"asset", {{"version", "2.0"}, {"generator", generator}}}, {"scene", 0}};
		root["scenes"] = Json::array({Json{{"nodes", nodes}}});
		const std::array<std::pair<const char*, const Json*>, 9> parts{{{"nodes", &m_nodes},
																		{"cameras", &m_cameras},
																		{"meshes", &m_meshes},
																		{"materials", &m_materials.materials},
																		{"textures", &m_materials.textures},
																		{"samplers", &m_materials.samplers},
																		{"images", &m_materials.images},
																		{"accessors", &m_accessors},
																		{"bufferViews", &m_views}}};
		for (const auto& [name, part] : parts)
		{
			if (!part->empty()) // glTF has no empty arrays
			{
				root[name] = *part;
			}
		}
		root["buffers"] = Json::array({Json{{"byteLength", chunk.size()}}});
		return glbContainer(jsonLine(root), chunk, {}, m_level.name);
	}

private:
	void add(const Mesh& mesh)
	{
		std::vector<uint32_t> materials; // in order of first use
		for (std::size_t t = mesh.first_triangle; t < mesh.first_triangle + mesh.triangle_count; ++t)
		{
			addOnce(materials, m_level.materials[t]);
		}
		Json primitives = Json::array();
		for (const uint32_t material : materials)
		{
			primitives.push_back(primitive(mesh, material, primitives.size()));
		}
		if (primitives.empty())
		{
			return;
		}
		Json node{{"name", mesh.name}, {"mesh", m_meshes.size()}};
		if (m_origin != glm::dvec3(0.0))
		{
			node["translation"] = listed(m_origin);
		}
		if (mesh.around)
		{
			node["extras"]["nook_around"] = true;
		}
		if (mesh.closed)
		{
			node["extras"]["nook_closed"] = true;
		}
		m_nodes.push_back(node);
		m_meshes.push_back({{"name", mesh.name}, {"primitives", primitives}});
	}

	Json primitive(const Mesh& mesh, uint32_t material, std::size_t number)
	{
		m_current += 1;
		std::vector<uint32_t> vertices;
		std::vector<uint32_t> triangles;
		std::vector<glm::uvec3> corners;
		std::size_t first_triangle = mesh.first_triangle;
		const std::size_t first_index = m_data[kIndices].size() / sizeof(uint32_t);
		for (std::size_t t = mesh.first_triangle; t < mesh.first_triangle + mesh.triangle_count; ++t)
		{
			first_triangle = vertices.empty() ? t : first_triangle;
			if (m_level.materials[t] == material)
			{
				triangles.push_back(static_cast<uint32_t>(t));
			}
			for (int corner = 0; corner < 3 && m_level.materials[t] == material; ++corner)
			{
				corners.resize(triangles.size());
				corners.back()[corner] = slotOf(m_level.triangles[t][corner], vertices);
				appendRaw(m_data[kIndices], corners.back()[corner]);
			}
		}
		const std::size_t indices = m_data[kIndices].size() / sizeof(uint32_t) - first_index;
		Json attributes{{"POSITION", positions(vertices)}};
		const auto add = [&](const char* name, View view, const char* type, const auto& values)
		{
			attributes[name] = accessor(view, type, m_data[view].size(), vertices.size());
			for (const uint32_t v : vertices)
			{
				appendRaw(m_data[view], values[v]);
			}
		};
		if (std::all_of(vertices.begin(), vertices.end(), [this](uint32_t v) { return m_level.normals[v] != glm::vec3(0.0F); }))
		{
			add("NORMAL", kNormals, "VEC3", m_level.normals);
		}
		if (!m_level.colours.empty() &&
			std::any_of(vertices.begin(), vertices.end(), [this](uint32_t v) { return m_level.colours[v] != glm::vec3(1.0F); }))
		{
			add("COLOR_0", kColours, "VEC3", m_level.colours);
		}
		if (m_materials.hasPicture(material))
		{
			add("TEXCOORD_0", kUvs, "VEC2", m_level.uvs);
		}
		if (m_places != nullptr)
		{
			const auto numbered =
				listOf(vertices.size(), [&](std::size_t v) { return std::pair(static_cast<uint32_t>(v), vertices[v]); });
			m_places->push_back({m_nodes.size(),
								 {},
								 number,
								 vertices.size(),
								 first_triangle,
								 std::move(triangles),
								 m_meshes.size(),
								 false,
								 numbered,
								 std::move(corners)});
		}
		return {{"attributes", attributes},
				{"indices", accessor(kIndices, "SCALAR", first_index * sizeof(uint32_t), indices)},
				{"material", m_materials.indexOf(material)}};
	}

	uint32_t slotOf(uint32_t vertex, std::vector<uint32_t>& vertices)
	{
		if (m_slot_of[vertex] != m_current)
		{
			m_slot_of[vertex] = m_current;
			m_slot[vertex] = static_cast<uint32_t>(vertices.size());
			vertices.push_back(vertex);
		}
		return m_slot[vertex];
	}

	std::size_t positions(const std::vector<uint32_t>& vertices)
	{
		const std::size_t made = accessor(kPositions, "VEC3", m_data[kPositions].size(), vertices.size());
		glm::vec3 least(std::numeric_limits<float>::max());
		glm::vec3 most(std::numeric_limits<float>::lowest());
		for (const uint32_t v : vertices)
		{
			const glm::vec3 position(m_level.positions[v] - m_origin);
			least = glm::min(least, position);
			most = glm::max(most, position);
			appendRaw(m_data[kPositions], position);
		}
		m_accessors[made]["min"] = listed(least);
		m_accessors[made]["max"] = listed(most);
		return made;
	}

	// Each kind of data has its own view, placed at the end.
	enum View : std::size_t
	{
		kPositions,
		kNormals,
		kUvs,
		kColours,
		kIndices,
		kViews,
	};
	std::size_t accessor(View view, const char* type, std::size_t offset, std::size_t count)
	{
		m_accessors.push_back({{"bufferView", std::size_t{view}},
							   {"byteOffset", offset},
							   {"componentType", view == kIndices ? kUints : kFloats},
							   {"count", count},
							   {"type", type}});
		return m_accessors.size() - 1;
	}

	void add(const LevelCamera& camera)
	{
		const Lens& lens = camera.lens;
		Json item{{"name", camera.name}};
		if (lens.orthographic)
		{
			item["type"] = "orthographic";
			item["orthographic"] = {{"xmag", lens.half_height_m},
									{"ymag", lens.half_height_m},
									{"zfar", std::isinf(lens.far_m) ? kFarthest_m : lens.far_m},
									{"znear", lens.near_m}};
		}
		else
		{
			item["type"] = "perspective";
			item["perspective"] = {{"yfov", lens.fov_y_rad}, {"znear", lens.near_m}};
			if (!std::isinf(lens.far_m))
			{
				item["perspective"]["zfar"] = lens.far_m;
			}
		}
		const double* const numbers = glm::value_ptr(camera.world_from_camera);
		const Json matrix = std::vector(numbers, numbers + 16);
		m_nodes.push_back({{"name", camera.name}, {"camera", m_cameras.size()}, {"matrix", matrix}});
		m_cameras.push_back(item);
	}

	// Appends the views in order, then the pictures; numbers the accessors and images that refer to them.
	std::string takeBuffer()
	{
		std::string buffer;
		std::array<std::size_t, kViews> number{};
		constexpr std::array<std::size_t, kViews> kStrides{12, 12, 8, 12, 0};
		for (std::size_t i = 0; i < kViews; ++i)
		{
			number[i] = m_views.size();
			if (!m_data[i].empty())
			{
				addView(buffer, m_data[i]);
				m_views.back()["target"] = i == kIndices ? kIndexData : kVertexData;
				if (i != kIndices)
				{
					m_views.back()["byteStride"] = kStrides[i];
				}
			}
		}
		for (Json& accessor : m_accessors)
		{
			accessor["bufferView"] = number[accessor["bufferView"].get<std::size_t>()];
		}
		for (std::size_t i = 0; i < m_materials.pictures.size(); ++i)
		{
			if (m_materials.pictures[i].empty())
			{
				continue;
			}
			m_materials.images[i]["bufferView"] = m_views.size();
			addView(buffer, m_materials.pictures[i]);
		}
		return buffer;
	}

	void addView(std::string& buffer, std::string& bytes)
	{
		refuseInputIf(bytes.size() > kMaxFileBytes - buffer.size(), m_level.name,
					  std::to_string(m_level.triangles.size()) + " triangles", "what a file of 1 GiB holds", ExitCode::unsupported);
		m_views.push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
		buffer += bytes;
		padTo4(buffer);
		std::string().swap(bytes);
	}

	const Level& m_level;
	std::vector<GltfPlace>* m_places;
	glm::dvec3 m_origin;

	// For the current primitive: the number of each level vertex, and the primitive that assigned it.
	std::vector<uint32_t> m_slot;
	std::vector<uint64_t> m_slot_of;
	uint64_t m_current = 0;

	GlbMaterials m_materials;
	std::array<std::string, kViews> m_data; // of each view
	Json m_nodes = Json::array();
	Json m_cameras = Json::array();
	Json m_meshes = Json::array();
	Json m_accessors = Json::array();
	Json m_views = Json::array();
};

} // namespace

// glTF 2.0, section 4.4.
std::string glbContainer(std::string text, std::string_view chunk, std::string_view others, const std::string& name)
{
	text.resize((text.size() + 3) / 4 * 4, ' ');
	const std::size_t padded = (chunk.size() + 3) / 4 * 4;
	const std::size_t size = 12 + 8 + text.size() + (padded > 0 ? 8 + padded : 0) + others.size();
	refuseInputIf(size > kMaxFileBytes, name, "a file of " + std::to_string(size) + " bytes", "at most 1 GiB",
				  ExitCode::unsupported);
	std::string bytes = "glTF";
	appendRaw(bytes, uint32_t{2});
	appendRaw(bytes, static_cast<uint32_t>(size));
	appendRaw(bytes, static_cast<uint32_t>(text.size()));
	bytes += "JSON" + text;
	if (padded > 0)
	{
		appendRaw(bytes, static_cast<uint32_t>(padded));
		bytes.append("BIN\0", 4);
		bytes += chunk;
		bytes.append(padded - chunk.size(), '\0');
	}
	return bytes.append(others);
}

std::string pngWithChannel(const Image& image, std::size_t channel, const Mask& mask)
{
	const std::size_t channels = image.channels.size();
	std::vector<uint8_t> rgba;
	for (std::size_t i = 0; i < image.values.size(); i += channels)
	{
		const glm::dvec2 pixel(i / channels % static_cast<std::size_t>(image.width_px),
							   i / channels / static_cast<std::size_t>(image.width_px));
		const double value = alphaAt(mask, (pixel + 0.5) / glm::dvec2(image.width_px, image.height_px));
		for (std::size_t k = 0; k < 4; ++k)
		{
			const std::size_t from = k == 3 ? channels - 1 : channels < 3 ? 0 : k;
			const double given = k == 3 && channels % 2 != 0 ? 1.0 : static_cast<double>(image.values[i + from]);
			rgba.push_back(static_cast<uint8_t>(255.0 * std::clamp(k == channel ? value : given, 0.0, 1.0) + 0.5));
		}
	}
	return pngBytes(image.width_px, image.height_px, std::span<const uint8_t>(rgba), {});
}

glm::dvec3 glbOrigin(const Bounds& bounds)
{
	const glm::dvec3 reach = glm::max(glm::abs(bounds.least), glm::abs(bounds.most));
	return std::max({reach.x, reach.y, reach.z}) < kLarge_m ? glm::dvec3(0.0) : glm::floor(0.5 * (bounds.least + bounds.most));
}

std::string levelGlb(const Level& level, std::string_view generator, std::vector<GltfPlace>* places)
{
	assert(!level.triangles.empty());
	if (places != nullptr)
	{
		checkPictures(level);
	}
	return Writer(level, places).bytes(generator);
}

void checkPictures(const Level& level)
{
	for (const Material& material : level.material_list)
	{
		if (material.mask >= 0 && material.picture_outside)
		{
			refuseInput(level.files.front() + ": picture of material '" + material.name + "'",
						material.picture + ", which is outside the level's folder", "a file in it (allow-outside permits others)");
		}
	}
}

} // namespace nook
