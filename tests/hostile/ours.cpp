// SPDX-License-Identifier: GPL-3.0-or-later
// Broken files of nook's own formats: patterns, tiles, recipes, volumes, parts of commands, plans, lists of levels.
#include "corpus.h"

#include "../level_files.h"

#include "core/content_hash.h"
#include "core/json_reader.h"
#include "core/json_text.h"

namespace nook::hostile
{
namespace
{

using nlohmann::json;

void addJson(Cases& cases, const std::string& name, const std::string& text)
{
	addFields(cases, name + "/fields", "035", parseJson(text, name),
			  [&](const json& document) {
				  return std::vector<std::pair<std::string, std::string>>{{name + ".json", jsonLine(document)}};
			  });
	addCuts(cases, name + "/cuts", "3", name + ".json", text.substr(0, text.rfind('}') + 1));
}

// The maximum number of variants, made for the widest filter: a short file that is expensive to measure.
void addLargeTile(Cases& cases, const std::string& text)
{
	json tile = parseJson(text, "frames.json");
	constexpr int kSize = 128;
	tile["size"] = kSize;
	tile["recipe"]["size"] = kSize;
	tile["recipe"]["filters"][0]["width"] = 65;
	tile["recipe"]["filters"][0]["taps"] = std::vector<double>(65 * 65, 1.0);
	const json variant = tile["variants"][0];
	tile["variants"] = std::vector<json>(kSize * kSize, variant);
	for (const int frames : {2, 64})
	{
		tile["frames"] = frames;
		tile["recipe"]["frames"] = frames;
		tile["moves"] = std::vector<std::vector<int>>(static_cast<std::size_t>(frames), std::vector<int>{1, 2});
		cases.push_back({"frames/large", std::to_string(frames) + " frames", "0", {{"frames.json", jsonLine(tile)}}});
	}
}

// Changes the JSON of a GLB and keeps everything else.
void addVolumes(Cases& cases, const std::string& glb)
{
	uint32_t length = 0;
	std::memcpy(&length, glb.data() + 12, sizeof length);
	const json document = parseJson(glb.substr(20, length), "a.glb");
	const std::string chunk = glb.substr(28 + length);
	addFields(cases, "volumes/fields", "035", document,
			  [&](const json& changed) {
				  return std::vector<std::pair<std::string, std::string>>{{"a.glb", glbBytes(changed, chunk)}};
			  });
	addCuts(cases, "volumes/cuts", "3", "a.glb", glb);
	for (std::size_t at = 28 + length; at + 4 <= glb.size(); at += 40)
	{
		for (const uint32_t value : {0U, 0xFFFFFFFFU, 0x7F800000U})
		{
			std::string changed = glb;
			std::memcpy(changed.data() + at, &value, sizeof value);
			cases.push_back({"volumes/values", "bytes at " + std::to_string(at), "035", {{"a.glb", changed}}});
		}
	}
}

void addPlans(Cases& cases, const std::string& plan)
{
	addFields(cases, "plan/fields", "03", parseJson(plan, "plan.json"),
			  [&](const json& document) {
				  return std::vector<std::pair<std::string, std::string>>{{"plan.json", jsonLine(document)}};
			  });
	addCuts(cases, "plan/cuts", "3", "plan.json", plan.substr(0, plan.rfind('}') + 1));
	const json list = parseJson(R"({"schema": "nook.levels/1", "values": {"rays": "16"},
		"steps": [{"name": "depth", "command": ["gbuffer", "{level}", "--size", "16x9", "-o", "{name}.g.exr"]},
			{"name": "rays", "shares": 3, "minutes": 4,
			 "command": ["reference", "{level}", "--gbuffer", "{name}.g.exr", "--radius", "1", "--rays", "{rays}", "-o", "{name}.exr"]}],
		"levels": [{"name": "one", "level": "builtin:cornell"}, {"name": "two", "level": "builtin:suburb", "values": {"rays": "4"}}]})",
								"list.json");
	addFields(cases, "levels/fields", "01235", list,
			  [&](const json& document) {
				  return std::vector<std::pair<std::string, std::string>>{{"list.json", jsonLine(document)}};
			  });
	addCuts(cases, "levels/cuts", "3", "list.json", jsonLine(list));
}

} // namespace

void addOurs(Cases& cases, const Seeds& seeds)
{
	addJson(cases, "pattern", seeds.at("pattern.json"));
	addJson(cases, "tile", seeds.at("tile.json"));
	addJson(cases, "frames", seeds.at("frames.json"));
	addJson(cases, "recipes", seeds.at("recipes.json"));
	addLargeTile(cases, seeds.at("frames.json"));
	addVolumes(cases, seeds.at("volumes.glb"));
	addPlans(cases, seeds.at("plan.json"));
	for (const std::string& number : oddNumbers())
	{
		std::string changed = seeds.at("pattern.csv");
		const std::size_t line = changed.rfind('\n', changed.size() - 2) + 1;
		changed.replace(line, changed.find(',', line) - line, number);
		cases.push_back({"csv/numbers", number.substr(0, 60), "03", {{"a.csv", changed}}});
	}
	addCuts(cases, "csv/cuts", "03", "a.csv", seeds.at("pattern.csv"));
}

} // namespace nook::hostile
