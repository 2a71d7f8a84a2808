// SPDX-License-Identifier: GPL-3.0-or-later
// The header's contents in JavaScript, C#, Python and JSON: functions are translated from the header's text.
#include "core/decimal.h"
#include "core/error.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "core/text.h"
#include "emit/module_parts.h"
#include "methods/assets.h"

#include <nlohmann/json.hpp>

#include <array>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>

namespace nook
{

namespace
{

// Translates the C++ that fills the uniform block (methods/runtime/nook_block.h) to languages that compute the same numbers.
//
// Supported: structs of numbers with defaults, one member per line, with its comment after it or on the lines before; inline
// functions of declarations, assignments, if, for and return; arrays; strings; static_cast around the whole right side; the
// functions of <cmath> that all languages round alike.

enum Tongue : std::size_t
{
	javascript,
	csharp,
	python,
};

struct Field
{
	std::string type; // C++ type: "double"
	std::string name;
	std::string value; // default value in JavaScript
	std::string meaning;
	int count = 0; // of an array, or 0
};
using Structs = std::map<std::string, std::vector<Field>>;

struct Translation
{
	std::string functions; // with their comments
	Structs structs;
};

// Patterns in the code of a line and what they become, applied in this order; "$&" stays as it is.
struct Rule
{
	const char* cpp;
	std::array<const char*, 3> becomes; // by Tongue
};
constexpr std::array kRules{
	Rule{R"(= static_cast<(\w+)>\((.*)\);$)", {"= $2;", "= ($1)($2);", "= $2;"}},
	Rule{R"(std::ldexp\(1\.0, (\w+)\))", {"2 ** $1", "Math.Pow(2.0, $1)", "2.0 ** $1"}},
	Rule{R"(std::fabs\()", {"Math.abs(", "Math.Abs(", "abs("}},
	Rule{R"(std::sqrt\()", {"Math.sqrt(", "Math.Sqrt(", "math.sqrt("}},
	Rule{R"(std::fmin\()", {"Math.min(", "Math.Min(", "min("}},
	Rule{R"(std::fmax\()", {"Math.max(", "Math.Max(", "max("}},
	Rule{R"(std::isfinite\()", {"Number.isFinite(", "IsFinite(", "math.isfinite("}},
	Rule{R"(const double (\w+)\[\d+\] = \{(.*)\};)", {"const $1 = [$2];", "double[] $1 = {$2};", "$1 = [$2];"}},
	Rule{R"(^(\t+)double (\w+)\[(\d+)\];)", {"$1const $2 = [];", "$1double[] $2 = new double[$3];", "$1$2 = [0.0] * $3;"}},
	Rule{R"(const (double|bool|nook_\w+) )", {"const ", "$1 ", ""}},
	Rule{R"(const char\* const )", {"const ", "string ", ""}},
	Rule{R"(\bnullptr\b)", {"null", "null", "None"}},
	Rule{R"(float\* const )", {"const ", "float[] ", ""}},
	Rule{R"(for \(int (\w+) = 0; \w+ < (\d+); \+\+\w+\))",
		 {"for (let $1 = 0; $1 < $2; ++$1)", "for (var $1 = 0; $1 < $2; ++$1)", "for $1 in range($2)"}},
	Rule{R"( == )", {" === ", "$&", "$&"}},
	Rule{R"( != )", {" !== ", "$&", "$&"}},
	Rule{R"( &&)", {"$&", "$&", " and"}},
	Rule{R"( \|\|)", {"$&", "$&", " or"}},
	Rule{R"(!(?=[\w(]))", {"$&", "$&", "not "}},
	Rule{R"(\btrue\b)", {"$&", "$&", "True"}},
	Rule{R"(\bfalse\b)", {"$&", "$&", "False"}},
	Rule{R"(;(?= *$))", {"$&", "$&", ""}},
};
constexpr std::array kHeadRules{
	Rule{R"(^(\[\[nodiscard\]\] )?inline )", {"", "static ", ""}},
	Rule{R"(const char\*)", {"", "string", ""}},
	Rule{R"(const (?:double|number) \(&(\w+)\)\[16\])", {"$1", "double[] $1", "$1"}},
	Rule{R"((?:const )?(nook_\w+)& )", {"", "$1 ", ""}},
	Rule{R"(\b(double|bool|int) (?=\w+(,|\))))", {"", "$&", ""}},
	Rule{R"(^.*?(\w+)\()", {"function $1(", "$&", "def $1("}},
};

std::string ruled(std::string code, std::span<const Rule> rules, Tongue tongue)
{
	for (const Rule& rule : rules)
	{
		code = std::regex_replace(code, std::regex(rule.cpp), rule.becomes[tongue]);
	}
	return code;
}

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

std::string pythonValue(const std::string& value)
{
	return value == "true" ? "True" : value == "false" ? "False" : value;
}

// An object of a struct with its defaults.
std::string objectOf(const std::string& type, const std::vector<Field>& fields, Tongue tongue)
{
	std::string text;
	for (const Field& field : fields)
	{
		text += (text.empty() ? "" : ", ") + field.name + (tongue == python ? "=" + pythonValue(field.value) : ": " + field.value);
	}
	return tongue == javascript ? "{ " + text + " }" : tongue == python ? "SimpleNamespace(" + text + ")" : "new " + type + "()";
}

// Parses a member of a struct: "double far_end = 0.0; // 0 or 1".
Field fieldOf(const std::string& line)
{
	static const std::regex form(R"(^\t(?:std::)?(\w+) (\w+)(?:\[(\d+)\])?(?: = ([^;]+))?;(?:\s*// (.*))?$)");
	std::smatch match;
	refuseIf(!std::regex_match(line, match, form), "nook_block.h: found '" + line + "', expected a member with a default",
			 ExitCode::runtime);
	const int count = match[3].matched ? std::stoi(match[3]) : 0;
	const std::vector<std::string> zeros(static_cast<std::size_t>(count), "0");
	const std::string value =
		count > 0 ? "[" + joinedText(zeros, ", ") + "]" : withoutHex(match[4].matched ? std::string(match[4]) : "0");
	return {match[1] == "int32_t" ? "int" : std::string(match[1]), match[2], value, match[5], count};
}

// C++'s "condition ? yes : no" as Python's "yes if condition else no".
std::string withPythonChoice(const std::string& code)
{
	const std::size_t at = code.find(" ? ");
	if (at == std::string::npos)
	{
		return code;
	}
	static const std::regex start(R"((?: = |return )$)");
	std::size_t begin = at;
	for (int open = 0; begin > 0 && !(open == 0 && (code[begin - 1] == '(' || std::regex_search(code.substr(0, begin), start)));
		 --begin)
	{
		open += code[begin - 1] == ')' ? 1 : code[begin - 1] == '(' ? -1 : 0;
	}
	const std::size_t colon = code.find(" : ", at);
	std::size_t end = colon;
	for (int open = 0; end < code.size() && !(open == 0 && code[end] == ')'); ++end)
	{
		open += code[end] == '(' ? 1 : code[end] == ')' ? -1 : 0;
	}
	return code.substr(0, begin) + code.substr(at + 3, colon - at - 3) + " if " + code.substr(begin, at - begin) + " else " +
		   code.substr(colon + 3, end - colon - 3) + code.substr(end);
}

std::string statementOf(const std::string& line, const Structs& structs, Tongue tongue)
{
	const std::size_t comment = std::min(line.find("//"), line.size());
	std::string code = line.substr(0, comment);
	static const std::regex object(R"(^(\t+)(nook_\w+) (\w+);)");
	std::smatch match;
	if (std::regex_search(code, match, object) && structs.contains(match[2]))
	{
		const std::string before = tongue == javascript ? "const " : tongue == csharp ? std::string(match[2]) + " " : "";
		code = std::string(match[1]) + before + std::string(match[3]) + " = " + objectOf(match[2], structs.at(match[2]), tongue) +
			   ";" + std::string(match.suffix());
	}
	code = withoutHex(ruled(code, kRules, tongue));
	code = tongue == python ? withPythonChoice(code) : code;
	static const std::regex strange(R"(std::|static_cast|->|\bauto\b|\bstruct\b|[&*] *(const|\w+ =[^=])|\bp[-+]\d)");
	static const std::regex typed(R"(\b(double|float|bool|int)\b)");
	refuseIf(std::regex_search(code, strange) || (tongue != csharp && std::regex_search(code, typed)),
			 "nook_block.h: found '" + line + "', expected a statement that other languages can express", ExitCode::runtime);
	return code + (tongue == python && comment < line.size() ? "#" + line.substr(comment + 2) : line.substr(comment));
}

// Moves braces behind their statement, or drops them, and joins the parts of a string.
std::string joined(const std::string& text, Tongue tongue)
{
	const std::string whole = std::regex_replace(text, std::regex(R"("\n\s*")"), "");
	const char* const open = tongue == javascript ? " {\n" : tongue == python ? ":\n" : "$&";
	const std::string behind = std::regex_replace(whole, std::regex(R"(\n\t*\{\n)"), open);
	return tongue == python ? std::regex_replace(behind, std::regex(R"(\n\t*\}(?=\n))"), "") : behind;
}

std::vector<Field> fieldsOf(std::istringstream& rest)
{
	std::vector<Field> fields;
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

// Throws Error (runtime) for an unsupported statement.
Translation translated(std::string_view header, Tongue tongue)
{
	std::istringstream rest{std::string(header)};
	Translation text;
	std::string comment;
	static const std::regex of_struct(R"(^struct (?:alignas\(\d+\) )?(\w+)$)");
	for (std::string line; std::getline(rest, line);)
	{
		std::smatch match;
		if (std::regex_match(line, match, of_struct))
		{
			text.structs[match[1]] = fieldsOf(rest);
			comment.clear();
		}
		else if (line.starts_with("//"))
		{
			comment += (tongue == python ? "#" + line.substr(2) : line) + "\n";
		}
		else if (line.starts_with("template ") && line.ends_with('>'))
		{
			continue; // the function follows
		}
		else if (line.starts_with("inline ") || line.starts_with("[[nodiscard]] inline "))
		{
			text.functions += "\n" + comment + ruled(line, kHeadRules, tongue) + "\n";
			while (line != "}" && std::getline(rest, line))
			{
				text.functions += statementOf(line, text.structs, tongue) + "\n";
			}
			comment.clear();
		}
		else
		{
			comment.clear();
		}
	}
	text.functions = joined(text.functions, tongue);
	return text;
}

// The settings: their types for editors, their defaults, and which are integers.
std::string defaultsText(const std::vector<Field>& settings)
{
	std::string types = "\n/**\n * Settings that are left out have their defaults.\n * @typedef {Object} Settings\n";
	std::string defaults = "\nconst defaults = {\n";
	std::string whole;
	for (const Field& one : settings)
	{
		types += " * @property {" + (one.type == "bool" ? "boolean" : std::string("number")) + "} [" + one.name + "=" + one.value +
				 "]" + (one.meaning.empty() ? "" : " " + one.meaning) + "\n";
		defaults += "\t" + one.name + ": " + one.value + ",\n";
		whole += one.type == "int" ? (whole.empty() ? "'" : ", '") + one.name + "'" : "";
	}
	return types + " */\n" + defaults + "};\nconst wholeNumbers = [" + whole + "];\n";
}

// The settings in a file that belongs to one module, and so can use that module's defaults.
const std::vector<Field>& settingsOf(Translation& text, const ModuleSettings& settings)
{
	for (Field& field : text.structs.at("nook_settings"))
	{
		const bool preset = (field.name == "device_depth" && settings.device_depth) ||
							(field.name == "zero_to_one" && settings.device_depth && hasUnitClip(settings));
		field.value = preset ? "true" : field.value;
	}
	return text.structs.at("nook_settings");
}

// A member of the block in the module's language.
struct PlacedMember
{
	std::string name;
	std::string type; // "vec2"
	std::size_t offset;
	std::string meaning;

	bool isInteger() const
	{
		return type[0] == 'i';
	}
	int count() const
	{
		return type == "float" ? 1 : type.back() - '0';
	}
};
struct PlacedBlock
{
	std::vector<PlacedMember> members;
	std::size_t bytes = 0;
};
PlacedBlock placedBlock(const ModuleSettings& settings)
{
	PlacedBlock block;
	std::size_t end = 0;
	for (const BlockMember& member : blockMembers())
	{
		const MemberPlace place = placeOf(member, end);
		block.members.push_back({member.name, typeOf(settings, member), place.offset, member.meaning});
		end = place.end;
	}
	block.bytes = (end + 15) / 16 * 16;
	return block;
}

std::string blockMembersText(const ModuleSettings& settings)
{
	std::string text =
		"\n/** Members of the block in the order in which the GLSL declares them; offsets in bytes. */\nexport const members = [\n";
	const PlacedBlock block = placedBlock(settings);
	const auto lineOf = [](const PlacedMember& member)
	{
		return "\t{ name: '" + member.name + "', type: '" + member.type + "', offset: " + std::to_string(member.offset) +
			   " }, // " + member.meaning + "\n";
	};
	return text + joinedText(block.members, "", lineOf) +
		   "];\n\n/** Bytes of the block. */\nexport const blockBytes = " + std::to_string(block.bytes) + ";\n";
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

// The values that a method's settings are preset to, one per line.
std::string presetLines(const ModuleSettings& settings, const ModuleMethod& method, const char* between)
{
	return joinedText(presetsOf(settings, method), "",
					  [&](const auto& preset) { return "\t\t\t" + preset.first + between + preset.second + ",\n"; });
}

std::string reachText(const ModuleSettings& settings, const ModuleMethod& method)
{
	return "\t/**\n\t * " + settingsMeaning(method) +
		   "\n\t * @param {number} reach\n\t * @returns {Settings}\n\t */\n\tsettings(reach) {\n\t\treturn {\n" +
		   presetLines(settings, method, ": ") + "\t\t};\n\t},\n";
}

// The texels of a tile, one per line.
std::string texelLines(const ModuleMethod& method, const std::string& tabs, const std::string& suffix = "")
{
	std::string text;
	for (const Sample& texel : texelsOf(method))
	{
		text += tabs;
		for (std::size_t i = 0; i < 4; ++i)
		{
			text += floatText(texel[i]) + suffix + (i < 3 ? ", " : ",\n");
		}
	}
	return text;
}

std::string texelsText(const ModuleMethod& method)
{
	const std::string name = stemOf(rowOf(method.method)) + "_tile";
	return "\t/** Texels of the texture " + name +
		   ", row by row: RGBA, 32-bit floats, without filtering. */\n\ttile: {\n\t\tname: '" + name +
		   "',\n\t\twidth: " + std::to_string(method.variants.size()) +
		   ",\n\t\theight: " + std::to_string(method.variants.front().count()) + ",\n\t\ttexels: new Float32Array([\n" +
		   texelLines(method, "\t\t\t") + "\t\t]),\n\t},\n";
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

constexpr const char* kSharpFill = R"(
	static bool IsFinite(double value)
	{
		return !double.IsNaN(value) && !double.IsInfinity(value);
	}

	// The uniform block that nook_fill makes. `projection`: 16 numbers, column by column, from view space (right-handed, looking down -z)
	// to clip space; in Unity those of camera.projectionMatrix, or of GL.GetGPUProjectionMatrix where depth comes from the depth buffer.
	// Throws ArgumentException, whose message is nook_fill's reason.
	public static Block Fill(double[] projection, nook_settings settings)
	{
		var block = new nook_block();
		string reason = projection.Length == 16 ? nook_fill(block, projection, settings) : "projection: expected 16 numbers";
		if (reason != null)
		{
			throw new ArgumentException(reason);
		}
		return new Block
		{
)";

constexpr const char* kPythonFill = R"(

def _single(value):
	try:
		return struct.unpack("<f", struct.pack("<f", value))[0]
	except OverflowError:
		return math.copysign(math.inf, value)


def fill(projection, **settings):
	"""The bytes of the uniform block nook_block, the same that nook_fill of the C++ header makes. `projection`: 16 numbers, column by
	column, from view space (right-handed, looking down -z) to clip space. Settings are those of DEFAULTS. Raises ValueError with
	nook_fill's reason, and TypeError for a setting of another name or type."""
	projection = [float(value) for value in projection]
	if len(projection) != 16:
		raise TypeError(f"projection: found {len(projection)} numbers, expected 16")
	for name, value in settings.items():
		if name not in DEFAULTS:
			raise TypeError(f"settings.{name}: found {value!r}, expected one of {', '.join(DEFAULTS)}")
		wanted = type(DEFAULTS[name])
		if type(value) is not wanted and not (wanted is float and type(value) is int):
			raise TypeError(f"settings.{name}: found {value!r}, expected {wanted.__name__}")
	block = SimpleNamespace(**{name: [0] * int(kind[-1]) if "vec" in kind else 0 for name, kind, offset in MEMBERS})
	reason = nook_fill(block, projection, SimpleNamespace(**{**DEFAULTS, **settings}))
	if reason is not None:
		raise ValueError(reason)
	data = bytearray(BLOCK_BYTES)
	for name, kind, offset in MEMBERS:
		values = getattr(block, name)
		for value in values if isinstance(values, list) else [values]:
			struct.pack_into("<i" if kind[0] == "i" else "<f", data, offset, value if kind[0] == "i" else _single(value))
			offset += 4
	return bytes(data)
)";

} // namespace

std::string moduleScript(const ModuleSettings& settings, const EmitContext& context, std::string_view glsl)
{
	Translation script = translated(assets::nook_block_h, javascript);
	const std::vector<Field>& fields = settingsOf(script, settings);
	std::string text = commentBlock(notesOf(context, {}), "// ") +
					   "//\n// Fills the uniform block of a GLSL module that nook emitted, and holds its samples: ECMAScript 2022, "
					   "no dependencies.\n" +
					   defaultsText(fields) + blockMembersText(settings) + script.functions + kFill;
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

std::string moduleSharp(const ModuleSettings& settings, const EmitContext& context)
{
	Translation code = translated(assets::nook_block_h, csharp);
	settingsOf(code, settings);
	std::string text;
	for (const auto& [name, fields] : code.structs)
	{
		text += "\n\tpublic sealed class " + name + "\n\t{\n";
		for (const Field& field : fields)
		{
			const std::string array = "[" + std::to_string(field.count) + "]";
			text += "\t\tpublic " + field.type + (field.count > 0 ? "[] " : " ") + field.name + " = " +
					(field.count > 0 ? "new " + field.type + array : field.value) + ";" +
					(field.meaning.empty() ? "" : " // " + field.meaning) + "\n";
		}
		text += "\t}\n";
	}
	const PlacedBlock block = placedBlock(settings);
	std::string filled;
	text += "\n\t// The uniform block in std140 layout: for SetData of Unity's buffers, or for Marshal.StructureToPtr.\n"
			"\t[StructLayout(LayoutKind.Sequential, Size = " +
			std::to_string(block.bytes) + ")]\n\tpublic struct Block\n\t{\n";
	for (const PlacedMember& member : block.members)
	{
		std::string names;
		for (int i = 0; i < member.count(); ++i)
		{
			const bool one = member.count() == 1;
			const std::string name = member.name + (one ? "" : std::string("_") + "xyzw"[i]);
			names += (i == 0 ? "" : ", ") + name;
			filled += "\t\t\t" + name + " = block." + member.name + (one ? "" : "[" + std::to_string(i) + "]") + ",\n";
		}
		text += std::string("\t\tpublic ") + (member.isInteger() ? "int " : "float ") + names + "; // " + member.meaning + "\n";
	}
	text += "\t}\n" + std::regex_replace(code.functions, std::regex("\n(?=[^\n])"), "\n\t") + kSharpFill + filled + "\t\t};\n\t}\n";
	for (const ModuleMethod& method : settings.methods)
	{
		const std::string stem = stemOf(rowOf(method.method));
		text += "\n\t// " + settingsMeaning(method) + "\n\tpublic static nook_settings " + stem +
				"_settings(double reach)\n\t{\n\t\treturn new nook_settings\n\t\t{\n";
		text += presetLines(settings, method, " = ");
		text += "\t\t};\n\t}\n";
		if (fromTexture(settings, method))
		{
			text += "\n\t// Texels of the texture " + stem +
					"_tile, row by row: RGBA, 32-bit floats, without filtering.\n\tpublic const int " + stem +
					"_tile_width = " + std::to_string(method.variants.size()) + ";\n\tpublic const int " + stem +
					"_tile_height = " + std::to_string(method.variants.front().count()) + ";\n\tpublic static readonly float[] " +
					stem + "_tile =\n\t{\n" + texelLines(method, "\t\t", "f") + "\t};\n";
		}
	}
	const std::string& space = settings.header_namespace;
	const std::string whole = "public static class Nook\n{" + text.substr(text.find_first_not_of('\n') - 1) + "}\n";
	return commentBlock(notesOf(context, {}), "// ") +
		   "//\n// Fills the uniform block of a module that nook emitted, and holds its samples: C# 7.3 and later, no "
		   "dependencies.\n"
		   "using System;\nusing System.Runtime.InteropServices;\n\n" +
		   (space.empty() ? whole : "namespace " + space + "\n{\n" + whole + "}\n");
}

std::string modulePython(const ModuleSettings& settings, const EmitContext& context)
{
	Translation code = translated(assets::nook_block_h, python);
	std::string text = "import math\nimport struct\nfrom types import SimpleNamespace\n\nDEFAULTS = {\n";
	for (const Field& field : settingsOf(code, settings))
	{
		text += "\t\"" + field.name + "\": " + pythonValue(field.value) + "," +
				(field.meaning.empty() ? "" : " # " + field.meaning) + "\n";
	}
	const PlacedBlock block = placedBlock(settings);
	text += "}\n\nBLOCK_BYTES = " + std::to_string(block.bytes) + "\nMEMBERS = [ # of the block: name, type, offset in bytes\n";
	for (const PlacedMember& member : block.members)
	{
		text += "\t(\"" + member.name + "\", \"" + member.type + "\", " + std::to_string(member.offset) + "), # " + member.meaning +
				"\n";
	}
	text += "]\n\n" + code.functions + kPythonFill;
	for (const ModuleMethod& method : settings.methods)
	{
		const std::string stem = stemOf(rowOf(method.method)).substr(5);
		text += "\n\n# " + settingsMeaning(method) + "\ndef " + stem + "_settings(reach):\n\treturn {\n";
		for (const auto& [name, value] : presetsOf(settings, method))
		{
			text += "\t\t\"" + name + "\": " + pythonValue(value) + ",\n";
		}
		text += "\t}\n";
		if (fromTexture(settings, method))
		{
			text += "\n\n# Texels of the texture nook_" + stem + "_tile, row by row: RGBA, 32-bit floats, without filtering.\n" +
					stem + "_tile_size = (" + std::to_string(method.variants.size()) + ", " +
					std::to_string(method.variants.front().count()) + ")\n" + stem + "_tile = [\n" + texelLines(method, "\t") +
					"]\n";
		}
	}
	return commentBlock(notesOf(context, {}), "# ") +
		   "#\n# Fills the uniform block of a module that nook emitted, and holds its samples: Python 3.6 and later, no "
		   "dependencies.\n" +
		   text;
}

std::string moduleJson(const ModuleSettings& settings, const EmitContext& context)
{
	using Json = nlohmann::ordered_json;
	const PlacedBlock block = placedBlock(settings);
	Json members =
		mapped(block.members,
			   [](const PlacedMember& member) -> Json {
				   return {{"name", member.name}, {"type", member.type}, {"offset", member.offset}, {"meaning", member.meaning}};
			   });
	Json methods = Json::array();
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		Json presets = Json::object();
		for (const auto& [name, value] : presetsOf(settings, method)) // "0.76 * reach", "1.5", "true"
		{
			const bool length = value.ends_with("reach");
			const Json number = value == "reach" ? Json(1.0) : Json::parse(value.substr(0, value.find(' ')));
			presets[name] = length ? Json{{"times_reach", number}} : number;
		}
		methods.push_back({{"name", row.name}, {"call", entryOf(settings, method)}, {"settings", std::move(presets)}});
		if (fromTexture(settings, method))
		{
			Json texels = Json::array();
			for (const Sample& texel : texelsOf(method))
			{
				for (const float value : texel)
				{
					texels.push_back(Json::parse(floatText(value)));
				}
			}
			methods.back()["tile"] = {{"texture", stemOf(row) + "_tile"},
									  {"width", method.variants.size()},
									  {"height", method.variants.front().count()},
									  {"texels", std::move(texels)}};
		}
	}
	const Json json{{"schema", "nook.module/1"},
					{"version", context.version},
					{"command", context.command},
					{"block", {{"name", "nook_block"}, {"bytes", block.bytes}, {"members", std::move(members)}}},
					{"methods", std::move(methods)}};
	return jsonLine(json) + "\n";
}

} // namespace nook
