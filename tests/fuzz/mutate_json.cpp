// SPDX-License-Identifier: GPL-3.0-or-later
#include "mutate_json.h"

#include <nlohmann/json.hpp>

#include <array>
#include <vector>

namespace nook::fuzz
{
namespace
{

// Every location in a document except its root. `at` is a copy, since its list may be reallocated.
void addPlaces(const nlohmann::json& value, nlohmann::json::json_pointer at, std::vector<nlohmann::json::json_pointer>& places)
{
	if (value.is_structured())
	{
		for (const auto& [key, below] : value.items())
		{
			places.push_back(at / key);
			addPlaces(below, places.back(), places);
		}
	}
}

nlohmann::json hardNumber(const nlohmann::json& before, Chance& chance)
{
	static const std::vector<nlohmann::json> kSome{
		0,   1,    2,     3,    4,     -1,   255,  256,  65535, 65536, 2147483647, 4294967295U, 4294967296, 18446744073709551615U,
		0.5, -0.0, 1e-45, 1e38, 1e308, 5120, 5121, 5122, 5123,  5125,  5126,       34962,       34963};
	const std::size_t which = below(chance, kSome.size() + 12);
	if (which < kSome.size() || !before.is_number())
	{
		return kSome[which % kSome.size()];
	}
	const double number = before.get<double>();
	const std::array<double, 6> near{number + 1, number - 1, number * 2, number / 2, number + 4, -number};
	const double other = near[below(chance, near.size())];
	return other == static_cast<double>(static_cast<std::int32_t>(std::clamp(other, -2e9, 2e9)))
			   ? nlohmann::json(static_cast<std::int64_t>(other))
			   : nlohmann::json(other);
}

nlohmann::json hardText(const nlohmann::json& before, Chance& chance)
{
	static const std::vector<std::string> kSome{"",
												"SCALAR",
												"VEC2",
												"VEC3",
												"VEC4",
												"MAT3",
												"MAT4",
												"POSITION",
												"NORMAL",
												"TEXCOORD_0",
												"TEXCOORD_1",
												"MASK",
												"BLEND",
												"OPAQUE",
												"perspective",
												"orthographic",
												"2.0",
												"2.1",
												"data:,",
												"../a.bin",
												"KHR_mesh_quantization",
												"EXT_meshopt_compression",
												"KHR_texture_transform",
												"KHR_draco_mesh_compression",
												"ATTRIBUTES",
												"TRIANGLES",
												"INDICES",
												"OCTAHEDRAL",
												"disk",
												"ball",
												"sphere",
												"hemisphere"};
	const std::size_t which = below(chance, kSome.size() + 2);
	return which < kSome.size() || !before.is_string() ? nlohmann::json(kSome[which % kSome.size()])
													   : nlohmann::json(before.get<std::string>() + "\xC3\xA9<");
}

// Changes one location: another value, one from elsewhere, another type, a duplicate, or nothing.
void mutateJson(nlohmann::json& document, Chance& chance)
{
	std::vector<nlohmann::json::json_pointer> places;
	addPlaces(document, nlohmann::json::json_pointer(), places);
	if (places.empty())
	{
		document = nlohmann::json::object();
		return;
	}
	const nlohmann::json::json_pointer at = places[below(chance, places.size())];
	nlohmann::json& parent = document[at.parent_pointer()];
	nlohmann::json& value = document[at];
	switch (below(chance, 8))
	{
	case 0: parent.is_array() ? parent.erase(std::stoul(at.back())) : static_cast<void>(parent.erase(at.back())); break;
	case 1:
	{
		const nlohmann::json copy = value;
		parent.is_array() ? parent.push_back(copy) : static_cast<void>(parent[at.back() + "_"] = copy);
		break;
	}
	case 2:
	{
		const nlohmann::json copy = document[places[below(chance, places.size())]];
		document[at] = copy;
		break;
	}
	case 3:
	{
		static const std::vector<nlohmann::json> kTypes{
			nullptr, true, 0, -1.5, "", nlohmann::json::array(), nlohmann::json::object(), nlohmann::json::array({0, 1, 2})};
		value = kTypes[below(chance, kTypes.size())];
		break;
	}
	default: value = value.is_string() ? hardText(value, chance) : value.is_structured() ? value : hardNumber(value, chance);
	}
}

// Maximum number of open brackets, including those in strings.
std::size_t nesting(const std::string& text)
{
	std::size_t open = 0;
	std::size_t most = 0;
	for (const char c : text)
	{
		open += c == '[' || c == '{' ? 1 : 0;
		open -= (c == ']' || c == '}') && open > 0 ? 1 : 0;
		most = std::max(most, open);
	}
	return most;
}

// Deep nesting would overflow this program's own stack, so such text is mutated as bytes.
nlohmann::json parsed(const std::string& text)
{
	constexpr std::size_t kDeep = 100;
	return nesting(text) > kDeep ? nlohmann::json(nlohmann::json::value_t::discarded) : nlohmann::json::parse(text, nullptr, false);
}

} // namespace

std::string mutatedJsonText(const std::string& text, std::size_t most, Chance& chance)
{
	nlohmann::json document = parsed(below(chance, 8) == 0 ? std::string() : text);
	if (document.is_discarded() || !document.is_structured())
	{
		return mutatedBytes(text, most);
	}
	for (std::size_t i = 0; i <= below(chance, 4); ++i)
	{
		mutateJson(document, chance);
	}
	return document.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string mutatedGlb(const std::string& glb, std::size_t most, Chance& chance)
{
	constexpr std::size_t kHead = 20;
	if (glb.size() < kHead || wordAt(glb, 12) > glb.size() - kHead || below(chance, 16) == 0)
	{
		return mutatedBytes(glb, most);
	}
	const std::size_t json_size = wordAt(glb, 12);
	std::string text = glb.substr(kHead, json_size);
	const std::size_t binary_at = kHead + json_size + 8;
	std::string binary = binary_at <= glb.size() ? glb.substr(binary_at) : std::string();
	if (below(chance, 3) == 0)
	{
		binary = mutatedBytes(binary, binary.size() + 64);
	}
	else
	{
		text = mutatedJsonText(text, text.size() + 64, chance);
	}
	text.resize((text.size() + 3) / 4 * 4, ' ');
	binary.resize((binary.size() + 3) / 4 * 4, '\0');
	const auto json_length = static_cast<std::uint32_t>(text.size());
	const auto binary_length = static_cast<std::uint32_t>(binary.size());
	const std::uint32_t lie = below(chance, 16) == 0 ? static_cast<std::uint32_t>(chance()) : 0;
	return "glTF" + wordBytes(2) + wordBytes((28 + json_length + binary_length) ^ (lie % 3 == 1 ? lie : 0)) +
		   wordBytes(json_length ^ (lie % 3 == 2 ? lie : 0)) + "JSON" + text + wordBytes(binary_length ^ lie) +
		   std::string("BIN\0", 4) + binary;
}

} // namespace nook::fuzz
