// SPDX-License-Identifier: GPL-3.0-or-later
#include "noise_report/known.h"

#include "noise_report/measures.h"

#include <array>
#include <optional>

namespace nook
{
namespace
{

struct Entry
{
	const char* pattern;
	Domain domain;
	std::optional<Method> method;   // absent: the best of all
	std::optional<Variant> variant; // absent: any
	int count;
	double cliff; // 0: not known
	double plane;
	double centre;
};

constexpr std::optional<Method> kAnyMethod;
constexpr std::optional<Variant> kAnyVariant;

// Known good values collected when the measures were defined: disk and ball under the same ensembles and grids
// (docs/reference/measures.md).
const std::array<Entry, 23> kEntries{{
	{"random", Domain::disk, Method::random, Variant::free, 9, 0.122, 0.086, 0.127},
	{"random", Domain::disk, Method::random, Variant::free, 16, 0.087, 0.059, 0.087},
	{"Vogel spiral", Domain::disk, Method::vogel, Variant::free, 9, 0.0551, 0.0216, 0.029},
	{"Vogel spiral", Domain::disk, Method::vogel, Variant::free, 16, 0.0351, 0.0118, 0.014},
	{"Vogel spiral", Domain::disk, Method::vogel, Variant::free, 64, 0.0121, 0.0028, 0.0030},
	{"sliced optimal transport", Domain::disk, kAnyMethod, kAnyVariant, 9, 0.0527, 0.0201, 0.022},
	{"sliced optimal transport", Domain::disk, kAnyMethod, kAnyVariant, 16, 0.0342, 0.0114, 0.015},
	{"sliced optimal transport", Domain::disk, kAnyMethod, kAnyVariant, 32, 0.0202, 0.0056, 0.0064},
	{"sliced optimal transport", Domain::disk, kAnyMethod, kAnyVariant, 64, 0.0119, 0.0028, 0.0037},
	{"weighted centroidal Voronoi, best of starts", Domain::disk, Method::lloyd, kAnyVariant, 9, 0.0487, 0.0184, 0.0},
	{"weighted centroidal Voronoi, best of starts", Domain::disk, Method::lloyd, kAnyVariant, 16, 0.0315, 0.0107, 0.0},
	{"weighted centroidal Voronoi, best of starts", Domain::disk, Method::lloyd, kAnyVariant, 32, 0.0187, 0.0055, 0.0},
	{"weighted centroidal Voronoi, best of starts", Domain::disk, Method::lloyd, kAnyVariant, 64, 0.0111, 0.0029, 0.0},
	{"hill-climb on cliff, antipodal", Domain::disk, Method::refine, Variant::symmetric, 8, 0.0531, 0.0200, 0.0},
	{"hill-climb on cliff, antipodal", Domain::disk, Method::refine, Variant::symmetric, 9, 0.0488, 0.0181, 0.0},
	{"hill-climb on cliff, antipodal", Domain::disk, Method::refine, Variant::symmetric, 12, 0.0390, 0.0133, 0.0},
	{"hill-climb on cliff, antipodal", Domain::disk, Method::refine, Variant::symmetric, 16, 0.0316, 0.0104, 0.0},
	{"sliced optimal transport, best of 20", Domain::ball, kAnyMethod, kAnyVariant, 8, 0.0, 0.0612, 0.0},
	{"sliced optimal transport, best of 20", Domain::ball, kAnyMethod, kAnyVariant, 16, 0.0, 0.0378, 0.0},
	{"sliced optimal transport, best of 20", Domain::ball, kAnyMethod, kAnyVariant, 32, 0.0, 0.0237, 0.0},
	{"sliced optimal transport, best of 20", Domain::ball, kAnyMethod, kAnyVariant, 64, 0.0, 0.0149, 0.0},
	{"centroidal Voronoi", Domain::ball, Method::lloyd, kAnyVariant, 16, 0.0, 0.0399, 0.0},
	{"centroidal Voronoi", Domain::ball, Method::lloyd, kAnyVariant, 64, 0.0, 0.0153, 0.0},
}};

KnownValue compare(const NoiseReport& report, const Entry& entry, std::string_view measure, double value)
{
	KnownValue known{entry.pattern, entry.domain, std::string(measure), entry.count, value, 0.0, ""};
	for (const NoiseRow& row : report.rows)
	{
		const bool fits = row.recipe.domain == entry.domain && row.recipe.count == entry.count &&
						  row.recipe.method == entry.method.value_or(row.recipe.method) &&
						  row.variant == entry.variant.value_or(row.variant);
		const std::optional<double> ours = fits ? measureNamed(measure).get(row.quality) : std::nullopt;
		if (ours && (known.by.empty() || *ours < known.ours))
		{
			known.ours = *ours;
			known.by = std::string(nameOf(row.recipe.method)) + ", " + std::string(nameOf(row.variant));
		}
	}
	return known;
}

} // namespace

std::vector<KnownValue> compareKnownValues(const NoiseReport& report)
{
	std::vector<KnownValue> values;
	for (const Entry& entry : kEntries)
	{
		if (entry.count > report.settings.max_count)
		{
			continue;
		}
		if (entry.cliff > 0.0)
		{
			values.push_back(compare(report, entry, "cliff", entry.cliff));
		}
		values.push_back(compare(report, entry, "plane", entry.plane));
		if (entry.centre > 0.0 && entry.method)
		{
			values.push_back(compare(report, entry, "centre", entry.centre));
		}
	}
	return values;
}

} // namespace nook
