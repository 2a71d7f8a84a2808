// SPDX-License-Identifier: GPL-3.0-or-later
// The header's contents as a JavaScript module: its functions are made of the header's own text.
#include "core/number.h"
#include "core/text.h"
#include "emit/module_parts.h"
#include "emit/script_text.h"
#include "methods/assets.h"

namespace nook
{
namespace
{

std::string scriptTypeOf(const ScriptField& field)
{
	return field.type == "bool" ? "boolean" : "number";
}

// The settings: their types for editors, their defaults, and which are whole numbers.
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
// All settings, with defaults for those that are left out. Throws where a name or a type is none of theirs.
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

// Without the two characters that end a line in JavaScript alone (U+2028, U+2029), which names of files may hold.
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
	for (ScriptField& field : script.settings) // a script is of one module, so its defaults can be that module's
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
	text +=
		glsl.empty()
			? ""
			: "\n/** The GLSL module: put your #version before it, and the code that calls it behind it. */\nexport const glsl = " +
				  templateOf(glsl) + ";\n";
	return withoutLineEnds(text);
}

} // namespace nook
