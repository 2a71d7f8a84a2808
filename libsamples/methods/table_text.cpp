// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/table_text.h"

#include "core/number.h"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <initializer_list>

namespace nook
{
namespace
{

std::string line(std::initializer_list<std::string> cells)
{
	std::string text = "|";
	for (const std::string& cell : cells)
	{
		text += cell.empty() ? " |" : " " + cell + " |";
	}
	return text + "\n";
}

// Powers of ten from afar as such: "1e-6", "1e3"; else "0.05".
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

// Words as code, numbers as they are.
std::string choiceText(std::string_view choice)
{
	const bool number = std::all_of(choice.begin(), choice.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
	return number ? std::string(choice) : "`" + std::string(choice) + "`";
}

std::string samplesText(const MethodRow& method)
{
	if (method.kind == MethodKind::volumes)
	{
		return "none";
	}
	return method.domain ? std::string(nameOf(*method.domain)) : hasNoise(method) ? "its own" : "none";
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
	if (feature.kind != FeatureKind::choice)
	{
		return plainNumber(feature.least) + " to " + plainNumber(feature.most);
	}
	std::string text;
	for (const std::string_view choice : feature.choices)
	{
		text += (text.empty() ? "" : ", ") + choiceText(choice);
	}
	return text;
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
		if ((feature.places & kInShade) != 0 && feature.features != 0 && takesFeature(method, feature))
		{
			text += line({"`" + std::string(feature.option) + "`", std::string(feature.unit), rangeText(feature),
						  defaultText(feature), std::string(feature.help)});
		}
	}
	return text;
}

} // namespace nook
