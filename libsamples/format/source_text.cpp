// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/source_text.h"

#include "core/text.h"

namespace nook
{
namespace
{

std::string joined(const Sample& sample, const char* separator, const char* suffix)
{
	std::string text;
	for (const float value : sample)
	{
		text += text.empty() ? "" : separator;
		text += floatText(value) + suffix;
	}
	return text;
}

std::string constantsText(const Source& source)
{
	std::string text;
	for (const SourceConstant& constant : source.constants)
	{
		text += "#define " + constant.name + " " + std::to_string(constant.value) + " // " + constant.comment + "\n";
	}
	return text;
}

// Language syntax: each array is its comment, `open`, the rows wrapped in `before` and `after` and separated by commas, then
// `close`.
struct Shape
{
	std::string before;
	std::string after;
	const char* suffix; // suffix of a number
	std::string close;
};

template <class Opening> std::string arraysText(const Source& source, const Shape& shape, const Opening& opening)
{
	std::string text;
	for (const SourceArray& array : source.arrays)
	{
		text += "\n// " + array.comment + "\n" + opening(array) + "\n";
		for (std::size_t i = 0; i < array.rows.size(); ++i)
		{
			text += "\t" + shape.before + joined(array.rows[i], ", ", shape.suffix) + shape.after +
					(i + 1 < array.rows.size() ? ",\n" : "\n");
		}
		text += shape.close + "\n";
	}
	return text;
}

} // namespace

std::string headerText(const Source& source)
{
	const std::string guard = source.guard + "_H";
	const std::string unused = "#ifndef NOOK_MAYBE_UNUSED\n"
							   "#if defined(__GNUC__) || defined(__clang__)\n"
							   "#define NOOK_MAYBE_UNUSED __attribute__((unused))\n"
							   "#else\n"
							   "#define NOOK_MAYBE_UNUSED\n"
							   "#endif\n"
							   "#endif\n";
	return commentBlock(source.notes, "// ") + "#ifndef " + guard + "\n#define " + guard + "\n\n" + unused + "\n" +
		   constantsText(source) +
		   arraysText(source, {"{", "}", "f", "};"},
					  [](const SourceArray& array)
					  { return "NOOK_MAYBE_UNUSED static const float " + array.name + "[" + array.size_name + "][4] = {"; }) +
		   "\n#endif // " + guard + "\n";
}

std::string glslText(const Source& source)
{
	const std::string guard = source.guard + "_GLSL";
	return commentBlock(source.notes, "// ") +
		   "// Include it in a shader of GLSL 1.30, GLSL ES 3.00 or later; older versions have no constant arrays and get "
		   "none.\n#ifndef " +
		   guard + "\n#define " + guard + "\n#if __VERSION__ >= 130\n\n" + constantsText(source) +
		   arraysText(source, {"vec4(", ")", "", ");"},
					  [](const SourceArray& array)
					  {
						  const std::string size = "[" + array.size_name + "]";
						  return "const highp vec4 " + array.name + size + " = vec4" + size + "(";
					  }) +
		   "\n#endif\n#endif // " + guard + "\n";
}

std::string hlslText(const Source& source)
{
	const std::string guard = source.guard + "_HLSL";
	return commentBlock(source.notes, "// ") + "#ifndef " + guard + "\n#define " + guard + "\n\n" + constantsText(source) +
		   arraysText(source, {"float4(", ")", "", "};"},
					  [](const SourceArray& array)
					  { return "static const float4 " + array.name + "[" + array.size_name + "] = {"; }) +
		   "\n#endif // " + guard + "\n";
}

std::string rowText(const Sample& sample)
{
	return joined(sample, ",", "");
}

} // namespace nook
