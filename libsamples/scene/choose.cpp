// SPDX-License-Identifier: GPL-3.0-or-later
// Chooses parts of a level by patterns, and finds parts that nobody sees.
#include "core/lists.h"
#include "core/text.h"
#include "core/words.h"
#include "scene/load_parts.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::size_t kListedParts = 8; // in a message
constexpr std::size_t kMostSteps = 62;  // of a path
constexpr std::string_view kAnyDepth = "**";

// True if a pattern stands for a text: * for any number of characters, ? for one.
bool isGlobOf(std::string_view glob, std::string_view text)
{
	std::size_t g = 0;
	std::size_t behind_star = std::string_view::npos; // in the pattern, for the last * so far
	std::size_t retry = 0;                            // where in the text that one ends at the earliest
	for (std::size_t t = 0; t < text.size();)
	{
		if (g < glob.size() && glob[g] == '*')
		{
			g += 1;
			behind_star = g;
			retry = t;
		}
		else if (g < glob.size() && (glob[g] == '?' || glob[g] == text[t]))
		{
			g += 1;
			t += 1;
		}
		else if (behind_star != std::string_view::npos)
		{
			g = behind_star;
			retry += 1;
			t = retry;
		}
		else
		{
			return false;
		}
	}
	return glob.find_first_not_of('*', g) == std::string_view::npos;
}

// The names in a pattern from the root on.
std::vector<std::string_view> stepsOf(std::string_view pattern)
{
	std::vector<std::string_view> steps;
	if (!pattern.starts_with('/'))
	{
		steps.push_back(kAnyDepth);
	}
	while (!pattern.empty())
	{
		const std::string_view step = pattern.substr(0, pattern.find('/'));
		pattern.remove_prefix(std::min(pattern.size(), step.size() + 1));
		if (!step.empty())
		{
			steps.push_back(step);
		}
	}
	if (!steps.empty() && steps.back() == kAnyDepth)
	{
		steps.back() = "*"; // everything below is chosen with it
	}
	return steps;
}

// `reached`: bit i for each number of steps that stand for a node's parent. Returns those for the node.
uint64_t reachedBy(const std::vector<std::string_view>& steps, uint64_t reached, std::string_view name)
{
	uint64_t next = 0;
	for (std::size_t i = 0; i < steps.size(); ++i)
	{
		reached |= steps[i] == kAnyDepth ? (reached & (uint64_t{1} << i)) << 1U : 0; // which may also stand for nothing
		if ((reached >> i & 1U) != 0)
		{
			next |= steps[i] == kAnyDepth ? uint64_t{1} << i : isGlobOf(steps[i], name) ? uint64_t{2} << i : 0;
		}
	}
	return next;
}

bool hasExtra(const std::vector<std::string>& extras, std::string_view glob)
{
	const bool with_value = glob.find('=') != std::string_view::npos;
	return std::any_of(extras.begin(), extras.end(),
					   [&](std::string_view extra)
					   { return isGlobOf(glob, with_value ? extra : extra.substr(0, extra.find('='))); });
}

std::vector<std::string_view> namesDownTo(const Level& level, const Mesh& mesh)
{
	std::vector<std::string_view> names;
	for (int node = mesh.node; node >= 0; node = level.nodes[static_cast<std::size_t>(node)].parent)
	{
		names.insert(names.begin(), level.nodes[static_cast<std::size_t>(node)].name);
	}
	return mesh.node < 0 ? std::vector<std::string_view>{mesh.name} : names;
}

[[noreturn]] void refusePattern(const Level& level, const std::string& pattern, const std::string& option)
{
	std::vector<std::string> names;
	const auto add = [&](const std::string& name)
	{
		if (names.size() <= kListedParts)
		{
			addOnce(names, "'" + oneLine(name) + "'");
		}
	};
	const bool by_material = pattern.starts_with("material:");
	const bool by_extras = pattern.starts_with("extras:");
	for (std::size_t i = 0; by_material && i < level.material_list.size(); ++i)
	{
		add("material:" + level.material_list[i].name);
	}
	const auto addExtras = [&](const auto& item)
	{
		std::for_each(item.extras.begin(), item.extras.end(), [&](const auto& extra) { add("extras:" + extra); });
	};
	if (by_extras)
	{
		std::for_each(level.nodes.begin(), level.nodes.end(), addExtras);
		std::for_each(level.material_list.begin(), level.material_list.end(), addExtras);
	}
	for (std::size_t i = 0; !by_material && !by_extras && i < level.meshes.size(); ++i)
	{
		add(pathOf(level, level.meshes[i]));
	}
	if (names.size() > kListedParts)
	{
		names.back() = "others";
	}
	refuseInput(option, "'" + oneLine(pattern) + "'",
				"parts of " + level.name + (names.empty() ? ", which has none of that kind" : ": " + joinedText(names, ", ")),
				ExitCode::usage);
}

// True if a name has one of these words between characters that are no letters, as "UCX_Wall.001" has "ucx".
bool hasWord(std::string_view name, std::span<const std::string_view> words)
{
	const std::string lower = lowered(name) + " ";
	std::size_t begin = 0;
	for (std::size_t i = 0; i < lower.size(); ++i)
	{
		if (lower[i] < 'a' || lower[i] > 'z')
		{
			if (std::find(words.begin(), words.end(), std::string_view(lower).substr(begin, i - begin)) != words.end())
			{
				return true;
			}
			begin = i + 1;
		}
	}
	return false;
}

// A mesh around all others, as a sky is: there is half the diagonal of the others between their box and its own on each side. The
// number of meshes if there is none.
std::size_t shellOf(const Level& level)
{
	std::size_t largest = level.meshes.size();
	Bounds shell;
	for (std::size_t i = 0; i < level.meshes.size(); ++i)
	{
		const Bounds box = boundsOf(level, level.meshes[i]);
		if (i == 0 || glm::distance(box.least, box.most) > glm::distance(shell.least, shell.most))
		{
			largest = i;
			shell = box;
		}
	}
	Bounds others;
	for (std::size_t i = 0; i < level.meshes.size(); ++i)
	{
		const Bounds box = i == largest ? Bounds{} : boundsOf(level, level.meshes[i]);
		others = {glm::min(others.least, box.least), glm::max(others.most, box.most)};
	}
	const glm::dvec3 gap(0.5 * glm::distance(others.least, others.most));
	const bool around =
		glm::all(glm::lessThan(shell.least + gap, others.least)) && glm::all(glm::lessThan(others.most + gap, shell.most));
	return around && level.meshes.size() > 1 ? largest : level.meshes.size();
}

} // namespace

std::vector<uint8_t> chosenTriangles(const Level& level, std::span<const std::string> patterns, const std::string& option)
{
	std::vector<uint8_t> chosen(patterns.empty() ? 0 : level.triangles.size(), 0);
	for (const std::string& text : patterns)
	{
		const bool by_material = text.starts_with("material:");
		const bool by_extras = text.starts_with("extras:");
		const bool by_name = !by_material && !by_extras;
		const std::string_view glob = by_name ? text : std::string_view(text).substr(text.find(':') + 1);
		const std::vector<std::string_view> steps = by_name ? stepsOf(text) : std::vector<std::string_view>();
		if (steps.size() > kMostSteps)
		{
			refusePattern(level, text, option);
		}
		std::vector<uint64_t> reached;
		std::vector<uint8_t> nodes; // 1: chosen
		for (const PartNode& node : level.nodes)
		{
			const auto parent = static_cast<std::size_t>(std::max(node.parent, 0));
			reached.push_back(reachedBy(steps, node.parent < 0 ? 1 : reached[parent], node.name));
			const bool own = by_name ? (reached.back() >> steps.size() & 1U) != 0 : by_extras && hasExtra(node.extras, glob);
			nodes.push_back(own || (node.parent >= 0 && nodes[parent] != 0) ? 1 : 0);
		}
		const std::vector<bool> materials =
			mapped(level.material_list, [&](const Material& material)
				   { return by_material ? isGlobOf(glob, material.name) : by_extras && hasExtra(material.extras, glob); });
		bool any = false;
		for (const Mesh& mesh : level.meshes)
		{
			const bool named = by_name && (isGlobOf(glob, mesh.name) ||
										   (mesh.node < 0 && (reachedBy(steps, 1, mesh.name) >> steps.size() & 1U) != 0));
			const bool whole = named || (mesh.node >= 0 && nodes[static_cast<std::size_t>(mesh.node)] != 0);
			for (std::size_t t = mesh.first_triangle; t < mesh.first_triangle + mesh.triangle_count; ++t)
			{
				const bool here = whole || materials[level.materials[t]];
				chosen[t] = here ? 1 : chosen[t];
				any = any || here;
			}
		}
		if (!any)
		{
			refusePattern(level, text, option);
		}
	}
	return chosen;
}

std::string pathOf(const Level& level, const Mesh& mesh)
{
	return "/" + joinedText(namesDownTo(level, mesh), "/");
}

LevelPart partOf(const Level& level, std::span<const uint8_t> marks, int threads)
{
	LevelPart part{level, std::vector<uint32_t>(level.positions.size(), UINT32_MAX)};
	const std::vector<uint32_t> before = compactLevel(part.level, marks, threads);
	for (uint32_t i = 0; i < before.size(); ++i)
	{
		part.vertices[before[i]] = i;
	}
	return part;
}

void findUndrawn(const Level& level, std::vector<Finding>& findings)
{
	static constexpr std::array<std::string_view, 8> kCollision{"ucx",       "ubx",      "usp",     "ucp",
																"collision", "collider", "colonly", "convcolonly"};
	static constexpr std::array<std::string_view, 4> kSky{"sky", "skybox", "skydome", "skysphere"};
	const std::size_t shell = shellOf(level);
	for (const auto& [id, words] :
		 {std::pair<const char*, std::span<const std::string_view>>("collision-meshes", kCollision), {"skies", kSky}})
	{
		Tally tally;
		for (const Mesh& mesh : level.meshes)
		{
			const std::vector<std::string_view> names = namesDownTo(level, mesh);
			const auto* const named = firstWhere(names, [&words = words](auto name) { return hasWord(name, words); });
			if (named != nullptr)
			{
				tally.add("mesh '" + mesh.name + "', which --ignore '" + std::string(*named) + "' leaves out");
			}
			else if (words.data() == kSky.data() && &mesh == level.meshes.data() + shell)
			{
				tally.add("mesh '" + mesh.name + "' around all others, which --ignore '" + pathOf(level, mesh) + "' leaves out");
			}
		}
		report(findings, id, tally);
	}
	const Bounds main = mainBounds(level);
	Tally strays;
	for (const Mesh& mesh : level.meshes)
	{
		const Bounds box = boundsOf(level, mesh);
		const double away_m = glm::length(glm::max(glm::max(box.least - main.most, main.least - box.most), 0.0));
		if (away_m > 0.0 && mesh.triangle_count > 0)
		{
			strays.add("mesh '" + mesh.name + "', " + roundedText(away_m, 3) + " m from the rest, which --ignore '" +
					   pathOf(level, mesh) + "' leaves out");
		}
	}
	report(findings, "strays", strays);
}

} // namespace nook
