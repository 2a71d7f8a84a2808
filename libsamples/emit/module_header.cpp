// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/lists.h"
#include "core/text.h"
#include "emit/module.h"
#include "emit/module_parts.h"
#include "methods/assets.h"

#include <sstream>

namespace nook
{

namespace
{

std::string tileText(const ModuleMethod& method)
{
	const std::string stem = stemOf(rowOf(method.method));
	const std::string width = std::to_string(method.variants.size());
	const std::string height = std::to_string(method.variants.front().count());
	std::string text = "\n// Texels of the texture " + stem + "_tile, row by row: RGBA, 32-bit floats, " + width + " x " + height +
					   ", without filtering.\ninline constexpr int " + stem + "_tile_width = " + width +
					   ";\ninline constexpr int " + stem + "_tile_height = " + height + ";\ninline constexpr float " + stem +
					   "_tile[" + std::to_string(method.variants.size() * method.variants.front().count()) + "][4] = {\n";
	for (const Sample& texel : texelsOf(method))
	{
		text += "\t{" + floatText(texel[0]) + "f, " + floatText(texel[1]) + "f, " + floatText(texel[2]) + "f, " +
				floatText(texel[3]) + "f},\n";
	}
	return text + "};\n";
}

// Macro that records which kind of depth a method's settings are preset for.
std::string settingsMacro(const ModuleMethod& method, const std::string& guard_end)
{
	return macroOf(rowOf(method.method)) + "_SETTINGS" + guard_end;
}
std::string depthNumber(const ModuleSettings& settings)
{
	return std::to_string(!settings.device_depth ? 0 : hasUnitClip(settings) ? 2 : 1);
}

// The function that presets the settings of a method.
std::string settingsText(const ModuleSettings& settings, const ModuleMethod& method, const std::string& guard_end)
{
	const std::string macro = settingsMacro(method, guard_end);
	std::string text = "\n#ifndef " + macro + " // the first of several headers with this method defines it\n#define " + macro +
					   " " + depthNumber(settings) + "\n// " + settingsMeaning(method) + "\ninline nook_settings " +
					   stemOf(rowOf(method.method)) + "_settings(double reach)\n{\n\tnook_settings settings;\n";
	for (const auto& [name, value] : presetsOf(settings, method))
	{
		text += "\tsettings." + name + " = " + value + ";\n";
	}
	return text + "\treturn settings;\n}\n#endif\n";
}

// Each float block gets its own name, so that every block in a program has its own nook_fill.
std::string floatBlockText(const ModuleSettings& settings)
{
	std::string members;
	std::string numbers;
	for (const BlockMember& member : blockMembers())
	{
		const std::string name = member.name;
		const std::string type = typeOf(settings, member);
		const std::string size = type == "float" ? "" : "[" + type.substr(3) + "]";
		members += "\tfloat " + name + size + "; // " + member.meaning + "\n";
		for (int i = 0; type != member.type && i < type.back() - '0'; ++i)
		{
			const std::string place = name + "[" + std::to_string(i) + "]";
			numbers += "\tblock." + place + " = static_cast<float>(whole." + place + ");\n";
		}
	}
	return "\n#ifndef NOOK_FLOAT_BLOCK_H\n#define NOOK_FLOAT_BLOCK_H\n\n#include <cstring>\n\n"
		   "// The uniform block of modules emitted with --block floats: nook_block with floats in place of the integers.\n"
		   "struct alignas(16) nook_float_block\n{\n" +
		   members +
		   "};\nstatic_assert(sizeof(nook_float_block) == sizeof(nook_block), \"std140\");\n\n"
		   "template <class number>\n"
		   "[[nodiscard]] inline const char* nook_fill(nook_float_block& block, const number (&projection)[16], "
		   "const nook_settings& settings)\n"
		   "{\n\tnook_block whole{};\n\tif (const char* const reason = nook_fill(whole, projection, settings))\n\t{\n"
		   "\t\treturn reason;\n\t}\n\tstd::memcpy(&block, &whole, sizeof block);\n" +
		   numbers + "\treturn nullptr;\n}\n\n#endif // NOOK_FLOAT_BLOCK_H\n";
}

bool isInteger(const BlockMember& member)
{
	return member.type[0] == 'i';
}

bool isWordPart(char c)
{
	return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z');
}

// Replaces a word in a line's code.
std::string exchanged(std::string line, const std::string& word, const std::string& with)
{
	for (std::size_t at = line.find(word); at != std::string::npos && at < line.find("//"); at = line.find(word, at))
	{
		const std::size_t end = at + word.size();
		const bool whole = end == line.size() || !isWordPart(line[end]);
		line.replace(at, word.size(), whole ? with : word);
		at += whole ? with.size() : word.size();
	}
	return line;
}

} // namespace

std::string moduleHeader(const ModuleSettings& settings, const EmitContext& context)
{
	const std::string& space = settings.header_namespace;
	const std::string guard_end = space.empty() ? "" : "_" + space;
	std::string tiles;
	std::string conflicts; // headers in one program that read depth differently: the compiler reports it
	for (const ModuleMethod& method : settings.methods)
	{
		const std::string macro = settingsMacro(method, guard_end);
		conflicts += "#if defined(" + macro + ") && " + macro + " != " + depthNumber(settings) +
					 "\n#error nook: another header with this method reads depth in another way, emit one of them with "
					 "--namespace\n#endif\n";
		tiles += settingsText(settings, method, guard_end);
		tiles += fromTexture(settings, method) ? tileText(method) : "";
	}
	if (!space.empty() && !tiles.empty())
	{
		tiles = "\nnamespace " + space + "\n{\n" + tiles + "\n} // namespace " + space + "\n";
	}
	const std::string guard = guardOf(settings) + "_H" + guard_end;
	const std::string_view block = assets::nook_block_h;
	return commentBlock(notesOf(context, {}), "// ") +
		   "//\n// Fills the uniform block of a GLSL module that nook emitted: C++17 and later, no dependencies. All modules of "
		   "one version of\n"
		   "// nook share nook_block" +
		   (settings.float_block ? ", or nook_float_block where they are emitted with --block floats" : "") +
		   ", nook_settings and nook_fill.\n" + conflicts + "#ifndef " + guard + "\n#define " + guard + "\n\n" +
		   std::string(block.substr(block.find("#ifndef"))) + (settings.float_block ? floatBlockText(settings) : "") + tiles +
		   "\n#endif // " + guard + "\n";
}

std::string typeOf(const ModuleSettings& settings, const BlockMember& member)
{
	return settings.float_block && isInteger(member) ? member.type + 1 : member.type;
}

std::string membersText(const ModuleSettings& settings)
{
	return joinedText(blockMembers(), "",
					  [&settings](const BlockMember& member)
					  { return "\t" + typeOf(settings, member) + " " + member.name + "; // " + member.meaning + "\n"; });
}

std::string withIntegers(const ModuleSettings& settings, const std::string& functions)
{
	if (!settings.float_block)
	{
		return functions;
	}
	std::string text;
	std::istringstream rest(functions);
	for (std::string line; std::getline(rest, line);)
	{
		for (const BlockMember& member : blockMembers())
		{
			const std::string read = std::string("nook.") + member.name;
			line = isInteger(member) ? exchanged(line, read, std::string(member.type) + "(" + read + ")") : line;
		}
		text += line + "\n";
	}
	return text;
}

} // namespace nook
