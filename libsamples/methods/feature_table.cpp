// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/feature_table.h"

#include "core/number.h"
#include "methods/feature_rows.h"
#include "methods/method_table.h"

#include <algorithm>
#include <cassert>

namespace nook
{

std::span<const FeatureRow> featureTable()
{
	static const std::vector<FeatureRow> table = featureRows();
	return table;
}

const FeatureRow& featureOf(std::string_view option)
{
	const std::span<const FeatureRow> table = featureTable();
	const auto found = std::find_if(table.begin(), table.end(), [option](const FeatureRow& row) { return row.option == option; });
	assert(found != table.end());
	return *found;
}

bool takesFeature(const MethodRow& method, const FeatureRow& feature)
{
	return method.kind == MethodKind::screen && (feature.features == 0 || (method.features & feature.features) != 0);
}

bool isOn(const FeatureRow& feature, const ShadeSettings& settings)
{
	return feature.value.get(settings) != feature.value.get(ShadeSettings{});
}

std::string valueText(const FeatureRow& feature, const ShadeSettings& settings)
{
	const double value = feature.value.get(settings);
	switch (feature.kind)
	{
	case FeatureKind::flag: break;
	case FeatureKind::whole: return std::to_string(static_cast<int>(value));
	case FeatureKind::number: return numberText(value);
	case FeatureKind::choice: return value < 0.0 ? std::string() : std::string(feature.choices[static_cast<std::size_t>(value)]);
	}
	return {};
}

std::string emitOptions(const ShadeSettings& settings)
{
	const MethodRow& method = rowOf(settings.method);
	std::string text;
	for (const FeatureRow& feature : featureTable())
	{
		const bool here = (feature.places & kInEmit) != 0 && takesFeature(method, feature) &&
						  (feature.applies == nullptr || feature.applies(settings));
		if (here && (feature.stated || isOn(feature, settings)))
		{
			text += " " + std::string(feature.option);
			text += feature.kind == FeatureKind::flag ? "" : " " + valueText(feature, settings);
		}
	}
	return text;
}

std::string featureWords(const ShadeSettings& settings)
{
	const MethodRow& method = rowOf(settings.method);
	std::string text;
	for (const FeatureRow& feature : featureTable())
	{
		const std::string word = feature.word != nullptr && takesFeature(method, feature) ? feature.word(settings) : std::string();
		text += word.empty() ? "" : " " + word;
	}
	return text;
}

} // namespace nook
