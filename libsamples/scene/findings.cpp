// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/load_parts.h"

#include <algorithm>
#include <array>
#include <cassert>

namespace nook
{
namespace
{

// All kinds of findings, in the order of docs/reference/levels.md.
struct Kind
{
	std::string_view id;
	std::string_view action;
};
constexpr std::array<Kind, 23> kKinds{{
	{"missing-file", "ignored"},
	{"hidden-nodes", "dropped"},
	{"lower-lods", "dropped"},
	{"posed-meshes", "applied"},
	{"not-applied", "ignored"},
	{"transmission", "kept"},
	{"inverted-transparency", "repaired"},
	{"points-or-lines", "dropped"},
	{"bad-polygons", "kept"},
	{"missing-uvs", "kept"},
	{"far-cameras", "dropped"},
	{"index-out-of-range", "dropped"},
	{"non-finite-vertices", "dropped"},
	{"degenerate-triangles", "dropped"},
	{"duplicate-faces", "dropped"},
	{"empty-meshes", "dropped"},
	{"bad-normals", "repaired"},
	{"sliver-triangles", "kept"},
	{"coincident-faces", "kept"},
	{"non-manifold-edges", "kept"},
	{"inconsistent-winding", "kept"},
	{"inside-out-parts", "kept"},
	{"large-coordinates", "kept"},
}};

std::size_t rankOf(std::string_view id)
{
	const auto* const found = std::find_if(kKinds.begin(), kKinds.end(), [&](const Kind& kind) { return kind.id == id; });
	assert(found != kKinds.end());
	return static_cast<std::size_t>(found - kKinds.begin());
}

} // namespace

void report(std::vector<Finding>& findings, std::string_view id, const Tally& tally)
{
	if (tally.count > 0)
	{
		findings.push_back({std::string(id), tally.count, tally.first, std::string(kKinds[rankOf(id)].action)});
	}
}

void addFindings(Diagnosis& diagnosis, const std::vector<Finding>& findings)
{
	for (const Finding& finding : findings)
	{
		const auto same = std::find_if(diagnosis.findings.begin(), diagnosis.findings.end(),
									   [&](const Finding& other) { return other.id == finding.id; });
		if (same == diagnosis.findings.end())
		{
			diagnosis.findings.push_back(finding);
			continue;
		}
		same->count += finding.count;
		same->first = finding.first; // occurred earlier
	}
	std::stable_sort(diagnosis.findings.begin(), diagnosis.findings.end(),
					 [](const Finding& a, const Finding& b) { return rankOf(a.id) < rankOf(b.id); });
}

} // namespace nook
