// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/script_text.h"

#include "core/error.h"
#include "core/number.h"

#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>

namespace nook
{
namespace
{

using Structs = std::map<std::string, std::vector<ScriptField>>;

struct Rule
{
	const char* cpp;
	const char* script;
};

// In this order, on the code of a line.
constexpr std::array kRules{
	Rule{R"(= static_cast<\w+>\((.*)\);$)", "= $1;"},
	Rule{R"(std::ldexp\(1\.0, (\w+)\))", "2 ** $1"},
	Rule{R"(std::fabs\()", "Math.abs("},
	Rule{R"(std::sqrt\()", "Math.sqrt("},
	Rule{R"(std::fmin\()", "Math.min("},
	Rule{R"(std::fmax\()", "Math.max("},
	Rule{R"(std::isfinite\()", "Number.isFinite("},
	Rule{R"(const double (\w+)\[\d+\] = \{(.*)\};)", "const $1 = [$2];"},
	Rule{R"(^(\t+)double (\w+)\[\d+\];)", "$1const $2 = [];"},
	Rule{R"(const (double|bool|char\* const|nook_\w+) )", "const "},
	Rule{R"(\bnullptr\b)", "null"},
	Rule{R"(float\* const )", "const "},
	Rule{R"(for \(int )", "for (let "},
	Rule{R"( == )", " === "},
	Rule{R"( != )", " !== "},
};

// The decimal of a hexadecimal float, "0x1.8p-22".
std::string decimalOf(const std::smatch& hex)
{
	const std::string digits = hex[2];
	const auto mantissa = static_cast<double>(std::stoul(std::string(hex[1]) + digits, nullptr, 16));
	return numberText(std::ldexp(mantissa, std::stoi(hex[3]) - 4 * static_cast<int>(digits.size())));
}

std::string withoutHex(std::string code)
{
	static const std::regex form(R"(0x([0-9a-f]+)\.?([0-9a-f]*)p([-+]?\d+))");
	for (std::smatch match; std::regex_search(code, match, form);)
	{
		code = std::string(match.prefix()) + decimalOf(match) + std::string(match.suffix());
	}
	return code;
}

std::string literalOf(const std::vector<ScriptField>& fields)
{
	std::string text;
	for (const ScriptField& field : fields)
	{
		text += (text.empty() ? "" : ", ") + field.name + ": " + field.value;
	}
	return "{ " + text + " }";
}

// A member of a struct: "double far_end = 0.0; // 0 or 1".
ScriptField fieldOf(const std::string& line)
{
	static const std::regex form(R"(^\t([\w:]+) (\w+)(?:\[(\d+)\])?(?: = ([^;]+))?;(?:\s*// (.*))?$)");
	std::smatch match;
	if (!std::regex_match(line, match, form))
	{
		throw Error(ExitCode::runtime, "nook_block.h: found '" + line + "', expected a member with a default");
	}
	std::string value = withoutHex(match[4].matched ? std::string(match[4]) : "0");
	if (match[3].matched)
	{
		value = "0";
		for (int i = 1; i < std::stoi(match[3]); ++i)
		{
			value += ", 0";
		}
		value = "[" + value + "]";
	}
	return {match[1], match[2], value, match[5]};
}

// "template <class number> inline bool nook_fill(nook_block& block, const number (&projection)[16])" → the same without types.
std::string headOf(const std::string& line)
{
	static const std::regex head(R"((\w+)\((.*)\)$)");
	static const std::regex name(R"((\w+)\)?(?:\[\d+\])?(?:, |$))");
	std::smatch match;
	if (!std::regex_search(line, match, head))
	{
		throw Error(ExitCode::runtime, "nook_block.h: found '" + line + "', expected the head of a function");
	}
	const std::string parameters = match[2];
	std::string names;
	for (std::sregex_iterator it(parameters.begin(), parameters.end(), name), end; it != end; ++it)
	{
		names += (names.empty() ? "" : ", ") + std::string((*it)[1]);
	}
	return "function " + std::string(match[1]) + "(" + names + ")";
}

std::string statementOf(const std::string& line, const Structs& structs)
{
	const std::size_t comment = std::min(line.find("//"), line.size());
	std::string code = line.substr(0, comment);
	static const std::regex object(R"(^(\t+)(nook_\w+) (\w+);)");
	std::smatch match;
	if (std::regex_search(code, match, object) && structs.contains(match[2]))
	{
		code = std::string(match[1]) + "const " + std::string(match[3]) + " = " + literalOf(structs.at(match[2])) + ";" +
			   std::string(match.suffix());
	}
	for (const Rule& rule : kRules)
	{
		code = std::regex_replace(code, std::regex(rule.cpp), rule.script);
	}
	code = withoutHex(code);
	static const std::regex strange(
		R"(std::|static_cast|->|\b(double|float|bool|int|auto|struct)\b|[&*] *(const|\w+ =[^=])|\bp[-+]\d)");
	if (std::regex_search(code, strange))
	{
		throw Error(ExitCode::runtime, "nook_block.h: found '" + line + "', expected a statement that JavaScript can say");
	}
	return code + line.substr(comment);
}

// Braces behind what they belong to, and the parts of a text as one.
std::string joined(const std::string& text)
{
	const std::string whole = std::regex_replace(text, std::regex(R"("\n\s*")"), "");
	const std::string behind = std::regex_replace(whole, std::regex(R"(\n\t*\{\n)"), " {\n");
	return std::regex_replace(behind, std::regex(R"(\}\n\t*else)"), "} else");
}

std::vector<ScriptField> fieldsOf(std::istringstream& rest)
{
	std::vector<ScriptField> fields;
	std::string line;
	std::string comment;      // lines before a member
	std::getline(rest, line); // the brace
	while (std::getline(rest, line) && line != "};")
	{
		if (line.starts_with("\t// "))
		{
			comment += (comment.empty() ? "" : " ") + line.substr(4);
			continue;
		}
		fields.push_back(fieldOf(line));
		fields.back().meaning = comment.empty() ? fields.back().meaning : comment;
		comment.clear();
	}
	return fields;
}

} // namespace

ScriptText scriptOf(std::string_view header)
{
	std::istringstream rest{std::string(header)};
	Structs structs;
	std::string functions;
	std::string comment;
	static const std::regex of_struct(R"(^struct (?:alignas\(\d+\) )?(\w+)$)");
	for (std::string line; std::getline(rest, line);)
	{
		std::smatch match;
		if (std::regex_match(line, match, of_struct))
		{
			structs[match[1]] = fieldsOf(rest);
			comment.clear();
		}
		else if (line.starts_with("//"))
		{
			comment += line + "\n";
		}
		else if (line.starts_with("template ") && line.ends_with('>'))
		{
			continue; // the function follows
		}
		else if (line.starts_with("inline ") || line.starts_with("[[nodiscard]] inline "))
		{
			functions += "\n" + comment + headOf(line) + "\n";
			while (line != "}" && std::getline(rest, line))
			{
				functions += statementOf(line, structs) + "\n";
			}
			comment.clear();
		}
		else
		{
			comment.clear();
		}
	}
	return {joined(functions), structs.at("nook_settings")};
}

} // namespace nook
