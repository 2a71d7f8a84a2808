// SPDX-License-Identifier: GPL-3.0-or-later
// Adds vertices to the primitives of a glTF file, and splits their triangles.
#include "core/lists.h"
#include "scene/gltf_bake.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace nook
{
namespace
{

using Document = GltfEditor::Document;

// The integer that stands for 1 in normalised components.
double oneOf(uint64_t component)
{
	return withComponent(component,
						 [](auto zero)
						 {
							 using Number = decltype(zero);
							 return std::is_integral_v<Number> ? static_cast<double>(std::numeric_limits<Number>::max()) : 1.0;
						 });
}

// The numbers of an accessor's elements, and of further ones.
class Elements
{
public:
	Elements(GltfEditor& editor, std::size_t accessor)
		: m_editor(editor), m_item(editor.items("accessors")[accessor]), m_values(editor.file, accessor),
		  m_component(numberIn(m_item, "componentType")), m_width(componentsOf(textIn(m_item, "type")))
	{
	}

	std::size_t width() const
	{
		return m_width;
	}

	double number(uint32_t element, std::size_t i) const
	{
		return element < m_values.count() ? m_values.number(element, i) : m_further[(element - m_values.count()) * m_width + i];
	}

	void add(double number)
	{
		m_further.push_back(number);
	}

	// Turned vectors and rounded weights may exceed those of the others.
	void dropBounds()
	{
		m_item.erase("min");
		m_item.erase("max");
	}

	bool isWhole() const
	{
		return m_component != 5126 && !m_item.value("normalized", false);
	}

	// The integer that stands for 1; 1 for numbers that are not scaled.
	double one() const
	{
		return isWhole() ? 1.0 : oneOf(m_component);
	}

	// An accessor with all of them, or with the further ones `alone`; copies have the same bytes.
	std::size_t stored(const VertexPairs& added, bool alone) const
	{
		std::string bytes;
		const std::size_t first = alone ? m_values.count() : 0;
		for (std::size_t i = first; i < m_values.count() + added.size(); ++i)
		{
			const auto [a, b] =
				i < m_values.count() ? std::pair(static_cast<uint32_t>(i), static_cast<uint32_t>(i)) : added[i - m_values.count()];
			if (a == b && a < m_values.count())
			{
				m_values.append(bytes, a);
			}
			for (std::size_t k = 0; k < m_width && (a != b || a >= m_values.count()); ++k)
			{
				appendComponent(bytes, m_component, number(static_cast<uint32_t>(i), k), !isWhole());
			}
			padTo4(bytes);
		}
		Document item = m_item;
		const std::size_t count = m_values.count() + added.size() - first;
		const std::size_t made = m_editor.addAccessor(textIn(item, "type"), m_component, count, bytes);
		item.erase("sparse");
		for (std::size_t k = 0; alone && item.contains("min") && k < m_width; ++k)
		{
			const std::vector<double> numbers =
				mapped(added, [&](const auto& pair) { return number(pair.first, k) * (isWhole() ? 1.0 : one()); });
			const auto [least, most] = std::minmax_element(numbers.begin(), numbers.end());
			const bool is_float = m_component == 5126;
			item["min"][k] = is_float ? Document(*least) : Document(std::lround(*least));
			item["max"][k] = is_float ? Document(*most) : Document(std::lround(*most));
		}
		item.update(m_editor.items("accessors")[made]);
		m_editor.items("accessors")[made] = std::move(item);
		return made;
	}

private:
	GltfEditor& m_editor;
	Document m_item;
	const GltfValues m_values;
	const uint64_t m_component;
	const std::size_t m_width;
	std::vector<double> m_further;
};

// Means of two elements. `name`: of the attribute; empty for morph targets, whose normals are differences.
void addMeans(Elements& elements, const std::string& name, const VertexPairs& added)
{
	const bool is_unit = name == "NORMAL" || name == "TANGENT";
	bool any_turns = false;
	const bool is_first = name.starts_with("_") && elements.isWhole();
	for (const auto& [a, b] : added)
	{
		std::array<double, 16> mean{};
		double square = 0.0;
		for (std::size_t i = 0; i < elements.width(); ++i)
		{
			const bool keeps = is_first || (is_unit && i == 3); // the handedness of a tangent
			mean[i] = keeps ? elements.number(a, i) : 0.5 * (elements.number(a, i) + elements.number(b, i));
			square += i < 3 ? mean[i] * mean[i] : 0.0;
		}
		const double length = std::sqrt(square);
		for (std::size_t i = 0; i < elements.width(); ++i)
		{
			const bool turns = is_unit && i < 3 && a != b;
			any_turns = any_turns || turns;
			elements.add(!turns ? mean[i] : length > 1e-6 ? mean[i] / length : elements.number(a, i));
		}
	}
	if (any_turns)
	{
		elements.dropBounds();
	}
}

// Joints and weights of a vertex between two: those with the largest mean weights, with the same sum.
class Skin
{
public:
	Skin(GltfEditor& editor, const Document& attributes)
	{
		for (std::size_t set = 0; attributes.contains(name("JOINTS_", set)) && attributes.contains(name("WEIGHTS_", set)); ++set)
		{
			m_joints.emplace_back(editor, numberIn(attributes, name("JOINTS_", set))).dropBounds();
			m_weights.emplace_back(editor, numberIn(attributes, name("WEIGHTS_", set))).dropBounds();
		}
	}

	void add(uint32_t a, uint32_t b)
	{
		std::map<double, double> weight_of; // by joint
		double sum = 0.0;
		for (const uint32_t vertex : {a, b})
		{
			for (std::size_t i = 0; i < 4 * m_joints.size(); ++i)
			{
				const double weight = 0.5 * m_weights[i / 4].number(vertex, i % 4);
				weight_of[m_joints[i / 4].number(vertex, i % 4)] += weight;
				sum += weight;
			}
		}
		std::vector<std::pair<double, double>> sorted = // weight, joint
			mapped(weight_of, [](const auto& of) { return std::pair(of.second, of.second > 0.0 ? of.first : 0.0); });
		std::stable_sort(sorted.begin(), sorted.end(), [](const auto& x, const auto& y) { return x.first > y.first; });
		sorted.resize(4 * m_joints.size());
		const double kept = sumOver(sorted, [](const auto& item) { return item.first; });
		double rest = sum; // integers keep the sum: the first gets what rounding leaves
		for (auto& [weight, joint] : sorted)
		{
			const double one = m_weights[0].one();
			weight = kept > 0.0 ? weight * sum / kept : 0.0;
			weight = one > 1.0 ? std::floor(weight * one + 0.5) / one : weight;
			rest -= weight;
		}
		sorted.front().first += m_weights[0].one() > 1.0 ? rest : 0.0;
		for (std::size_t i = 0; i < sorted.size(); ++i)
		{
			m_weights[i / 4].add(sorted[i].first);
			m_joints[i / 4].add(sorted[i].second);
		}
	}

	void store(Document& attributes, const VertexPairs& added, bool alone)
	{
		for (std::size_t set = 0; set < m_joints.size(); ++set)
		{
			attributes[name("JOINTS_", set)] = m_joints[set].stored(added, alone);
			attributes[name("WEIGHTS_", set)] = m_weights[set].stored(added, alone);
		}
	}

	bool isEmpty() const
	{
		return m_joints.empty();
	}

private:
	static std::string name(const char* kind, std::size_t set)
	{
		return kind + std::to_string(set);
	}

	std::vector<Elements> m_joints;
	std::vector<Elements> m_weights;
};

// A node's vertices that some of its primitives share.
struct Pool
{
	std::map<std::pair<uint32_t, uint32_t>, uint32_t> middles; // of two vertices
	VertexPairs added;
	Document arrays; // attributes and targets with the added ones
};

// A place's triangles after the split.
struct SplitPlace
{
	std::size_t place = 0;
	Pool* pool = nullptr;
	std::vector<uint32_t> indices;
};

std::array<uint32_t, 3> sorted(glm::uvec3 triangle)
{
	std::array<uint32_t, 3> key{triangle.x, triangle.y, triangle.z};
	std::sort(key.begin(), key.end());
	return key;
}

class Splitter
{
public:
	Splitter(GltfEditor& editor, std::vector<GltfPlace>& places, const GltfSplit& split)
		: m_editor(editor), m_places(places), m_split(split), m_first(split.before.size() + 1, split.after.size())
	{
		for (std::size_t i = split.after.size(); i-- > 0;)
		{
			m_first[split.how->origins[i]] = i;
		}
		for (std::size_t t = 0; t < split.before.size(); ++t)
		{
			if (m_first[t + 1] - m_first[t] > 1)
			{
				m_parents.emplace(sorted(split.before[t]), t);
			}
		}
	}

	std::size_t run()
	{
		std::vector<SplitPlace> all;
		for (std::size_t i = 0; i < m_places.size(); ++i)
		{
			if (SplitPlace made = splitOf(i); made.pool != nullptr)
			{
				all.push_back(std::move(made));
			}
		}
		OwnMeshes own(m_editor);
		for (const SplitPlace& made : all)
		{
			own.meshOf(m_places[made.place].node);
			put(made);
		}
		m_editor.settle();
		return own.copies;
	}

private:
	Document& primitiveOf(const GltfPlace& place)
	{
		return m_editor.primitiveOf(numberIn(m_editor.items("nodes")[place.node], "mesh"), place.primitive);
	}

	SplitPlace splitOf(std::size_t number)
	{
		GltfPlace& place = m_places[number];
		std::vector<uint32_t> of_level(place.count, UINT32_MAX);
		for (const auto& [vertex, in_level] : place.vertices)
		{
			of_level[vertex] = in_level;
		}
		SplitPlace made{number, nullptr, {}};
		Pool& pool = m_pools[{place.node, arraysOf(primitiveOf(place)).dump()}];
		std::set<std::pair<uint32_t, uint32_t>> added; // numbers in the primitive, and in the level
		for (const glm::uvec3 file : place.corners)
		{
			const glm::uvec3 corner(of_level[file.x], of_level[file.y], of_level[file.z]);
			const auto parent = m_parents.find(sorted(corner));
			if (parent == m_parents.end())
			{
				made.indices.insert(made.indices.end(), {file.x, file.y, file.z});
				continue;
			}
			made.pool = &pool;
			const std::size_t t = parent->second;
			const glm::uvec3 before = m_split.before[t];
			const bool same = before == corner || before == glm::uvec3(corner.y, corner.z, corner.x) ||
							  before == glm::uvec3(corner.z, corner.x, corner.y);
			for (std::size_t part = m_first[t]; part < m_first[t + 1]; ++part)
			{
				const glm::uvec3 after = m_split.after[part];
				for (const uint32_t vertex : {after.x, same ? after.y : after.z, same ? after.z : after.y})
				{
					made.indices.push_back(inFile(vertex, corner, file, place, pool));
					if (vertex >= m_split.vertices)
					{
						added.emplace(made.indices.back(), vertex);
					}
				}
			}
		}
		append(place.vertices, added);
		return made;
	}

	// The number of one of the level's vertices that lies on a triangle.
	uint32_t inFile(uint32_t vertex, glm::uvec3 corner, glm::uvec3 file, const GltfPlace& place, Pool& pool)
	{
		for (int k = 0; k < 3; ++k)
		{
			if (vertex == corner[k])
			{
				return file[k];
			}
		}
		const auto [from, to] = m_split.how->middles[vertex - m_split.vertices];
		const uint32_t a = inFile(from, corner, file, place, pool);
		const uint32_t b = inFile(to, corner, file, place, pool);
		const auto [at, is_new] =
			pool.middles.try_emplace({std::min(a, b), std::max(a, b)}, static_cast<uint32_t>(place.count + pool.added.size()));
		if (is_new)
		{
			pool.added.emplace_back(at->first);
		}
		return at->second;
	}

	static Document arraysOf(const Document& primitive)
	{
		Document arrays{{"attributes", primitive["attributes"]}};
		if (primitive.contains("targets"))
		{
			arrays["targets"] = primitive["targets"];
		}
		return arrays;
	}

	void put(const SplitPlace& made)
	{
		GltfPlace& place = m_places[made.place];
		Document primitive = primitiveOf(place);
		if (made.pool->arrays.is_null())
		{
			made.pool->arrays = arraysOf(primitive);
			addVertices(m_editor, made.pool->arrays, made.pool->added);
		}
		primitive.update(made.pool->arrays);
		const std::string bytes(reinterpret_cast<const char*>(made.indices.data()), 4 * made.indices.size());
		primitive["indices"] = m_editor.addAccessor("SCALAR", 5125, made.indices.size(), bytes, true);
		primitive["mode"] = 4U;
		place.count += made.pool->added.size();
		primitiveOf(place) = std::move(primitive);
	}

	GltfEditor& m_editor;
	std::vector<GltfPlace>& m_places;
	const GltfSplit& m_split;
	std::vector<std::size_t> m_first;                            // part of each triangle before
	std::map<std::array<uint32_t, 3>, std::size_t> m_parents;    // split triangles, by their corners
	std::map<std::pair<std::size_t, std::string>, Pool> m_pools; // by node and attributes
};

} // namespace

void appendComponent(std::string& bytes, uint64_t component, double value, bool normalized)
{
	value *= normalized ? oneOf(component) : 1.0;
	withComponent(component,
				  [&](auto zero)
				  {
					  using Number = decltype(zero);
					  appendRaw(bytes, static_cast<Number>(std::is_integral_v<Number> ? std::floor(value + 0.5) : value));
				  });
}

void addVertices(GltfEditor& editor, Document& primitive, const VertexPairs& added, bool alone)
{
	if (added.empty())
	{
		return;
	}
	Document& attributes = primitive["attributes"];
	Skin skin(editor, attributes);
	const auto extend = [&](Document& accessor, const std::string& name)
	{
		Elements elements(editor, accessor.get<std::size_t>());
		addMeans(elements, name, added);
		accessor = elements.stored(added, alone);
	};
	for (const auto& attribute : attributes.items())
	{
		const bool of_skin = attribute.key().starts_with("JOINTS_") || attribute.key().starts_with("WEIGHTS_");
		if (!of_skin || skin.isEmpty())
		{
			extend(attribute.value(), attribute.key());
		}
	}
	for (std::size_t i = 0; i < added.size() && !skin.isEmpty(); ++i)
	{
		skin.add(added[i].first, added[i].second);
	}
	skin.store(attributes, added, alone);
	Document none = Document::array();
	for (Document& target : primitive.contains("targets") ? primitive["targets"] : none)
	{
		for (Document& accessor : target)
		{
			extend(accessor, "");
		}
	}
}

std::size_t splitTriangles(GltfEditor& editor, std::vector<GltfPlace>& places, const GltfSplit& split)
{
	return Splitter(editor, places, split).run();
}

} // namespace nook
