// SPDX-License-Identifier: GPL-3.0-or-later
// This work is based on: Khronos Group, "glTF 2.0 Specification", ISO/IEC 12113:2022, sections 3.6, 3.7 and 4.4.
#include "scene/gltf_edit.h"

#include "core/base64.h"
#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_text.h"

#include <glm/common.hpp>

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <set>
#include <tuple>
#include <utility>

namespace nook
{
namespace
{

using Document = nlohmann::ordered_json;

constexpr const char* kRecord = "nook"; // in asset.extras
constexpr std::size_t kNoNumber = SIZE_MAX;
constexpr std::size_t kTries = 64; // sets of values that a primitive is compared with: with all, a forest would take forever

template <class Value> void appendRaw(std::string& bytes, const Value& value)
{
	bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

void pad(std::string& bytes)
{
	bytes.resize((bytes.size() + 3) / 4 * 4, '\0');
}

std::size_t numberIn(const Document& item, const std::string& field, std::size_t otherwise = kNoNumber)
{
	const auto found = item.find(field);
	return found != item.end() && found->is_number_unsigned() ? found->get<std::size_t>() : otherwise;
}

std::string textIn(const Document& item, const char* field)
{
	const auto found = item.find(field);
	return found != item.end() && found->is_string() ? found->get<std::string>() : "";
}

// Removes a field, and its holder if that becomes empty.
void eraseIn(Document& item, const char* holder, const char* field)
{
	const auto found = item.find(holder);
	if (found != item.end() && found->is_object() && found->erase(field) > 0 && found->empty())
	{
		item.erase(holder);
	}
}

// Repeats in `to` what was changed in `from`, and keeps the order of members.
void follow(Document& to, const nlohmann::json& from)
{
	if (to.is_object() && from.is_object())
	{
		for (auto at = to.begin(); at != to.end();)
		{
			if (from.contains(at.key()))
			{
				++at;
			}
			else
			{
				at = to.erase(at);
			}
		}
		for (const auto& [name, value] : from.items())
		{
			follow(to[name], value);
		}
	}
	else if (to.is_array() && from.is_array())
	{
		for (std::size_t i = 0; i < from.size(); ++i)
		{
			follow(to[i], from[i]);
		}
	}
	else if (to != Document(from))
	{
		to = Document(from);
	}
}

// Values of a bake that become one attribute.
struct Channel
{
	std::string name; // in the file; empty: the first free texture coordinates
	const float* values = nullptr;
	std::size_t size = 1; // numbers per vertex
	bool is_back = false;
	float unset = 1.0F;
};

// Values that primitives with the same positions share.
struct ValueGroup
{
	std::vector<float> numbers; // of all channels for each vertex; NaN where no triangle uses it
	bool two_sided = false;
	std::size_t color = kNoNumber; // accessor of a COLOR_0 to multiply
	std::vector<std::pair<std::string, std::size_t>> accessors;
};

// A mesh with separate values: at one node, or at all.
struct MeshUnit
{
	std::size_t mesh = 0;
	std::vector<std::size_t> nodes;
	std::map<std::size_t, std::vector<const GltfPlace*>> primitives;
	std::map<std::size_t, std::size_t> groups; // per primitive
};

class Editor
{
public:
	// `output`: a name that says the form of the file to make.
	Editor(GltfFile file, const GltfBake& bake, const std::string& output)
		: m_file(std::move(file)), m_bake(bake), m_json(Document::parse(m_file.text))
	{
		const std::string ending = endingOf(output);
		m_to_binary = ending == ".glb" || (ending != ".gltf" && m_file.is_binary);
		assert(m_to_binary || !m_file.is_binary);
		checkGltf(m_file);
		if (!m_json["asset"].value("extras", Document::object()).is_object())
		{
			fail("asset.extras", "no object", "one, or nothing", ExitCode::unsupported);
		}
		removeBake();
		decompress();
		if (!m_compression.empty() || m_to_binary != m_file.is_binary)
		{
			gather();
		}
		dropEmpty(m_json);
		m_before = m_json;
		m_view_before = items("bufferViews").size();
		readChannels();
	}

	void add(std::span<const GltfPlace> places, GltfBaked& made)
	{
		made.compression = m_compression;
		made.front.assign(m_bake.visibility.begin(), m_bake.visibility.end());
		made.back.assign(m_bake.back.begin(), m_bake.back.end());
		std::vector<MeshUnit> units = unitsOf(places);
		for (const auto& [mesh, count] : m_placements)
		{
			made.shared_meshes += count > 1 ? 1U : 0U;
		}
		for (MeshUnit& unit : units)
		{
			for (const auto& [primitive, at] : unit.primitives)
			{
				if (m_width > 0)
				{
					unit.groups[primitive] = groupOf(primitiveOf(unit.mesh, primitive), meanOf(at));
				}
			}
		}
		for (ValueGroup& group : m_groups)
		{
			addValues(group);
		}
		addMeshes(units, made);
		if (!m_bake.visibility.empty())
		{
			store(units, made);
		}
		if (m_bake.instances == BakeInstances::attribute)
		{
			addFactors(places, made);
		}
		if (!m_bake.png.empty())
		{
			addTexture(units);
		}
		for (const std::string& bytes : m_added)
		{
			made.bytes_added += bytes.size();
		}
		made.kept_alpha = m_kept_alpha.size();
	}

	std::string take(const std::string& output)
	{
		const bool in_chunk = m_to_binary && chunkIsFirst();
		std::string data;
		addViews(in_chunk ? chunk() : data, in_chunk);
		if (!data.empty())
		{
			items("buffers").push_back({{"byteLength", data.size()}, {"uri", dataUri(data)}});
		}
		dropEmpty(m_json);
		const Document undo = Document::diff(m_json, m_before);
		rebase(output);
		if (!m_bake.record.is_null())
		{
			Document& record = m_json["asset"]["extras"][kRecord];
			record = m_bake.record;
			record.update(stateOf());
			record["undo"] = undo;
		}
		const bool lines = m_file.text.find('\n') < m_file.text.size() - 1; // some programs end their one line
		return m_to_binary ? glbContainer(jsonLine(m_json), chunk(), m_file.others, m_file.path)
			   : lines     ? jsonFile(m_json)
						   : jsonLine(m_json) + "\n";
	}

private:
	[[noreturn]] void fail(const std::string& where, const std::string& found, const std::string& expected,
						   ExitCode code = ExitCode::invalid_input) const
	{
		throw Error(code, m_file.path + ": " + where + ": found " + found + ", expected " + expected);
	}

	Document& items(const char* name)
	{
		Document& list = m_json[name];
		list = list.is_null() ? Document::array() : std::move(list);
		return list;
	}

	// glTF has no empty lists: they are what items() made, or what is left of extensions.
	static void dropEmpty(Document& json)
	{
		for (auto at = json.begin(); at != json.end();)
		{
			if (at->is_array() && at->empty() && at.key() != "extras")
			{
				at = json.erase(at);
			}
			else
			{
				++at;
			}
		}
	}

	Document& primitiveOf(std::size_t mesh, std::size_t primitive)
	{
		return items("meshes")[mesh]["primitives"][primitive];
	}

	Document materialOf(const Document& primitive)
	{
		const std::size_t index = numberIn(primitive, "material");
		return index == kNoNumber ? Document::object() : items("materials")[index];
	}

	// Is the alpha of its colours coverage, which --to color-alpha leaves alone?
	bool keepsAlpha(const Document& primitive)
	{
		return m_bake.target == BakeTarget::color_alpha && materialOf(primitive).value("alphaMode", "OPAQUE") != "OPAQUE";
	}

	std::string& chunk()
	{
		return m_gathered ? m_gathered_bytes : m_file.chunk;
	}

	// Changes when another program writes the file.
	Document stateOf()
	{
		std::size_t bytes = 0;
		for (const Document& buffer : items("buffers"))
		{
			bytes += numberIn(buffer, "byteLength", 0);
		}
		return {{"accessors", items("accessors").size()}, {"bytes", bytes}, {"generator", textIn(m_json["asset"], "generator")}};
	}

	// Undoes an earlier bake. Where another program has changed the file since, the numbers to undo it mean nothing: values are
	// then replaced where they are found.
	void removeBake()
	{
		const Document extras = m_json["asset"].value("extras", Document::object());
		if (!extras.contains(kRecord) || !extras[kRecord].is_object())
		{
			return;
		}
		const Document& record = extras[kRecord];
		m_earlier = textIn(record, "to");
		const Document state = stateOf();
		eraseIn(m_json["asset"], "extras", kRecord);
		for (const auto& [name, value] : state.items())
		{
			if (!record.contains(name) || record[name] != value)
			{
				return;
			}
		}
		try
		{
			m_json = m_json.patch(record.value("undo", Document::array()));
		}
		catch (const Document::exception&)
		{
			fail("asset.extras.nook.undo", "no patch of this file", "what nook bake wrote");
		}
		m_earlier.clear();
		m_file.json = nlohmann::json::parse(jsonLine(m_json)); // anybody may have written the patch
		m_file.buffers.clear();
		m_file.decoded.clear();
		checkGltf(m_file);
	}

	void decompress()
	{
		constexpr std::array<const char*, 2> kCompressions{"KHR_draco_mesh_compression", "EXT_meshopt_compression"};
		for (const char* const list : {"extensionsUsed", "extensionsRequired"})
		{
			Document& names = items(list);
			for (const char* const name : kCompressions)
			{
				const auto found = std::find(names.begin(), names.end(), name);
				if (found != names.end())
				{
					m_compression = name == kCompressions[0] || m_compression == "draco" ? "draco" : "meshopt";
					names.erase(found);
				}
			}
		}
		if (m_compression.empty())
		{
			return;
		}
		nlohmann::json made = m_file.json;
		for (const char* const list : {"extensionsUsed", "extensionsRequired"})
		{
			made[list] = m_json.value(list, Document::array());
		}
		follow(m_json, made);
		for (Document& view : items("bufferViews"))
		{
			eraseIn(view, "extensions", kCompressions[1]);
		}
		for (Document& mesh : items("meshes"))
		{
			for (Document& primitive : mesh["primitives"])
			{
				eraseIn(primitive, "extensions", kCompressions[0]);
				setBounds(numberIn(primitive["attributes"], "POSITION"));
			}
		}
	}

	// Compression rounds positions, whose bounds an accessor states.
	void setBounds(std::size_t index)
	{
		if (index == kNoNumber || items("accessors")[index]["componentType"] != 5126U)
		{
			return;
		}
		const GltfValues values(m_file, index);
		glm::dvec3 least(std::numeric_limits<double>::max());
		glm::dvec3 most = -least;
		for (std::size_t i = 0; i < values.count(); ++i)
		{
			least = glm::min(least, values.vec3(i));
			most = glm::max(most, values.vec3(i));
		}
		items("accessors")[index]["min"] = {least.x, least.y, least.z};
		items("accessors")[index]["max"] = {most.x, most.y, most.z};
	}

	// Puts all views into one buffer.
	void gather()
	{
		std::map<std::tuple<std::size_t, std::size_t, std::size_t>, std::size_t> known;
		for (std::size_t i = 0; i < items("bufferViews").size(); ++i)
		{
			Document& view = items("bufferViews")[i];
			const std::string_view bytes = viewBytes(m_file, i);
			pad(m_gathered_bytes);
			const auto [at, is_new] = known.try_emplace(
				{numberIn(view, "buffer", 0), numberIn(view, "byteOffset", 0), bytes.size()}, m_gathered_bytes.size());
			m_gathered_bytes += is_new ? bytes : std::string_view();
			view["buffer"] = 0U;
			view["byteOffset"] = at->second;
		}
		m_gathered = true;
		Document buffer{{"byteLength", m_gathered_bytes.size()}};
		if (!m_to_binary)
		{
			buffer["uri"] = dataUri(m_gathered_bytes);
		}
		m_json["buffers"] = Document::array();
		m_json["buffers"].push_back(std::move(buffer));
	}

	void readChannels()
	{
		const auto numbersOf = [](const auto& values)
		{
			return reinterpret_cast<const float*>(values.data());
		};
		const bool uvs = m_bake.visibility.empty();
		const float unset = !uvs && m_bake.kind == BakedKind::visibility ? 1.0F : 0.0F;
		m_attribute = m_bake.target == BakeTarget::visibility ? std::string(kBakedNames[static_cast<std::size_t>(m_bake.kind)])
															  : m_bake.attribute;
		const auto take = [&](const std::string& name, const auto& values, std::size_t size, bool back, float empty)
		{
			if (!values.empty())
			{
				m_channels.push_back({name, numbersOf(values), size, back, empty});
				m_width += size;
			}
		};
		take(m_attribute, m_bake.visibility, 1, false, unset);
		take(m_attribute + "_BACK", m_bake.back, 1, true, unset);
		take("_BENT_NORMAL", m_bake.bent, 3, false, 0.0F);
		take("_BENT_NORMAL_BACK", m_bake.bent_back, 3, true, 0.0F);
		take("", m_bake.uvs, 2, false, 0.0F);
		m_colors = m_bake.color || m_bake.target == BakeTarget::color || m_bake.target == BakeTarget::color_alpha;
		if (m_colors && m_earlier.starts_with("color"))
		{
			fail("COLOR_0", "an earlier bake in a file that another program has changed", "the file before that bake");
		}
	}

	std::vector<MeshUnit> unitsOf(std::span<const GltfPlace> places)
	{
		std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;
		std::vector<MeshUnit> units;
		const GltfPlace* last = nullptr;
		for (const GltfPlace& place : places)
		{
			const std::size_t mesh = items("nodes")[place.node]["mesh"].get<std::size_t>();
			const std::size_t node = m_bake.instances == BakeInstances::separate ? place.node : 0;
			const auto [at, is_new] = known.try_emplace({mesh, node}, units.size());
			if (is_new)
			{
				units.emplace_back().mesh = mesh;
			}
			MeshUnit& unit = units[at->second];
			unit.primitives[place.primitive].push_back(&place);
			if (unit.nodes.empty() || unit.nodes.back() != place.node)
			{
				unit.nodes.push_back(place.node);
			}
			m_placements[mesh] += last == nullptr || !isSamePlacement(*last, place) ? 1U : 0U;
			last = &place;
		}
		return units;
	}

	static bool isSamePlacement(const GltfPlace& a, const GltfPlace& b)
	{
		return a.node == b.node && a.instance == b.instance;
	}

	// The mean over the places of a primitive, for all channels.
	std::vector<float> meanOf(const std::vector<const GltfPlace*>& places) const
	{
		std::vector<float> sums(places.front()->count * m_width, std::numeric_limits<float>::quiet_NaN());
		std::vector<float> times(places.front()->count, 0.0F);
		for (const GltfPlace* const place : places)
		{
			for (const auto& [vertex, of_level] : place->vertices)
			{
				float* to = &sums[vertex * m_width];
				for (const Channel& channel : m_channels)
				{
					for (std::size_t i = 0; i < channel.size; ++i, ++to)
					{
						const float value = channel.values[of_level * channel.size + i];
						*to = times[vertex] == 0.0F ? value : *to + value;
					}
				}
				times[vertex] += 1.0F;
			}
		}
		for (std::size_t i = 0; i < sums.size(); ++i)
		{
			sums[i] /= std::max(times[i / m_width], 1.0F);
		}
		return sums;
	}

	std::size_t groupOf(const Document& primitive, std::vector<float> numbers)
	{
		const Document& attributes = primitive["attributes"];
		checkTarget(attributes);
		const bool two_sided = materialOf(primitive).value("doubleSided", false);
		const std::size_t color = m_colors ? numberIn(attributes, "COLOR_0") : kNoNumber;
		std::vector<std::size_t>& known = m_groups_of[{numberIn(attributes, "POSITION"), color, two_sided}];
		for (std::size_t i = known.size() - std::min(known.size(), kTries); i < known.size(); ++i)
		{
			if (merge(m_groups[known[i]].numbers, numbers))
			{
				return known[i];
			}
		}
		known.push_back(m_groups.size());
		m_groups.push_back({std::move(numbers), two_sided, color, {}});
		return known.back();
	}

	// Takes values of other vertices, unless a vertex has different ones.
	bool merge(std::vector<float>& numbers, const std::vector<float>& other) const
	{
		for (std::size_t i = 0; i < numbers.size(); ++i)
		{
			if (!std::isnan(numbers[i]) && !std::isnan(other[i]) && numbers[i] != other[i])
			{
				return false;
			}
		}
		for (std::size_t i = 0; i < numbers.size(); ++i)
		{
			numbers[i] = std::isnan(numbers[i]) ? other[i] : numbers[i];
		}
		return true;
	}

	// Throws unless the attribute is free or held a bake.
	void checkTarget(const Document& attributes)
	{
		const std::size_t found = m_attribute.empty() ? kNoNumber : numberIn(attributes, m_attribute);
		if (found == kNoNumber)
		{
			return;
		}
		if (m_bake.target == BakeTarget::texcoord && m_earlier != textIn(m_bake.record, "to"))
		{
			int free = 0;
			while (attributes.contains("TEXCOORD_" + std::to_string(free)))
			{
				free += 1;
			}
			fail(m_attribute, "it in use", "a set that is free, as --to texcoord:" + std::to_string(free));
		}
		const Document& accessor = items("accessors")[found];
		if (m_bake.target != BakeTarget::texcoord && (accessor["type"] != "SCALAR" || accessor["componentType"] != 5126U))
		{
			fail(m_attribute, "an accessor of " + textIn(accessor, "type") + ", component type " + accessor["componentType"].dump(),
				 "SCALAR of 5126, as of an earlier bake, or none");
		}
	}

	// Appends to the view of elements of that size.
	std::size_t addAccessor(const char* type, uint64_t component, std::size_t count, const std::string& bytes)
	{
		const auto [known, is_new] = m_view_of_size.try_emplace(bytes.size() / count, m_added.size());
		if (is_new)
		{
			m_added.emplace_back();
			items("bufferViews").push_back({{"byteStride", known->first}, {"target", 34962U}});
		}
		std::string& to = m_added[known->second];
		if (bytes.size() > kMaxFileBytes - std::min(kMaxFileBytes, to.size()))
		{
			fail("", "more than 1 GiB of values", "less, as with --instances shared", ExitCode::unsupported);
		}
		items("accessors")
			.push_back({{"bufferView", m_view_before + known->second},
						{"byteOffset", to.size()},
						{"componentType", component},
						{"count", count},
						{"type", type}});
		to += bytes;
		return items("accessors").size() - 1;
	}

	void addValues(ValueGroup& group)
	{
		const bool in_color = m_bake.target == BakeTarget::color || m_bake.target == BakeTarget::color_alpha;
		const bool pairs = m_bake.target == BakeTarget::texcoord;
		std::size_t at = 0;
		for (const Channel& channel : m_channels)
		{
			const bool is_value = channel.size == 1 && (in_color || (pairs && channel.is_back)); // stored with another, or not
			if (!is_value && (group.two_sided || !channel.is_back))
			{
				const std::size_t width = pairs && channel.size == 1 ? 2 : channel.size;
				const bool has_back = width == 2 && group.two_sided && !m_bake.back.empty();
				std::string bytes;
				for (std::size_t v = at; v < group.numbers.size(); v += m_width)
				{
					const bool unset = std::isnan(group.numbers[v]);
					for (std::size_t i = 0; i < width; ++i)
					{
						const std::size_t from = channel.size == 1 ? (has_back ? v + i : v) : v + i;
						appendRaw(bytes, unset ? (channel.size == 3 && i == 1 ? 1.0F : channel.unset) : group.numbers[from]);
					}
				}
				constexpr std::array<const char*, 4> kTypes{"", "SCALAR", "VEC2", "VEC3"};
				group.accessors.emplace_back(channel.name, addAccessor(kTypes[width], 5126, group.numbers.size() / m_width, bytes));
			}
			at += channel.size;
		}
		if (m_colors)
		{
			group.accessors.emplace_back("COLOR_0", addColor(group));
		}
	}

	// A colour shows the mean of a vertex's sides.
	float colorOf(const ValueGroup& group, std::size_t v) const
	{
		const float front = group.numbers[v * m_width];
		const bool both = group.two_sided && !m_bake.back.empty();
		return std::isnan(front) ? 1.0F : both ? 0.5F * (front + group.numbers[v * m_width + 1]) : front;
	}

	// An existing COLOR_0 times the values, in its own type, or grey in 8 bits.
	std::size_t addColor(const ValueGroup& group)
	{
		const bool alpha = m_bake.target == BakeTarget::color_alpha;
		std::optional<GltfValues> base;
		uint64_t component = 5121;
		std::size_t given = 0;
		if (group.color != kNoNumber)
		{
			base.emplace(m_file, group.color);
			component = numberIn(items("accessors")[group.color], "componentType");
			given = items("accessors")[group.color]["type"] == "VEC3" ? 3 : 4;
		}
		const std::size_t channels = given == 3 && !alpha ? 3 : 4;
		const std::size_t count = group.numbers.size() / m_width;
		std::string bytes;
		for (std::size_t v = 0; v < count; ++v)
		{
			const float value = colorOf(group, v);
			for (std::size_t i = 0; i < channels; ++i)
			{
				const float before = i < given ? static_cast<float>(base->number(v, i)) : 1.0F;
				const float after = (i == 3) == alpha ? before * value : before;
				if (component == 5126)
				{
					appendRaw(bytes, after);
				}
				else if (component == 5123)
				{
					appendRaw(bytes, static_cast<uint16_t>(after * 65535.0F + 0.5F));
				}
				else
				{
					appendRaw(bytes, static_cast<uint8_t>(after * 255.0F + 0.5F));
				}
			}
			pad(bytes);
		}
		const std::size_t made = addAccessor(channels == 3 ? "VEC3" : "VEC4", component, count, bytes);
		if (component != 5126)
		{
			items("accessors")[made]["normalized"] = true;
		}
		return made;
	}

	// Gives the primitives their accessors, in copies of meshes where a mesh has several sets of values.
	void addMeshes(const std::vector<MeshUnit>& units, GltfBaked& made)
	{
		std::map<std::size_t, Document> originals;
		for (const MeshUnit& unit : units)
		{
			originals.try_emplace(unit.mesh, items("meshes")[unit.mesh]);
		}
		std::map<std::pair<std::size_t, std::map<std::size_t, std::size_t>>, std::size_t> known;
		std::set<std::size_t> used;
		for (const MeshUnit& unit : units)
		{
			const auto [at, is_new] = known.try_emplace({unit.mesh, unit.groups}, unit.mesh);
			if (is_new && !used.insert(unit.mesh).second)
			{
				at->second = items("meshes").size();
				items("meshes").push_back(originals[unit.mesh]);
				made.copies += 1;
			}
			for (const auto& [primitive, group] : unit.groups)
			{
				if (is_new)
				{
					setAttributes(primitiveOf(at->second, primitive), m_groups[group]);
				}
			}
			for (const std::size_t node : unit.nodes)
			{
				items("nodes")[node]["mesh"] = at->second;
			}
		}
	}

	void setAttributes(Document& primitive, const ValueGroup& group)
	{
		Document& attributes = primitive["attributes"];
		for (const auto& [name, accessor] : group.accessors)
		{
			if (name == "COLOR_0" && keepsAlpha(primitive))
			{
				m_kept_alpha.insert(numberIn(primitive, "material"));
				continue;
			}
			if (!name.empty() && m_bake.target != BakeTarget::texcoord)
			{
				attributes[name] = accessor;
				continue;
			}
			// Sets have no gaps: free ones below get the same accessor.
			for (int set = 0;; ++set)
			{
				const std::string each = "TEXCOORD_" + std::to_string(set);
				const bool is_free = !attributes.contains(each);
				if (is_free || each == name)
				{
					attributes[each] = accessor;
				}
				if (name.empty() && is_free)
				{
					m_set_of_material[numberIn(primitive, "material")] = set;
				}
				if (name.empty() ? is_free : each == name)
				{
					break;
				}
			}
		}
	}

	// Gives the level's vertices the values they have in the file.
	void store(const std::vector<MeshUnit>& units, GltfBaked& made)
	{
		const bool color = m_bake.target == BakeTarget::color || m_bake.target == BakeTarget::color_alpha;
		for (const MeshUnit& unit : units)
		{
			for (const auto& [primitive, places] : unit.primitives)
			{
				const ValueGroup& group = m_groups[unit.groups.at(primitive)];
				const bool none = keepsAlpha(primitiveOf(unit.mesh, primitive));
				for (const GltfPlace* const place : places)
				{
					for (const auto& [vertex, of_level] : place->vertices)
					{
						made.front[of_level] = none ? 1.0F : color ? colorOf(group, vertex) : group.numbers[vertex * m_width];
						if (!made.back.empty())
						{
							made.back[of_level] = color ? made.front[of_level] : group.numbers[vertex * m_width + 1];
						}
					}
				}
			}
		}
	}

	// For each placement of a mesh the factor of the mean with the least squared error.
	void addFactors(std::span<const GltfPlace> places, GltfBaked& made)
	{
		std::map<std::size_t, std::vector<float>> of_node; // with instances
		for (std::size_t first = 0; first < places.size();)
		{
			std::size_t end = first + 1;
			while (end < places.size() && isSamePlacement(places[first], places[end]))
			{
				end += 1;
			}
			const GltfPlace& place = places[first];
			Document& node = items("nodes")[place.node];
			if (m_placements[numberIn(node, "mesh")] > 1)
			{
				const float factor = factorOf(places.subspan(first, end - first), made);
				if (place.instance)
				{
					of_node[place.node].resize(*place.instance + 1, 1.0F);
					of_node[place.node].back() = factor;
				}
				else if (node.value("extras", Document::object()).is_object())
				{
					node["extras"]["nook_visibility"] = factor;
				}
				else
				{
					fail("nodes[" + std::to_string(place.node) + "].extras", "no object", "one, or nothing", ExitCode::unsupported);
				}
			}
			first = end;
		}
		for (auto& [node, factors] : of_node)
		{
			Document& attributes = items("nodes")[node]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
			factors.resize(numberIn(items("accessors")[attributes.begin()->get<std::size_t>()], "count"), 1.0F);
			std::string bytes;
			for (const float factor : factors)
			{
				appendRaw(bytes, factor);
			}
			attributes["_VISIBILITY"] = addAccessor("SCALAR", 5126, factors.size(), bytes);
		}
	}

	float factorOf(std::span<const GltfPlace> places, GltfBaked& made) const
	{
		double products = 0.0;
		double squares = 0.0;
		const auto each = [&](const auto& call)
		{
			for (const GltfPlace& place : places)
			{
				for (const auto& [vertex, of_level] : place.vertices)
				{
					call(of_level);
				}
			}
		};
		each(
			[&](uint32_t v)
			{
				products += static_cast<double>(made.front[v]) * static_cast<double>(m_bake.visibility[v]);
				squares += static_cast<double>(made.front[v]) * static_cast<double>(made.front[v]);
			});
		const auto factor = static_cast<float>(squares > 0.0 ? products / squares : 1.0);
		each(
			[&](uint32_t v)
			{
				made.front[v] = std::min(1.0F, factor * made.front[v]);
				if (!made.back.empty())
				{
					made.back[v] = std::min(1.0F, factor * made.back[v]);
				}
			});
		return factor;
	}

	void addTexture(const std::vector<MeshUnit>& units)
	{
		const std::size_t texture = items("textures").size();
		const std::size_t view = items("bufferViews").size(); // a missing list that items() adds moves the others
		const std::size_t image = items("images").size();
		const std::size_t sampler = items("samplers").size();
		items("textures").push_back({{"sampler", sampler}, {"source", image}});
		items("samplers").push_back({{"magFilter", 9729U}, {"minFilter", 9987U}, {"wrapS", 33071U}, {"wrapT", 33071U}});
		items("images").push_back({{"name", "visibility"}, {"mimeType", "image/png"}, {"bufferView", view}});
		items("bufferViews").push_back(Document::object());
		m_added.emplace_back(m_bake.png);
		std::size_t made = kNoNumber; // for primitives without a material
		std::set<std::size_t> done;
		for (const MeshUnit& unit : units)
		{
			for (const auto& [number, places] : unit.primitives)
			{
				Document& primitive = primitiveOf(unit.mesh, number);
				const std::size_t before = numberIn(primitive, "material");
				if (before == kNoNumber && made == kNoNumber)
				{
					made = items("materials").size();
					items("materials").push_back(Document::object());
				}
				const std::size_t material = before == kNoNumber ? made : before;
				primitive["material"] = material;
				if (done.insert(material).second)
				{
					const auto set = m_set_of_material.find(before);
					Document& to = items("materials")[material]["occlusionTexture"];
					Document use{{"index", texture},
								 {"texCoord",
								  set != m_set_of_material.end() ? static_cast<uint32_t>(set->second) : m_bake.uv_set.value_or(0)}};
					if (to.contains("strength"))
					{
						use["strength"] = to["strength"];
					}
					to = std::move(use);
				}
			}
		}
	}

	// True if the first buffer is the binary chunk, which additions then extend.
	bool chunkIsFirst()
	{
		if (items("buffers").empty())
		{
			items("buffers").push_back({{"byteLength", 0U}});
		}
		return !items("buffers")[0].contains("uri");
	}

	void addViews(std::string& to, bool in_chunk)
	{
		to.resize(in_chunk ? numberIn(items("buffers")[0], "byteLength") : 0);
		for (std::size_t i = 0; i < m_added.size(); ++i)
		{
			pad(to);
			Document view{
				{"buffer", in_chunk ? 0 : items("buffers").size()}, {"byteOffset", to.size()}, {"byteLength", m_added[i].size()}};
			view.update(items("bufferViews")[m_view_before + i]);
			items("bufferViews")[m_view_before + i] = std::move(view);
			to += m_added[i];
		}
		if (in_chunk && !m_added.empty())
		{
			pad(to);
			items("buffers")[0]["byteLength"] = to.size();
		}
	}

	static std::string dataUri(const std::string& bytes)
	{
		return "data:application/octet-stream;base64," + base64Of({reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
	}

	// Relative names of buffers and images, for an output in another folder.
	void rebase(const std::string& output)
	{
		std::error_code failed;
		const auto folderOf = [&failed](const std::string& path)
		{
			const std::filesystem::path folder = std::filesystem::path(path).parent_path();
			return std::filesystem::weakly_canonical(folder.empty() ? "." : folder, failed);
		};
		const std::filesystem::path from = folderOf(m_file.path);
		const std::filesystem::path to = folderOf(output);
		for (const char* const list : {"buffers", "images"})
		{
			if (from == to || !m_json.contains(list))
			{
				continue;
			}
			for (Document& item : m_json[list])
			{
				const std::string uri = textIn(item, "uri");
				if (!uri.empty() && !uri.starts_with("data:") && uri.find("://") == std::string::npos)
				{
					const std::filesystem::path file = std::filesystem::weakly_canonical(
						std::filesystem::absolute(besideLevel(m_file.path, unescaped(uri))), failed);
					item["uri"] = escapedUri(std::filesystem::relative(file, to, failed).generic_string());
				}
			}
		}
	}

	static std::string escapedUri(const std::string& name)
	{
		constexpr std::string_view kDigits = "0123456789ABCDEF";
		constexpr std::string_view kEscaped = " \"#%<>?[\\]^`{|}:";
		std::string uri;
		for (const char c : name)
		{
			const auto byte = static_cast<unsigned char>(c);
			const bool plain = byte > 32 && byte < 127 && kEscaped.find(c) == std::string_view::npos;
			uri += plain ? std::string(1, c) : std::string{'%', kDigits[byte >> 4U], kDigits[byte & 15U]};
		}
		return uri;
	}

	GltfFile m_file;
	const GltfBake& m_bake;
	Document m_json;
	Document m_before; // to undo the bake
	bool m_to_binary = false;
	bool m_gathered = false; // all views are in one buffer:
	std::string m_gathered_bytes;
	std::string m_compression;
	std::string m_earlier; // target of an earlier bake that is still there

	std::vector<Channel> m_channels;
	std::size_t m_width = 0; // numbers of all channels
	std::string m_attribute; // of the values
	bool m_colors = false;
	std::map<std::size_t, std::size_t> m_placements; // per mesh
	std::vector<ValueGroup> m_groups;
	std::map<std::tuple<std::size_t, std::size_t, bool>, std::vector<std::size_t>> m_groups_of; // by positions, colours, sides

	std::size_t m_view_before = 0;                     // views of the file
	std::vector<std::string> m_added;                  // bytes of the views behind them
	std::map<std::size_t, std::size_t> m_view_of_size; // index into m_added
	std::map<std::size_t, int> m_set_of_material;      // texture coordinates that were added
	std::set<std::size_t> m_kept_alpha;                // materials
};

} // namespace

GltfBaked bakeInto(const GltfFile& file, std::span<const GltfPlace> places, const GltfBake& bake,
				   std::span<const std::string> outputs)
{
	GltfBaked made;
	std::vector<std::string> files;
	const std::array<std::string, 1> same{"-"}; // the form of the input
	for (const std::string& output : outputs.empty() ? std::span<const std::string>(same) : outputs)
	{
		made = {};
		Editor editor(file, bake, output);
		editor.add(places, made);
		if (!outputs.empty())
		{
			files.push_back(editor.take(output));
		}
	}
	made.files = std::move(files);
	return made;
}

std::string levelGlb(const Level& level, std::string_view generator, const GlbBake& bake)
{
	assert(!level.triangles.empty() && (bake.visibility.empty() || bake.visibility.size() == level.positions.size()));
	assert(bake.uvs.empty() == bake.png.empty() && (bake.uvs.empty() || bake.uvs.size() == level.positions.size()));
	if (bake.visibility.empty() && bake.png.empty())
	{
		return levelGlb(level, generator);
	}
	GltfBake in;
	static_cast<GlbBake&>(in) = bake;
	std::vector<GltfPlace> places;
	std::string bytes = levelGlb(level, generator, places);
	const std::array<std::string, 1> output{"level.glb"};
	return bakeInto(openGlb(std::move(bytes), level.name), places, in, output).files.front();
}

nlohmann::ordered_json bakeRecordOf(const std::string& path)
{
	const std::string ending = endingOf(path);
	if (path.starts_with("builtin:") || (ending != ".gltf" && ending != ".glb"))
	{
		return {};
	}
	Document record = Document::parse(openGltf(path).text);
	for (const char* const name : {"asset", "extras", kRecord})
	{
		record = record.is_object() ? record.value(name, Document()) : Document();
	}
	return record.is_object() ? record : Document();
}

std::string placeValues(std::span<const GltfPlace> places, std::span<const float> front, std::span<const float> back,
						const std::string& ending)
{
	const std::size_t sides = back.empty() ? 1 : 2;
	std::string csv = "node,instance,primitive,vertex,visibility" + std::string(sides == 2 ? ",back\n" : "\n");
	std::string raw;
	Document parts = Document::array();
	for (const GltfPlace& place : places)
	{
		std::vector<float> values(place.count * sides, 1.0F);
		for (const auto& [vertex, of_level] : place.vertices)
		{
			values[vertex * sides] = front[of_level];
			values[vertex * sides + sides - 1] = sides == 2 ? back[of_level] : front[of_level];
		}
		const std::string instance = place.instance ? std::to_string(*place.instance) : "";
		const std::string head = std::to_string(place.node) + "," + instance + "," + std::to_string(place.primitive) + ",";
		for (std::size_t i = 0; i < values.size(); ++i)
		{
			if (ending == ".csv")
			{
				csv += (i % sides == 0 ? head + std::to_string(i / sides) : "") + "," + shortestDecimal(values[i]) +
					   ((i + 1) % sides == 0 ? "\n" : "");
			}
			appendRaw(raw, values[i]);
		}
		if (ending == ".json")
		{
			parts.push_back({{"node", place.node},
							 {"instance", place.instance ? Document(*place.instance) : Document()},
							 {"primitive", place.primitive},
							 {"values", values}});
		}
	}
	if (ending == ".csv")
	{
		return csv;
	}
	if (ending == ".json")
	{
		return jsonLine(Document{{"schema", "nook/vertices/1"}, {"sides", sides}, {"parts", std::move(parts)}}) + "\n";
	}
	const std::string rows = std::to_string(raw.size() / sizeof(float) / sides);
	std::string head = "{'descr': '<f4', 'fortran_order': False, 'shape': (" + rows + (sides == 1 ? ",), }" : ", 2), }");
	head.resize((head.size() + 11 + 63) / 64 * 64 - 11, ' '); // numpy.lib.format, version 1.0: the values begin at a multiple of 64
	std::string bytes("\x93NUMPY\x01\x00", 8);
	appendRaw(bytes, static_cast<uint16_t>(head.size() + 1));
	return bytes + head + "\n" + raw;
}

} // namespace nook
