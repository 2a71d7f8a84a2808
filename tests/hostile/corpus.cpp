// SPDX-License-Identifier: GPL-3.0-or-later
// Shared by several kinds of hostile files.
#include "corpus.h"
#include "core/json_text.h"

namespace nook::hostile
{

void addCuts(Cases& cases, const std::string& group, const std::string& codes, const std::string& name, const std::string& whole)
{
	for (std::size_t size = 0; size < whole.size(); ++size)
	{
		cases.push_back({group, "cut at byte " + std::to_string(size), codes, {{name, whole.substr(0, size)}}});
	}
}

void addFields(Cases& cases, const std::string& group, const std::string& codes, const nlohmann::json& whole, const FilesOf& make)
{
	static const std::vector<nlohmann::json> kValues{nullptr,
													 true,
													 -1,
													 0,
													 0.5,
													 1e308,
													 4294967296,
													 18446744073709551615U,
													 "",
													 "x",
													 nlohmann::json::array(),
													 nlohmann::json::object()};
	const std::function<void(const nlohmann::json&, const nlohmann::json::json_pointer&)> walk =
		[&](const nlohmann::json& value, const nlohmann::json::json_pointer& at)
	{
		for (const nlohmann::json& other : kValues)
		{
			if (other == value)
			{
				continue;
			}
			nlohmann::json changed = whole;
			changed[at] = other;
			cases.push_back({group, at.to_string() + " = " + jsonLine(other), codes, make(changed)});
		}
		if (!at.empty())
		{
			nlohmann::json changed = whole;
			nlohmann::json& parent = changed[at.parent_pointer()];
			parent.is_array() ? parent.erase(std::stoul(at.back())) : static_cast<void>(parent.erase(at.back()));
			cases.push_back({group, at.to_string() + " left out", codes, make(changed)});
		}
		if (value.is_structured())
		{
			for (const auto& [key, below] : value.items())
			{
				walk(below, at / key);
			}
		}
	};
	walk(whole, nlohmann::json::json_pointer());
}

const std::vector<std::string>& oddNumbers()
{
	static const std::vector<std::string> kNumbers{"nan",
												   "inf",
												   "-inf",
												   "1e999",
												   "-1e999",
												   "1e-999",
												   "1e38",
												   "3.5e38",
												   "1e308",
												   "-0",
												   "0x10",
												   "010",
												   "1,5",
												   "1.5.5",
												   "1e",
												   "--1",
												   "+1",
												   ".",
												   "-",
												   "2147483648",
												   "4294967296",
												   "-2147483649",
												   "9223372036854775808",
												   "1/0",
												   "1//",
												   "999999999",
												   "-999999999",
												   std::string(5000, '9'),
												   "0." + std::string(5000, '0') + "1",
												   "\xD9\xA3",
												   std::string("1\0", 2)};
	return kNumbers;
}

const std::vector<std::string>& oddNames()
{
	static const std::vector<std::string> kNames{"a\nb",
												 "a\r\nnook: all is well",
												 "\x1B[2J\x1B]0;title\x07",
												 "\"a\" 'b'",
												 "<script>alert(1)</script>",
												 "</script><img src=x onerror=alert(1)>",
												 "*/ #error taken",
												 "$(touch taken)",
												 "`touch taken`",
												 "; touch taken #",
												 "| touch taken",
												 "a b\\",
												 "%s%n%d",
												 "\xFF\xFE\xC0\x80",
												 "\xE2\x80\xAE"
												 "abc",
												 "${taken} $taken $$",
												 "a:b|c",
												 std::string(4000, 'a')};
	return kNames;
}

} // namespace nook::hostile
