// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of methods and features: consistency of rows, round trips of setters, words and commands.
#include "testing.h"

#include "methods/feature_table.h"
#include "methods/method_table.h"

namespace
{

// A non-default value in range.
double otherValue(const FeatureRow& feature)
{
	const double normal = feature.value.get(ShadeSettings{});
	switch (feature.kind)
	{
	case FeatureKind::flag: return 1.0 - normal;
	case FeatureKind::choice: return normal == 1.0 ? 0.0 : 1.0;
	case FeatureKind::whole: return normal == feature.least ? feature.least + 1.0 : feature.least;
	case FeatureKind::number: break;
	}
	return normal == feature.most ? feature.least : feature.most;
}

} // namespace

TEST_CASE("methods: a row each, in the order of their numbers, with kernel, samples and page", "[methods]")
{
	std::set<std::string_view> names;
	std::set<int> bindings;
	std::size_t screen = 0;
	for (const MethodRow& row : methodTable())
	{
		INFO(row.name);
		CHECK(names.insert(row.name).second);
		CHECK(methodNamed(row.name) == &row);
		CHECK(row.page.ends_with(".md"));
		if (row.kind == MethodKind::volumes)
		{
			CHECK(&volumeRow(row.masks) == &row);
			continue;
		}
		CHECK(static_cast<std::size_t>(row.method) == screen++);
		CHECK(&rowOf(row.method) == &row);
		CHECK(nameOf(row.method) == row.name);
		CHECK(std::string_view(row.kernel.call).starts_with("nook"));
		CHECK(row.domain.has_value() != (row.own_samples != nullptr));
		CHECK((row.lod_view.call[0] != '\0') == (row.moments || row.levels != nullptr));
		CHECK((row.passes_text != nullptr) == (row.add_passes != nullptr));
		if (row.emitted && row.domain)
		{
			CHECK(row.tile_binding > 0);
			CHECK(bindings.insert(row.tile_binding).second);
		}
		for (const GridSize size : {GridSize::quick, GridSize::normal, GridSize::full})
		{
			CHECK_FALSE(row.axes(size).empty());
		}
	}
	CHECK(methodNamed("rays") == nullptr);
	CHECK(methodNames([](const MethodRow& row) { return row.moments; }) == "vo-area");
}

TEST_CASE("methods: the count of a candidate is the number of samples that are drawn", "[methods]")
{
	const MethodRow row = GENERATE(from_range(methodTable()));
	if (row.set_count != nullptr)
	{
		ShadeSettings settings;
		settings.method = row.method;
		row.set_count(settings, 2);
		const bool layers = row.layers_text != nullptr;
		CHECK((layers ? settings.statvo.layers : ownSamples(settings).count) == 2);
		const int best = row.set_best(settings);
		CHECK((layers ? settings.statvo.layers : ownSamples(settings).count) == best);
	}
}

TEST_CASE("features: what is set is got, and nothing else changes", "[methods]")
{
	std::set<std::string_view> options;
	for (const FeatureRow& feature : featureTable())
	{
		INFO(feature.option);
		CHECK(options.insert(feature.option).second);
		CHECK(&featureOf(feature.option) == &feature);
		const ShadeSettings defaults;
		CHECK_FALSE(isOn(feature, defaults));
		ShadeSettings settings;
		const double other = otherValue(feature);
		feature.value.set(settings, other);
		CHECK(feature.value.get(settings) == other);
		CHECK(isOn(feature, settings));
		for (const FeatureRow& second : featureTable())
		{
			// --thick is --thickness without a number, and --third-radius is --radius3.
			const auto isThird = [](const FeatureRow& row)
			{
				return row.option == "--radius3" || row.option == "--third-radius";
			};
			const bool same = (second.option.starts_with("--thick") && feature.option.starts_with("--thick")) ||
							  (isThird(second) && isThird(feature));
			CHECK((&second == &feature || same || !isOn(second, settings)));
		}
		if (feature.kind == FeatureKind::choice)
		{
			for (std::size_t i = 0; i < feature.choices.size(); ++i)
			{
				feature.value.set(settings, static_cast<double>(i));
				CHECK(valueText(feature, settings) == feature.choices[i]);
			}
		}
	}
}

TEST_CASE("features: each goes with a method, says its default in its help, and names options that are there", "[methods]")
{
	const FeatureRow feature = GENERATE(from_range(featureTable()));
	INFO(feature.option);
	CHECK_FALSE(methodNames([&](const MethodRow& row) { return takesFeature(row, feature); }).empty());
	for (const std::string_view other : {feature.needs, feature.base, feature.conflict})
	{
		CHECK((other.empty() || featureOf(other).option == other));
	}
	if (feature.kind == FeatureKind::whole || feature.kind == FeatureKind::number)
	{
		const double value = feature.value.get(ShadeSettings{});
		const bool none = value == 0.0 && !feature.nothing.empty();
		CHECK((none || (value >= feature.least && value <= feature.most)));
		const bool says = feature.help.find("default") != std::string_view::npos &&
						  feature.help.find(none ? std::string(feature.nothing) : defaultText(feature)) != std::string_view::npos;
		CHECK((says || !feature.needs.empty()));
	}
}

TEST_CASE("features: commands and names say what is on, in the table's order", "[methods]")
{
	ShadeSettings settings;
	settings.method = ShadeMethod::vo_line;
	CHECK(emitOptions(settings).empty());
	CHECK(featureWords(settings).empty());
	settings.use_normal = false;
	settings.volume.thickness_m = 0.25;
	settings.volume.paired = true;
	settings.cut = true; // a feature of another method
	settings.filter = ShadeFilter::bilateral;
	settings.half_resolution = true;
	CHECK(emitOptions(settings) == " --use-normal no --thick --paired --filter bilateral --taps 5 --resolution half");
	CHECK(featureWords(settings) == " no-normal thick paired half");

	ShadeSettings layers;
	layers.method = ShadeMethod::statvo;
	CHECK(emitOptions(layers) == " --layers 4");
	CHECK(featureWords(layers) == " skip");
	layers.statvo.cell_px = 4;
	layers.statvo.skip = false;
	CHECK(emitOptions(layers) == " --layers 4 --tables quarter --skip no");
	CHECK(featureWords(layers) == " cells-4");
}

TEST_CASE("features: ranges and defaults as the docs write them", "[methods]")
{
	CHECK(rangeText(featureOf("--beta")) == "0 to 1");
	CHECK(defaultText(featureOf("--beta")) == "1e-4");
	CHECK(rangeText(featureOf("--slope")) == "1e-3 to 1e3");
	CHECK(rangeText(featureOf("--falloff")) == "`constant`, `quadratic`");
	CHECK(defaultText(featureOf("--falloff")) == "`constant`");
	CHECK(defaultText(featureOf("--normal-bits")) == "32");
	CHECK(defaultText(featureOf("--thickness")) == "no end");
	CHECK(defaultText(featureOf("--cut")) == "off");
	CHECK(defaultText(featureOf("--combine")).empty());
	const std::string text = optionsText(*methodNamed("crytek"));
	CHECK(text.find("| `--crytek-range` | radii | 1e-3 to 1e6 | 2.7 |") != std::string::npos);
	CHECK(text.find("--hbao") == std::string::npos);
}
