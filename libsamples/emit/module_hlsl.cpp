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

using Matches = std::sregex_iterator;

// Adds vector types, which are their constructors, and the names declared with them.
void addVectors(const std::string& code, std::set<std::string>& vectors)
{
	static const std::regex declared(R"(\b([iu]?vec[234])\s+(\w+))");
	for (Matches it(code.begin(), code.end(), declared), end; it != end; ++it)
	{
		vectors.insert({(*it)[1], (*it)[2]});
	}
}

// GLSL's == and != of two vectors are one truth; HLSL's are one per component, and ?: would choose by each. `vectors`: names of
// vectors, and of functions that return them. An operand is a name, or a call without further calls.
std::string withWholeComparisons(const std::string& code, const std::set<std::string>& vectors)
{
	static const std::regex comparison(R"((\w+)(\([^()]*\))? (==|!=) (\w+)(\([^()]*\))?(?!\w*\.))");
	std::string text;
	std::size_t done = 0;
	for (Matches it(code.begin(), code.end(), comparison), end; it != end; ++it)
	{
		const std::smatch& match = *it;
		const auto at = static_cast<std::size_t>(match.position());
		const bool member = at > 0 && code[at - 1] == '.';
		if (!member && (vectors.contains(match[1]) || vectors.contains(match[4])))
		{
			text += code.substr(done, at - done) + (match[3] == "==" ? "all(" : "any(") + match.str() + ")";
			done = at + match.str().size();
		}
	}
	return text + code.substr(done);
}

} // namespace

std::string toHlsl(const std::string& module)
{
	static const std::regex head(R"(\n[iu]?vec[234] nook\w+\()");
	std::set<std::string> functions;
	for (Matches it(module.begin(), module.end(), head), end; it != end; ++it)
	{
		addVectors(it->str(), functions);
	}
	std::string text;
	for (std::size_t at = 0; at < module.size();) // function by function, since names are local to each
	{
		const std::size_t end = std::min(module.find("\n}\n", at), module.size() - 3) + 3;
		const std::string code = module.substr(at, end - at);
		std::set<std::string> vectors = functions;
		addVectors(code, vectors);
		text += withWholeComparisons(code, vectors);
		at = end;
	}
	text = renamed(text, {{"bitCount", "countbits"}, {"line", "one_line"}, {"point", "one_point"}}); // `line`, `point`: reserved
	for (const auto& [type, name] : {std::pair{"ivec", "int"}, std::pair{"uvec", "uint"}, std::pair{"vec", "float"}})
	{
		text = std::regex_replace(text, std::regex(std::string(R"(\b)") + type + R"(([234])\b)"), std::string(name) + "$1");
	}
	return text;
}

} // namespace nook
