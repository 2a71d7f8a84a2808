// SPDX-License-Identifier: GPL-3.0-or-later
// The header's contents as a JavaScript module: its functions are translated from the header's text.
#include "core/decimal.h"
#include "core/error.h"
#include "core/text.h"
#include "emit/module_parts.h"
#include "methods/assets.h"

#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>

namespace nook
{

namespace
{

std::string scriptTypeOf(const ScriptField& field)
{
	return field.type == "bool" ? "boolean" : "number";
}

// The settings: their types for editors, their defaults, and which are integers.
std::string defaultsText(const std::vector<ScriptField>& settings)
{
	std::string types = "\n/**\n * Settings that are left out have their defaults.\n * @typedef {Object} Settings\n";
	std::string defaults = "\nconst defaults = {\n";
	std::string whole;
	for (const ScriptField& one : settings)
	{
		types += " * @property {" + scriptTypeOf(one) + "} [" + one.name + "=" + one.value + "]" +
				 (one.meaning.empty() ? "" : " " + one.meaning) + "\n";
		defaults += "\t" + one.name + ": " + one.value + ",\n";
		whole += one.type == "int" ? (whole.empty() ? "'" : ", '") + one.name + "'" : "";
	}
	return types + " */\n" + defaults + "};\nconst wholeNumbers = [" + whole + "];\n";
}

std::string blockMembersText(const ModuleSettings& settings)
{
	std::string text =
		"\n/** Members of the block in the order in which the GLSL declares them; offsets in bytes. */\nexport const members = [\n";
	std::size_t end = 0;
	for (const BlockMember& member : blockMembers())
	{
		const MemberPlace place = placeOf(member, end);
		text += "\t{ name: '" + std::string(member.name) + "', type: '" + typeOf(settings, member) +
				"', offset: " + std::to_string(place.offset) + " }, // " + member.meaning + "\n";
		end = place.end;
	}
	return text + "];\n\n/** Bytes of the block. */\nexport const blockBytes = " + std::to_string((end + 15) / 16 * 16) + ";\n";
}

constexpr const char* kFill = R"(
// All settings, with defaults for missing ones. Throws for an unknown name or a wrong type.
function completed(settings) {
	for (const [name, value] of Object.entries(settings)) {
		const expected = !Object.hasOwn(defaults, name) ? `one of ${Object.keys(defaults).join(', ')}`
			: typeof value !== typeof defaults[name] ? `a ${typeof defaults[name]}`
			: wholeNumbers.includes(name) && (value | 0) !== value ? 'a whole number' : '';
		if (expected) throw new TypeError(`settings.${name}: found ${String(value)}, expected ${expected}`);
	}
	return { ...defaults, ...settings };
}

/**
 * The bytes of the uniform block nook_block, the same that nook_fill of the C++ header makes. `projection`: 16 numbers, column by column,
 * from view space (right-handed, looking down -z) to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered.
 * Throws RangeError, whose message is the reason, for a projection that looks row-major or left-handed, has a skew or numbers that are
 * not finite, or with device depth a z that depends on x or y, and for a setting out of range. Throws TypeError for a projection that is
 * not 16 numbers, and for a setting of another name or type.
 * @param {ArrayLike<number>} projection
 * @param {Settings} settings
 * @returns {ArrayBuffer}
 */
export function fill(projection, settings) {
	if (projection.length !== 16 || !Array.from(projection).every(value => typeof value === 'number')) {
		throw new TypeError(`projection: found ${String(projection)}, expected 16 numbers`);
	}
	const bytes = new ArrayBuffer(blockBytes);
	const block = Object.fromEntries(members.map(({ name, type }) => [name, type === 'float' ? 0 : []]));
	const reason = nook_fill(block, projection, completed(settings));
	if (reason) {
		throw new RangeError(reason);
	}
	for (const { name, type, offset } of members) {
		const numbers = [block[name]].flat();
		(type.startsWith('i') ? new Int32Array(bytes, offset, numbers.length) : new Float32Array(bytes, offset, numbers.length)).set(numbers);
	}
	return bytes;
}
)";

// "nookVoLine" → "voLine".
std::string exportedName(const MethodRow& row)
{
	std::string name = std::string(entryOf(row)).substr(4);
	name[0] = static_cast<char>(name[0] - 'A' + 'a');
	return name;
}

std::string reachText(const ModuleSettings& settings, const ModuleMethod& method)
{
	std::string text = "\t/**\n\t * " + settingsMeaning(method) +
					   "\n\t * @param {number} reach\n\t * @returns {Settings}\n\t */\n\tsettings(reach) {\n\t\treturn {\n";
	for (const auto& [name, value] : presetsOf(settings, method))
	{
		text += "\t\t\t" + name + ": " + value + ",\n";
	}
	return text + "\t\t};\n\t},\n";
}

std::string texelsText(const ModuleMethod& method)
{
	const std::string name = stemOf(rowOf(method.method)) + "_tile";
	std::string text = "\t/** Texels of the texture " + name +
					   ", row by row: RGBA, 32-bit floats, without filtering. */\n\ttile: {\n\t\tname: '" + name +
					   "',\n\t\twidth: " + std::to_string(method.variants.size()) +
					   ",\n\t\theight: " + std::to_string(method.variants.front().count()) + ",\n\t\ttexels: new Float32Array([\n";
	for (const Sample& texel : texelsOf(method))
	{
		text += "\t\t\t" + floatText(texel[0]) + ", " + floatText(texel[1]) + ", " + floatText(texel[2]) + ", " +
				floatText(texel[3]) + ",\n";
	}
	return text + "\t\t]),\n\t},\n";
}

// A template literal.
std::string templateOf(std::string_view text)
{
	std::string literal = "`";
	for (const char c : text)
	{
		literal += c == '`' || c == '\\' || c == '$' ? "\\" : "";
		literal += c;
	}
	return literal + "`";
}

// Removes U+2028 and U+2029, which end a line only in JavaScript and may occur in file names.
std::string withoutLineEnds(std::string text)
{
	for (const char* const end : {"\xE2\x80\xA8", "\xE2\x80\xA9"})
	{
		for (std::size_t at = text.find(end); at != std::string::npos; at = text.find(end))
		{
			text.replace(at, 3, " ");
		}
	}
	return text;
}

} // namespace

std::string moduleScript(const ModuleSettings& settings, const EmitContext& context, std::string_view glsl)
{
	ScriptText script = scriptOf(assets::nook_block_h);
	for (ScriptField& field : script.settings) // a script belongs to one module, so it can use that module's defaults
	{
		const bool preset = (field.name == "device_depth" && settings.device_depth) ||
							(field.name == "zero_to_one" && settings.device_depth && hasUnitClip(settings));
		field.value = preset ? "true" : field.value;
	}
	std::string text = commentBlock(notesOf(context, {}), "// ") +
					   "//\n// Fills the uniform block of a GLSL module that nook emitted, and holds its samples: ECMAScript 2022, "
					   "no dependencies.\n" +
					   defaultsText(script.settings) + blockMembersText(settings) + script.functions + kFill;
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		const std::string parts = reachText(settings, method) + (fromTexture(settings, method) ? texelsText(method) : "");
		text += "\n/** " + std::string(row.what) + " */\nexport const " + exportedName(row) + " = {\n" + parts + "};\n";
	}
	const bool wgsl = settings.target == GlslTarget::wgsl;
	const std::string module =
		wgsl ? "\n/** The WGSL module: put the code that calls it behind it. */\nexport const wgsl = "
			 : "\n/** The GLSL module: put your #version before it, and the code that calls it behind it. */\nexport const glsl = ";
	text += glsl.empty() ? "" : module + templateOf(glsl) + ";\n";
	return withoutLineEnds(text);
}

namespace
{

using Structs = std::map<std::string, std::vector<ScriptField>>;

struct Rule
{
	const char* cpp;
	const char* script;
};

// Applied in this order to the code of a line.
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

// Decimal form of a hexadecimal float, "0x1.8p-22".
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

// Parses a member of a struct: "double far_end = 0.0; // 0 or 1".
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

// Removes types from "template <class number> inline bool nook_fill(nook_block& block, const number (&projection)[16])".
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
		throw Error(ExitCode::runtime, "nook_block.h: found '" + line + "', expected a statement that JavaScript can express");
	}
	return code + line.substr(comment);
}

// Moves braces behind their statement, and joins the parts of a string.
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
	std::string comment;      // from the lines before a member
	std::getline(rest, line); // skips the brace
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
