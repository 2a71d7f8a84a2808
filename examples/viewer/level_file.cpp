// SPDX-License-Identifier: MIT
#include "level_file.h"

#include <glm/gtc/matrix_transform.hpp>
#include <nlohmann/json.hpp>
#include <png.h>

#include <cstring>
#include <fstream>
#include <iterator>

namespace
{

using Json = nlohmann::json;

void require(bool good, const std::string& line)
{
	if (!good)
	{
		throw Failure(3, line);
	}
}

class Reader
{
public:
	explicit Reader(const std::string& path) : m_path(path)
	{
		std::ifstream file(path, std::ios::binary);
		m_bytes.assign(std::istreambuf_iterator<char>(file), {});
		if (!file || m_bytes.empty())
		{
			throw Failure(2, path + ": cannot be read, expected a file of nook level");
		}
		// Header, then the JSON chunk, then the binary chunk.
		const bool is_glb = m_bytes.size() >= 20 && m_bytes.compare(0, 4, "glTF") == 0 && wordAt(4) == 2;
		require(is_glb, path + ": found no binary glTF 2.0, expected a file of nook level");
		const std::size_t text = wordAt(12);
		require(m_bytes.size() >= 28 && text <= m_bytes.size() - 28, path + ": JSON: found an end too early");
		m_json = Json::parse(m_bytes.begin() + 20, m_bytes.begin() + 20 + static_cast<std::ptrdiff_t>(text));
		m_chunk = 28 + text;
		require(wordAt(20 + text) <= m_bytes.size() - m_chunk, path + ": data: found an end too early");
	}

	LevelFile read()
	{
		for (const Json& node : m_json.at("nodes"))
		{
			for (const char* const other : {"rotation", "scale", "children", node.contains("mesh") ? "matrix" : "mesh"})
			{
				require(!node.contains(other), m_path + ": found a node with " + other + ", expected a file of nook level");
			}
			if (node.contains("mesh"))
			{
				const Json translation = node.value("translation", Json{0.0f, 0.0f, 0.0f});
				m_moved = {translation.at(0), translation.at(1), translation.at(2)};
				for (const Json& primitive : m_json.at("meshes").at(node["mesh"].get<std::size_t>()).at("primitives"))
				{
					add(primitive);
				}
			}
			else if (node.contains("camera"))
			{
				addCamera(node);
			}
		}
		for (const Json& texture : m_json.value("textures", Json::array()))
		{
			addMask(texture);
		}
		for (const Batch& batch : m_level.batches)
		{
			require(batch.mask < static_cast<int>(m_level.masks.size()), m_path + ": found a material without its texture");
		}
		require(!m_level.indices.empty(), m_path + ": found no triangle");
		if (m_level.cameras.empty())
		{
			m_level.cameras.push_back(overview());
		}
		return std::move(m_level);
	}

private:
	std::uint32_t wordAt(std::size_t at) const
	{
		std::uint32_t word = 0;
		std::memcpy(&word, m_bytes.data() + at, sizeof word);
		return word;
	}

	// At least `size` bytes of a view, starting at an offset.
	const char* bytesOf(const Json& view, std::size_t offset, std::size_t size) const
	{
		const std::size_t start = view.value("byteOffset", std::size_t{0});
		const std::size_t length = view.at("byteLength");
		const std::size_t held = m_bytes.size() - m_chunk;
		const bool inside = start <= held && length <= held - start && offset <= length && size <= length - offset;
		require(inside, m_path + ": found numbers outside of the file");
		return m_bytes.data() + m_chunk + start + offset;
	}

	// Tightly packed values, the only kind that `nook level` writes.
	template <class Value> std::vector<Value> values(const Json& index, int component, const char* type) const
	{
		const Json& accessor = m_json.at("accessors").at(index.get<std::size_t>());
		const Json& view = m_json.at("bufferViews").at(accessor.at("bufferView").get<std::size_t>());
		const bool packed = view.value("byteStride", sizeof(Value)) == sizeof(Value) && !accessor.contains("sparse");
		require(packed && accessor.at("componentType") == component && accessor.at("type") == type,
				m_path + ": found numbers of another type, expected a file of nook level");
		const std::size_t count = accessor.at("count");
		require(count <= m_bytes.size() / sizeof(Value), m_path + ": found more numbers than the file holds");
		std::vector<Value> result(count);
		std::memcpy(result.data(), bytesOf(view, accessor.value("byteOffset", std::size_t{0}), count * sizeof(Value)),
					count * sizeof(Value));
		return result;
	}

	void add(const Json& primitive)
	{
		require(primitive.value("mode", 4) == 4, m_path + ": found no triangles, expected a file of nook level");
		const Json& attributes = primitive.at("attributes");
		const auto first_vertex = static_cast<std::uint32_t>(m_level.vertices.size());
		const std::vector<glm::vec3> positions = values<glm::vec3>(attributes.at("POSITION"), 5126, "VEC3");
		std::vector<glm::vec3> normals(positions.size(), glm::vec3(0.0f));
		std::vector<glm::vec2> uvs(positions.size(), glm::vec2(0.0f));
		if (attributes.contains("NORMAL"))
		{
			normals = values<glm::vec3>(attributes["NORMAL"], 5126, "VEC3");
		}
		if (attributes.contains("TEXCOORD_0"))
		{
			uvs = values<glm::vec2>(attributes["TEXCOORD_0"], 5126, "VEC2");
		}
		require(normals.size() == positions.size() && uvs.size() == positions.size(), m_path + ": found attributes of two lengths");
		for (std::size_t i = 0; i < positions.size(); ++i)
		{
			m_level.vertices.push_back({positions[i] + m_moved, normals[i], uvs[i]});
		}
		addBaked(attributes, first_vertex);
		Batch batch = batchOf(m_json.at("materials").at(primitive.at("material").get<std::size_t>()));
		batch.first_index = static_cast<std::uint32_t>(m_level.indices.size());
		for (const std::uint32_t index : values<std::uint32_t>(primitive.at("indices"), 5125, "SCALAR"))
		{
			require(index < positions.size(), m_path + ": found a vertex that is not there");
			m_level.indices.push_back(first_vertex + index);
		}
		batch.index_count = static_cast<std::uint32_t>(m_level.indices.size()) - batch.first_index;
		m_level.batches.push_back(batch);
	}

	// Reads front and back values; a single value is used for both.
	void addBaked(const Json& attributes, std::uint32_t first_vertex)
	{
		require(!attributes.contains("_DIFFERENCE_MASK"), m_path + ": found a difference to masks, expected one to `aov`");
		const bool difference = attributes.contains("_DIFFERENCE");
		const std::string name = difference ? "_DIFFERENCE" : "_VISIBILITY";
		if (!attributes.contains(name))
		{
			return;
		}
		m_level.baked = difference ? Baked::difference : Baked::visibility;
		const std::vector<float> front = values<float>(attributes[name], 5126, "SCALAR");
		const std::vector<float> back =
			attributes.contains(name + "_BACK") ? values<float>(attributes[name + "_BACK"], 5126, "SCALAR") : front;
		const std::size_t count = m_level.vertices.size() - first_vertex;
		require(front.size() == count && back.size() == count, m_path + ": found attributes of two lengths");
		for (std::size_t i = 0; i < count; ++i)
		{
			m_level.vertices[first_vertex + i].baked = {front[i], back[i]};
		}
	}

	static Batch batchOf(const Json& material)
	{
		Batch batch;
		if (material.value("alphaMode", "OPAQUE") != "OPAQUE")
		{
			const Json& surface = material.at("pbrMetallicRoughness");
			batch.cutoff = material.value("alphaCutoff", 0.5f); // BLEND too, which nook treats as a mask
			batch.alpha = surface.at("baseColorFactor").at(3);
			batch.mask = surface.contains("baseColorTexture") ? surface["baseColorTexture"].at("index").get<int>() : -1;
		}
		return batch;
	}

	void addMask(const Json& texture)
	{
		const Json& sampler = m_json.at("samplers").at(texture.at("sampler").get<std::size_t>());
		const Json& image = m_json.at("images").at(texture.at("source").get<std::size_t>());
		const Json& view = m_json.at("bufferViews").at(image.at("bufferView").get<std::size_t>());
		png_image png{};
		png.version = PNG_IMAGE_VERSION;
		const std::size_t size = view.at("byteLength");
		require(png_image_begin_read_from_memory(&png, bytesOf(view, 0, size), size) != 0, m_path + ": mask: " + png.message);
		png.format = PNG_FORMAT_RGBA;
		std::vector<std::uint8_t> rgba(PNG_IMAGE_SIZE(png));
		require(png_image_finish_read(&png, nullptr, rgba.data(), 0, nullptr) != 0, m_path + ": mask: " + png.message);
		Mask& mask = m_level.masks.emplace_back();
		mask.width = static_cast<int>(png.width);
		mask.height = static_cast<int>(png.height);
		mask.wrap_u = sampler.at("wrapS");
		mask.wrap_v = sampler.at("wrapT");
		for (std::size_t i = 3; i < rgba.size(); i += 4)
		{
			mask.alpha.push_back(rgba[i]);
		}
	}

	void addCamera(const Json& node)
	{
		const Json& camera = m_json.at("cameras").at(node.at("camera").get<std::size_t>());
		const Json& lens = camera.at(camera.at("type").get<std::string>());
		Camera& made = m_level.cameras.emplace_back();
		made.name = node.value("name", "");
		made.orthographic = camera["type"] == "orthographic";
		made.fov_y_rad = lens.value("yfov", 1.0f);
		made.half_height_m = lens.value("ymag", 1.0f);
		made.near_m = lens.at("znear");
		made.far_m = lens.value("zfar", std::numeric_limits<float>::infinity());
		for (int i = 0; i < 16; ++i)
		{
			made.world_from_camera[i / 4][i % 4] = node.at("matrix").at(static_cast<std::size_t>(i));
		}
	}

	// An overview from above one corner.
	Camera overview() const
	{
		glm::vec3 least = m_level.vertices.front().position;
		glm::vec3 most = least;
		for (const Vertex& vertex : m_level.vertices)
		{
			least = glm::min(least, vertex.position);
			most = glm::max(most, vertex.position);
		}
		const float size = glm::length(most - least);
		Camera camera;
		camera.name = "overview";
		camera.world_from_camera =
			glm::inverse(glm::lookAt(most + 0.3f * size * glm::vec3(1.0f, 0.5f, 1.0f), 0.5f * (least + most), {0.0f, 1.0f, 0.0f}));
		camera.near_m = 1e-3f * size;
		return camera;
	}

	std::string m_path;
	std::string m_bytes;
	std::size_t m_chunk = 0; // start of the data
	Json m_json;
	glm::vec3 m_moved{0.0f}; // translation of the current node
	LevelFile m_level;
};

} // namespace

void addMoving(LevelFile& level, const LevelFile& moving)
{
	for (Batch batch : moving.batches)
	{
		batch.first_index += static_cast<std::uint32_t>(level.indices.size());
		batch.mask += batch.mask < 0 ? 0 : static_cast<int>(level.masks.size());
		batch.moves = true;
		level.batches.push_back(batch);
	}
	for (const std::uint32_t index : moving.indices)
	{
		level.indices.push_back(static_cast<std::uint32_t>(level.vertices.size()) + index);
	}
	level.vertices.insert(level.vertices.end(), moving.vertices.begin(), moving.vertices.end());
	level.masks.insert(level.masks.end(), moving.masks.begin(), moving.masks.end());
}

LevelFile readLevel(const std::string& path)
{
	try
	{
		return Reader(path).read();
	}
	catch (const Json::exception& error)
	{
		throw Failure(3, path + ": found JSON that nook level does not write (" + error.what() + ")");
	}
}
