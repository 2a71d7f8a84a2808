// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/method_table.h"

#include "core/decimal.h"
#include "core/lists.h"

#include <algorithm>
#include <cassert>
#include <cctype>
#include <cstdlib>
#include <initializer_list>
#include <iterator>

namespace nook
{
namespace
{

std::vector<MethodRow> rows()
{
	std::vector<MethodRow> all;
	for (const auto& group : {volumetricRows, alchemyRows, statVoRows, sliceRows, publishedRows, volumeRows})
	{
		std::vector<MethodRow> some = group();
		std::move(some.begin(), some.end(), std::back_inserter(all));
	}
	for (std::size_t i = 0; i < all.size() && all[i].kind == MethodKind::screen; ++i)
	{
		all[i].method = static_cast<ShadeMethod>(i);
	}
	return all;
}

// The tables of methods and features in Markdown.

std::string line(std::initializer_list<std::string> cells)
{
	std::string text = "|";
	for (const std::string& cell : cells)
	{
		text += cell.empty() ? " |" : " " + cell + " |";
	}
	return text + "\n";
}

// Powers of ten in scientific form: "1e-6", "1e3"; others as "0.05".
std::string plainNumber(double value)
{
	for (int power = -12; power <= 12; ++power)
	{
		const std::string text = "1e" + std::to_string(power);
		if (std::abs(power) >= 3 && std::strtod(text.c_str(), nullptr) == value)
		{
			return text;
		}
	}
	return numberText(value);
}

// Words as code, numbers unchanged.
std::string choiceText(std::string_view choice)
{
	const bool number = std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
	return number ? std::string(choice) : "`" + std::string(choice) + "`";
}

std::string samplesText(const MethodRow& method)
{
	const char* const other = method.kind != MethodKind::volumes && hasNoise(method) ? "its own" : "none";
	return method.domain ? std::string(nameOf(*method.domain)) : other;
}

std::string passesText(const MethodRow& method)
{
	return method.moments                 ? "moments of depth"
		   : method.levels != nullptr     ? "coarser depths"
		   : method.add_passes != nullptr ? "tables of sums"
										  : "";
}

std::string needsText(const MethodRow& method)
{
	const std::string normals = method.needs_normals ? "normals" : (method.features & kOfNormals) != 0 ? "normals or none" : "";
	return method.kind == MethodKind::volumes ? "volumes, " + normals : normals;
}

} // namespace

std::span<const MethodRow> methodTable()
{
	static const std::vector<MethodRow> table = rows();
	return table;
}

template <> std::span<const std::string_view> namesOf<ShadeMethod>()
{
	static const std::vector<std::string_view> names =
		mapped(itemsWhere(methodTable(), [](const MethodRow& row) { return row.kind == MethodKind::screen; }),
			   [](const MethodRow& row) { return row.name; });
	return names;
}

const MethodRow& rowOf(ShadeMethod method)
{
	const MethodRow& row = methodTable()[static_cast<std::size_t>(method)];
	assert(row.kind == MethodKind::screen && row.method == method);
	return row;
}

const MethodRow& volumeRow(bool masks)
{
	return *firstWhere(methodTable(),
					   [masks](const MethodRow& row) { return row.kind == MethodKind::volumes && row.masks == masks; });
}

const MethodRow* methodNamed(std::string_view name)
{
	return firstWhere(methodTable(), [name](const MethodRow& row) { return row.name == name; });
}

std::string methodNames(const std::function<bool(const MethodRow&)>& fits, const std::string& between)
{
	return joinedText(itemsWhere(methodTable(), fits), between, [](const MethodRow& row) { return row.name; });
}

bool hasNoise(const MethodRow& row)
{
	return row.samples_view.call[0] != '\0';
}

ShadeKernel allSamples()
{
	return {"samples", "nookDebugSamplesAll", &shade_kernels::Kernels::nookDebugSamplesAll};
}

int sampleDepths(const MethodRow& row, const ShadeSettings& settings)
{
	return row.sample_depths != nullptr ? row.sample_depths(settings) : 1;
}

bool hasPasses(const MethodRow& row, const ShadeSettings& settings)
{
	return row.moments || row.add_passes != nullptr || (row.levels != nullptr && row.levels(settings) > 0);
}

bool takesPattern(ShadeMethod method)
{
	return rowOf(method).domain.has_value();
}

bool mayTakeTile(ShadeMethod method)
{
	return rowOf(method).tile_domain.has_value();
}

Domain domainOf(ShadeMethod method)
{
	const MethodRow& row = rowOf(method);
	assert(row.domain || row.tile_domain);
	return row.domain ? *row.domain : *row.tile_domain;
}

ShadeSamples ownSamples(const ShadeSettings& settings)
{
	assert(!takesPattern(settings.method));
	return rowOf(settings.method).own_samples(settings);
}

std::string methodsText()
{
	std::string text = line({"method", "what it is", "kernel", "samples", "passes before", "emitted", "needs", "page"}) +
					   "| --- | --- | --- | --- | --- | --- | --- | --- |\n";
	for (const MethodRow& method : methodTable())
	{
		text += line({"`" + std::string(method.name) + "`", std::string(method.what), method.kernel.call, samplesText(method),
					  passesText(method), method.emitted ? "yes" : "no", needsText(method), std::string(method.page)});
	}
	return text;
}

std::string rangeText(const FeatureRow& feature)
{
	if (!feature.range.empty() || feature.kind == FeatureKind::flag)
	{
		return std::string(feature.range);
	}
	return feature.kind == FeatureKind::choice ? joinedText(feature.choices, ", ", choiceText)
											   : plainNumber(feature.least) + " to " + plainNumber(feature.most);
}

std::string defaultText(const FeatureRow& feature)
{
	const ShadeSettings defaults;
	const double value = feature.value.get(defaults);
	switch (feature.kind)
	{
	case FeatureKind::flag: return value != 0.0 ? "on" : "off";
	case FeatureKind::choice: return value < 0.0 ? std::string() : choiceText(valueText(feature, defaults));
	case FeatureKind::whole:
	case FeatureKind::number: break;
	}
	return value == 0.0 && !feature.nothing.empty() ? std::string(feature.nothing) : plainNumber(value);
}

std::string optionsText(const MethodRow& method)
{
	std::string text = line({"option", "unit", "range", "default", "what it does"}) + "| --- | --- | --- | --- | --- |\n";
	for (const FeatureRow& feature : featureTable())
	{
		if ((feature.places & kInShade) != 0 && !isForAll(feature) && takesFeature(method, feature))
		{
			text += line({"`" + std::string(feature.option) + "`", std::string(feature.unit), rangeText(feature),
						  defaultText(feature), std::string(feature.help)});
		}
	}
	return text;
}

} // namespace nook
