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
	std::string types = "\n/**\n * What is left out has its default.\n * @typedef {Object} Settings\n";
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
		"\n/** Members of the block as GLSL declares them, in order; offsets in bytes. */\nexport const members = [\n";
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
// What nook_fill takes: every setting, each of its type.
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
 * The bytes of the uniform block nook_block, those that nook_fill of the C++ header makes. `projection`: 16 numbers, column by column,
 * from view space (right-handed, looking down -z) to clip space; perspective or orthographic, reversed, infinite, off-centre, jittered.
 * Null where x or y of the picture depends on the other (a skew), where a setting is out of range, or with device depth where z depends
 * on x or y. Throws TypeError for what is no setting, or no projection.
 * @param {ArrayLike<number>} projection
 * @param {Settings} settings
 * @returns {ArrayBuffer | null}
 */
export function fill(projection, settings) {
	if (projection.length !== 16 || !Array.from(projection).every(value => typeof value === 'number')) {
		throw new TypeError(`projection: found ${String(projection)}, expected 16 numbers`);
	}
	const bytes = new ArrayBuffer(blockBytes);
	const block = Object.fromEntries(members.map(({ name, type }) => [name, type === 'float' ? 0 : []]));
	if (!nook_fill(block, projection, completed(settings))) {
		return null;
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

std::string reachText(const MethodRow& row, const MethodRecipe& recipe)
{
	std::string text =
		"\t/**\n\t * Settings of " + std::string(entryOf(row)) +
		" for rays that reach so far, in the unit of your depths; the picture's size is still to be set.\n"
		"\t * @param {number} reach\n\t * @returns {Settings}\n\t */\n\tsettings(reach) {\n\t\treturn {\n\t\t\tradius: " +
		numberText(recipe.radius) + " * reach,\n";
	for (const RecipeValue& one : recipe.values)
	{
		if (one.feature->kind == FeatureKind::number && !one.feature->setting.empty())
		{
			text += "\t\t\t" + std::string(one.feature->setting) + ": " + numberText(one.value) +
					(isLength(*one.feature) ? " * reach,\n" : ",\n");
		}
	}
	return text + "\t\t};\n\t},\n";
}

std::string texelsText(const ModuleMethod& method)
{
	const std::string name = stemOf(rowOf(method.method)) + "_tile";
	std::string text = "\t/** Texels of the texture " + name + ": RGBA, 32-bit floats, for texelFetch. */\n\ttile: {\n\t\tname: '" +
					   name + "',\n\t\twidth: " + std::to_string(method.variants.size()) +
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
	const ScriptText script = scriptOf(assets::nook_block_h);
	std::string text =
		commentBlock(notesOf(context, {}), "// ") +
		"// A module of ECMAScript 2022 that needs nothing: the uniform block of the GLSL module, and what it reads.\n" +
		defaultsText(script.settings) + blockMembersText(settings) + script.functions + kFill;
	for (const ModuleMethod& method : settings.methods)
	{
		const MethodRow& row = rowOf(method.method);
		const std::string parts =
			(method.recipe ? reachText(row, *method.recipe) : "") + (fromTexture(settings, method) ? texelsText(method) : "");
		text += "\n/** " + std::string(row.what) + " */\nexport const " + exportedName(row) + " = {\n" + parts + "};\n";
	}
	text += glsl.empty() ? ""
						 : "\n/** The GLSL module: your #version goes before it, what calls it behind. */\nexport const glsl = " +
							   templateOf(glsl) + ";\n";
	return withoutLineEnds(text);
}

} // namespace nook
