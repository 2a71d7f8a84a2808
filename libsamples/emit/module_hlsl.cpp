// SPDX-License-Identifier: GPL-3.0-or-later
// A module in the kernels' subset of GLSL as HLSL. Declarations of resources already are HLSL, but for the names of types.
#include "emit/module_parts.h"
#include "methods/kernel_text.h"

#include <regex>
#include <set>

namespace nook
{
namespace
{

bool isNamePart(char c)
{
	return c == '_' || c == '.' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Index of the parenthesis that matches the one at `at`, in the direction of `step`.
std::size_t matching(const std::string& text, std::size_t at, int step)
{
	int open = 0;
	do
	{
		open += text[at] == '(' ? step : text[at] == ')' ? -step : 0;
		at += open == 0 ? 0 : static_cast<std::size_t>(step);
	} while (open != 0 && at < text.size());
	return at;
}

// An operand of a comparison is a name or a call, with members after it.
std::size_t operandBegin(const std::string& text, std::size_t end)
{
	std::size_t at = end;
	while (at > 0 && (isNamePart(text[at - 1]) || text[at - 1] == ')'))
	{
		at = text[at - 1] == ')' ? matching(text, at - 1, -1) : at - 1;
	}
	return at;
}

std::size_t operandEnd(const std::string& text, std::size_t begin)
{
	std::size_t at = begin;
	while (at < text.size() && (isNamePart(text[at]) || text[at] == '('))
	{
		at = text[at] == '(' ? matching(text, at, 1) + 1 : at + 1;
	}
	return at;
}

bool isVector(const std::string& operand, const std::set<std::string>& vectors)
{
	static const std::regex component(R"(\.[xyzw]$)");
	return !std::regex_search(operand, component) && vectors.contains(operand.substr(0, operand.find('(')));
}

// GLSL's == and != of two vectors are one truth; HLSL's are one per component, and ?: would choose by each. `vectors`: names of
// vectors, and of functions that return them.
std::string withWholeComparisons(std::string code, const std::set<std::string>& vectors)
{
	for (const auto& [sign, function] : {std::pair{" == ", "all("}, std::pair{" != ", "any("}})
	{
		for (std::size_t at = code.find(sign); at != std::string::npos; at = code.find(sign, at + 1))
		{
			const std::size_t begin = operandBegin(code, at);
			const std::size_t end = operandEnd(code, at + 4);
			if (isVector(code.substr(begin, at - begin), vectors) || isVector(code.substr(at + 4, end - at - 4), vectors))
			{
				code.insert(end, ")");
				code.insert(begin, function);
				at += 4;
			}
		}
	}
	return code;
}

// Adds the names that follow a vector type.
void addVectors(const std::string& code, std::set<std::string>& vectors)
{
	static const std::regex declared(R"(\b([iu]?vec[234])\s+(\w+))");
	for (std::sregex_iterator it(code.begin(), code.end(), declared), end; it != end; ++it)
	{
		vectors.insert((*it)[1]); // its constructor
		vectors.insert((*it)[2]);
	}
}

} // namespace

std::string toHlsl(const std::string& module)
{
	static const std::regex head(R"(\n[iu]?vec[234] nook\w+\()");
	std::set<std::string> functions;
	for (std::sregex_iterator it(module.begin(), module.end(), head), end; it != end; ++it)
	{
		addVectors(it->str(), functions);
	}
	std::string text;
	for (std::size_t at = 0; at < module.size();) // function by function, since each has names of its own
	{
		const std::size_t end = std::min(module.find("\n}\n", at), module.size());
		const std::string code = module.substr(at, end - at);
		std::set<std::string> vectors = functions;
		addVectors(code, vectors);
		text += withWholeComparisons(code, vectors) + (end < module.size() ? "\n}\n" : "");
		at = std::min(end + 3, module.size());
	}
	text = renamed(text, {{"bitCount", "countbits"}, {"line", "one_line"}, {"point", "one_point"}}); // `line`, `point`: reserved
	for (const auto& [type, name] : {std::pair{"ivec", "int"}, std::pair{"uvec", "uint"}, std::pair{"vec", "float"}})
	{
		text = std::regex_replace(text, std::regex(std::string(R"(\b)") + type + R"(([234])\b)"), std::string(name) + "$1");
	}
	return text;
}

} // namespace nook
