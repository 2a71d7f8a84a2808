// SPDX-License-Identifier: GPL-3.0-or-later
// Gives the meshes of a glTF file baked values: what each place of a mesh has in common, and where the target wants it.
#include "scene/gltf_bake.h"

#include "core/lists.h"
#include "scene/load_parts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <tuple>
#include <utility>

namespace nook
{
namespace
{

using Document = GltfEditor::Document;

constexpr std::size_t kTries = 64; // sets of values that a primitive is compared with: with all, a forest would take forever

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

bool isSamePlacement(const GltfPlace& a, const GltfPlace& b)
{
	return a.node == b.node && a.instance == b.instance;
}

// Takes values of other vertices, unless a vertex has different ones.
bool merge(std::vector<float>& numbers, const std::vector<float>& other)
{
	const bool all_fit = std::equal(numbers.begin(), numbers.end(), other.begin(),
									[](float a, float b) { return std::isnan(a) || std::isnan(b) || a == b; });
	for (std::size_t i = 0; all_fit && i < numbers.size(); ++i)
	{
		numbers[i] = std::isnan(numbers[i]) ? other[i] : numbers[i];
	}
	return all_fit;
}

class Baker
{
public:
	Baker(GltfEditor& editor, const GltfBake& bake)
		: m_editor(editor), m_bake(bake), m_in_color(bake.target == BakeTarget::color || bake.target == BakeTarget::color_alpha),
		  m_colors(bake.color || m_in_color)
	{
		const float unset = !m_bake.visibility.empty() && m_bake.kind == BakedKind::visibility ? 1.0F : 0.0F;
		m_attribute = m_bake.target == BakeTarget::visibility ? std::string(kBakedNames[static_cast<std::size_t>(m_bake.kind)])
															  : m_bake.attribute;
		const auto take = [&](const std::string& name, const auto& values, std::size_t size, bool back, float empty)
		{
			if (!values.empty())
			{
				m_channels.push_back({name, reinterpret_cast<const float*>(values.data()), size, back, empty});
				m_width += size;
			}
		};
		take(m_attribute, m_bake.visibility, 1, false, unset);
		take(m_attribute + "_BACK", m_bake.back, 1, true, unset);
		take("_BENT_NORMAL", m_bake.bent, 3, false, 0.0F);
		take("_BENT_NORMAL_BACK", m_bake.bent_back, 3, true, 0.0F);
		take("", m_bake.uvs, 2, false, 0.0F);
		failIf(m_colors && m_editor.earlier.starts_with("color"), m_editor, "COLOR_0",
			   "an earlier bake in a file that was changed since", "the file before that bake");
	}

	void check(std::span<const GltfPlace> places)
	{
		const std::vector<MeshUnit> units = unitsOf(places);
		for (const MeshUnit& unit : units)
		{
			for (const auto& [number, at] : unit.primitives)
			{
				checkTarget(m_editor.primitiveOf(unit.mesh, number)["attributes"]);
			}
		}
		const bool own_vertices = !m_bake.charts.empty() || m_bake.split.how != nullptr;
		for (const GltfPlace& place : places)
		{
			const std::string where = "nodes[" + std::to_string(place.node) + "]";
			failIf(own_vertices && place.instance, m_editor, where, "instances by EXT_mesh_gpu_instancing",
				   "nodes with a mesh each, since instances share their vertices", ExitCode::unsupported);
			const Document& node = m_editor.items("nodes")[place.node];
			failIf(m_bake.instances == BakeInstances::attribute && m_placements[numberIn(node, "mesh")] > 1 && !place.instance &&
					   !node.value("extras", Document::object()).is_object(),
				   m_editor, where + ".extras", "no object", "one, or nothing", ExitCode::unsupported);
		}
		checkTextures(m_editor, m_bake, units);
	}

	void add(std::span<const GltfPlace> places, GltfBaked& made)
	{
		made.compression = m_editor.compression;
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
					unit.groups[primitive] = groupOf(m_editor.primitiveOf(unit.mesh, primitive), meanOf(at));
				}
			}
		}
		for (ValueGroup& group : m_groups)
		{
			addValues(group);
		}
		if (m_bake.charts.empty())
		{
			addMeshes(units, made);
		}
		if (!m_bake.visibility.empty())
		{
			store(units, made);
		}
		if (m_bake.instances == BakeInstances::attribute)
		{
			addFactors(places, made);
		}
		if (!m_bake.png.empty() || !m_bake.charts.empty())
		{
			made.copies += addTextures(m_editor, m_bake, places, units, m_set_of_material, m_parts);
		}
		made.bytes_added = m_editor.bytesAdded();
		made.kept_alpha = m_kept_alpha.size();
	}

	std::vector<GltfPlace> takeParts()
	{
		return std::move(m_parts);
	}

private:
	Document materialOf(const Document& primitive)
	{
		const std::size_t index = numberIn(primitive, "material");
		return index == kNoNumber ? Document::object() : m_editor.items("materials")[index];
	}

	// Is the alpha of its colours coverage, which --to color-alpha leaves alone?
	bool keepsAlpha(const Document& primitive)
	{
		return m_bake.target == BakeTarget::color_alpha && materialOf(primitive).value("alphaMode", "OPAQUE") != "OPAQUE";
	}

	std::vector<MeshUnit> unitsOf(std::span<const GltfPlace> places)
	{
		std::map<std::pair<std::size_t, std::size_t>, std::size_t> known;
		std::vector<MeshUnit> units;
		const GltfPlace* last = nullptr;
		for (const GltfPlace& place : places)
		{
			const std::size_t mesh = m_editor.items("nodes")[place.node]["mesh"].get<std::size_t>();
			const Document& primitives = m_editor.items("meshes")[mesh]["primitives"];
			failIf(place.primitive >= primitives.size() ||
					   numberIn(m_editor.items("accessors")[numberIn(primitives[place.primitive]["attributes"], "POSITION")],
								"count") != place.count,
				   m_editor, "asset.extras.nook", "a bake that split vertices", "the file before it");
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

	// Throws unless the attribute is free or held a bake.
	void checkTarget(const Document& attributes)
	{
		const std::size_t found = m_attribute.empty() ? kNoNumber : numberIn(attributes, m_attribute);
		if (found == kNoNumber)
		{
			return;
		}
		if (m_bake.target == BakeTarget::texcoord && m_editor.earlier != textIn(m_bake.record, "to"))
		{
			const int set = firstFreeSet(attributes);
			m_editor.fail(m_attribute, set > kMostSet ? "it in use, as all sets are" : "it in use",
						  set > kMostSet ? "another target" : "a set that is free, as --to texcoord:" + std::to_string(set));
		}
		const Document& accessor = m_editor.items("accessors")[found];
		if (m_bake.target != BakeTarget::texcoord && (accessor["type"] != "SCALAR" || accessor["componentType"] != 5126U))
		{
			m_editor.fail(m_attribute,
						  "an accessor of " + textIn(accessor, "type") + ", component type " + accessor["componentType"].dump(),
						  "SCALAR of 5126, as of an earlier bake, or none");
		}
	}

	void addValues(ValueGroup& group)
	{
		const bool pairs = m_bake.target == BakeTarget::texcoord;
		std::size_t at = 0;
		for (const Channel& channel : m_channels)
		{
			const bool is_value = channel.size == 1 && (m_in_color || (pairs && channel.is_back)); // stored with another, or not
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
				group.accessors.emplace_back(channel.name,
											 m_editor.addAccessor(kTypes[width], 5126, group.numbers.size() / m_width, bytes));
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
			base.emplace(m_editor.file, group.color);
			component = numberIn(m_editor.items("accessors")[group.color], "componentType");
			given = m_editor.items("accessors")[group.color]["type"] == "VEC3" ? 3 : 4;
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
				appendComponent(bytes, component, static_cast<double>((i == 3) == alpha ? before * value : before), true);
			}
			padTo4(bytes);
		}
		const std::size_t made = m_editor.addAccessor(channels == 3 ? "VEC3" : "VEC4", component, count, bytes);
		if (component != 5126)
		{
			m_editor.items("accessors")[made]["normalized"] = true;
		}
		return made;
	}

	// Gives the primitives their accessors, in copies of meshes where a mesh has several sets of values.
	void addMeshes(const std::vector<MeshUnit>& units, GltfBaked& made)
	{
		std::map<std::size_t, Document> originals;
		for (const MeshUnit& unit : units)
		{
			originals.try_emplace(unit.mesh, m_editor.items("meshes")[unit.mesh]);
		}
		std::map<std::pair<std::size_t, std::map<std::size_t, std::size_t>>, std::size_t> known;
		std::set<std::size_t> used = m_bake.others_stay ? meshesOfOthers(m_editor, units) : std::set<std::size_t>();
		for (const MeshUnit& unit : units)
		{
			const auto [at, is_new] = known.try_emplace({unit.mesh, unit.groups}, unit.mesh);
			if (is_new && !used.insert(unit.mesh).second)
			{
				at->second = m_editor.items("meshes").size();
				m_editor.items("meshes").push_back(originals[unit.mesh]);
				made.copies += 1;
			}
			for (const auto& [primitive, group] : unit.groups)
			{
				if (is_new)
				{
					setAttributes(m_editor.primitiveOf(at->second, primitive), m_groups[group]);
				}
			}
			for (const std::size_t node : unit.nodes)
			{
				m_editor.items("nodes")[node]["mesh"] = at->second;
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
			if (name.empty())
			{
				const int set = firstFreeSet(attributes);
				attributes[setName(set)] = accessor;
				m_set_of_material[numberIn(primitive, "material")] = set;
				continue;
			}
			// Sets have no gaps: free ones below get the same accessor.
			for (int set = 0; m_bake.target == BakeTarget::texcoord && setName(set) != name; ++set)
			{
				if (!attributes.contains(setName(set)))
				{
					attributes[setName(set)] = accessor;
				}
			}
			attributes[name] = accessor;
		}
	}

	// Gives the level's vertices the values they have in the file.
	void store(const std::vector<MeshUnit>& units, GltfBaked& made)
	{
		for (const MeshUnit& unit : units)
		{
			for (const auto& [primitive, places] : unit.primitives)
			{
				const ValueGroup& group = m_groups[unit.groups.at(primitive)];
				const bool none = keepsAlpha(m_editor.primitiveOf(unit.mesh, primitive));
				for (const GltfPlace* const place : places)
				{
					for (const auto& [vertex, of_level] : place->vertices)
					{
						made.front[of_level] = none ? 1.0F : m_in_color ? colorOf(group, vertex) : group.numbers[vertex * m_width];
						if (!made.back.empty())
						{
							made.back[of_level] = m_in_color ? made.front[of_level] : group.numbers[vertex * m_width + 1];
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
		const auto addFactor = [&](std::span<const GltfPlace> placement)
		{
			const GltfPlace& place = placement.front();
			Document& node = m_editor.items("nodes")[place.node];
			if (m_placements[numberIn(node, "mesh")] > 1)
			{
				const float factor = factorOf(placement, made);
				if (place.instance)
				{
					of_node[place.node].resize(*place.instance + 1, 1.0F);
					of_node[place.node].back() = factor;
				}
				else
				{
					node["extras"]["nook_visibility"] = factor;
				}
			}
		};
		eachRun(places, isSamePlacement, addFactor);
		for (auto& [node, factors] : of_node)
		{
			Document& attributes = m_editor.items("nodes")[node]["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
			factors.resize(numberIn(m_editor.items("accessors")[attributes.begin()->get<std::size_t>()], "count"), 1.0F);
			const std::string bytes(reinterpret_cast<const char*>(factors.data()), factors.size() * sizeof(float));
			attributes["_VISIBILITY"] = m_editor.addAccessor("SCALAR", 5126, factors.size(), bytes);
		}
	}

	float factorOf(std::span<const GltfPlace> places, GltfBaked& made) const
	{
		std::vector<uint32_t> vertices; // of the level
		for (const GltfPlace& place : places)
		{
			for (const auto& [vertex, of_level] : place.vertices)
			{
				vertices.push_back(of_level);
			}
		}
		double products = 0.0;
		double squares = 0.0;
		for (const uint32_t v : vertices)
		{
			products += static_cast<double>(made.front[v]) * static_cast<double>(m_bake.visibility[v]);
			squares += static_cast<double>(made.front[v]) * static_cast<double>(made.front[v]);
		}
		const auto factor = static_cast<float>(squares > 0.0 ? products / squares : 1.0);
		for (const uint32_t v : vertices)
		{
			made.front[v] = std::min(1.0F, factor * made.front[v]);
			if (!made.back.empty())
			{
				made.back[v] = std::min(1.0F, factor * made.back[v]);
			}
		}
		return factor;
	}

	GltfEditor& m_editor;
	const GltfBake& m_bake;
	bool m_in_color;
	bool m_colors;
	std::vector<Channel> m_channels;
	std::size_t m_width = 0;                         // numbers of all channels
	std::string m_attribute;                         // of the values
	std::map<std::size_t, std::size_t> m_placements; // per mesh
	std::vector<ValueGroup> m_groups;
	std::map<std::tuple<std::size_t, std::size_t, bool>, std::vector<std::size_t>> m_groups_of; // by positions, colours, sides
	std::set<std::size_t> m_kept_alpha;                                                         // materials
	std::map<std::size_t, int> m_set_of_material; // texture coordinates that were added
	std::vector<GltfPlace> m_parts;               // of primitives with charts
};

// Gives some of the places' triangles textures, and the places what is left for values: the rest, and the triangles on pages.
void addCharts(GltfEditor& editor, const GltfBake& bake, GltfBaked& made)
{
	GltfBake textures = bake;
	textures.visibility = textures.back = {};
	textures.charts.clear();
	std::vector<GltfPlace> textured;
	std::vector<GltfPlace> others;
	for (std::size_t i = 0; i < made.places.size(); ++i)
	{
		const GltfCharts& charts = bake.charts[i];
		(charts.uvs.empty() ? others : textured).push_back(made.places[i]);
		if (charts.uvs.empty())
		{
			others.back().vertices = charts.rest_vertices;
			continue;
		}
		textures.charts.push_back(charts);
	}
	if (!textured.empty())
	{
		Baker baker(editor, textures);
		baker.add(textured, made);
		append(others, baker.takeParts());
		editor.settle();
	}
	made.places = std::move(others);
}

} // namespace

int firstFreeSet(const Document& attributes)
{
	int set = 0;
	while (attributes.contains(setName(set)))
	{
		set += 1;
	}
	return set;
}

bool hasList(GltfEditor& editor, const Document& primitive)
{
	const std::size_t indices = numberIn(primitive, "indices");
	return indices != kNoNumber && numberIn(primitive, "mode", 4) == 4 &&
		   numberIn(editor.items("accessors")[indices], "bufferView") != kNoNumber &&
		   !editor.items("accessors")[indices].contains("sparse");
}

std::set<std::size_t> meshesOfOthers(GltfEditor& editor, const std::vector<MeshUnit>& units)
{
	std::set<std::size_t> nodes;
	for (const MeshUnit& unit : units)
	{
		nodes.insert(unit.nodes.begin(), unit.nodes.end());
	}
	std::set<std::size_t> meshes;
	for (std::size_t i = 0; i < editor.items("nodes").size(); ++i)
	{
		if (!nodes.contains(i))
		{
			meshes.insert(numberIn(editor.items("nodes")[i], "mesh"));
		}
	}
	return meshes;
}

void checkTarget(const GltfFile& file, std::span<const GltfPlace> places, const GltfBake& bake)
{
	GltfEditor editor(file, "-");
	Baker(editor, bake).check(places);
}

std::vector<GltfCost> costsOf(const GltfFile& file, std::span<const GltfPlace> places)
{
	GltfEditor editor(file, "-");
	const auto bytesOf = [&editor](const Document& arrays) // of an element of each
	{
		return sumOver(arrays,
					   [&editor](const Document& accessor)
					   {
						   const Document& item = editor.items("accessors")[accessor.get<std::size_t>()];
						   return (componentsOf(textIn(item, "type")) * bytesOfComponent(numberIn(item, "componentType")) + 3) / 4 *
								  4;
					   });
	};
	return mapped(
		places,
		[&](const GltfPlace& place)
		{
			const Document& primitive = editor.primitiveOf(numberIn(editor.items("nodes")[place.node], "mesh"), place.primitive);
			return GltfCost{bytesOf(primitive["attributes"]) + sumOver(primitive.value("targets", Document::array()), bytesOf),
							hasList(editor, primitive)};
		});
}

TriangleRuns runsOf(const std::vector<bool>& remains)
{
	constexpr std::size_t kShortest = 128;                 // triangles; a primitive and its accessor take about 500 bytes of JSON
	constexpr std::size_t kMost = 16;                      // each is drawn by itself
	std::vector<std::pair<std::size_t, std::size_t>> runs; // length, then the first from the end
	for (std::size_t i = 0; i < remains.size(); ++i)
	{
		if (remains[i] && (i == 0 || !remains[i - 1]))
		{
			runs.emplace_back(0, remains.size() - i);
		}
		if (remains[i])
		{
			runs.back().first += 1;
		}
	}
	std::sort(runs.begin(), runs.end(), std::greater<>());
	TriangleRuns made;
	std::vector<bool> is_other = remains;
	for (const auto& [count, from_end] : std::span(runs).first(std::min(kMost, runs.size())))
	{
		const std::size_t first = remains.size() - from_end;
		if (count >= kShortest)
		{
			made.runs.emplace_back(first, count);
			std::fill_n(is_other.begin() + static_cast<std::ptrdiff_t>(first), count, false);
		}
	}
	std::sort(made.runs.begin(), made.runs.end());
	made.others = indicesWhere(is_other.size(), [&](std::size_t i) { return is_other[i]; });
	return made;
}

GltfBaked bakeInto(const GltfFile& file, std::span<const GltfPlace> places, const GltfBake& bake,
				   std::span<const std::string> outputs)
{
	GltfBaked made;
	std::vector<std::string> files;
	const std::array<std::string, 1> same{"-"}; // the form of the input
	for (const std::string& output : outputs.empty() ? std::span<const std::string>(same) : outputs)
	{
		made = {};
		GltfEditor editor(file, output);
		made.places.assign(places.begin(), places.end());
		made.copies = bake.split.how == nullptr ? 0 : splitTriangles(editor, made.places, bake.split);
		GltfBake values = bake;
		if (!bake.charts.empty() && !bake.visibility.empty())
		{
			addCharts(editor, bake, made);
			values.charts.clear();
		}
		Baker(editor, values).add(made.places, made);
		if (!outputs.empty())
		{
			files.push_back(editor.take(output, bake.record));
		}
	}
	made.files = std::move(files);
	return made;
}

} // namespace nook
