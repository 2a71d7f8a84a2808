// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/kernel_text.h"

#include "core/error.h"
#include "core/lists.h"
#include "methods/assets.h"

#include <algorithm>
#include <regex>

namespace nook
{

namespace
{

using Lines = std::vector<std::string>;

Lines linesOf(std::string_view text)
{
	Lines lines;
	while (!text.empty())
	{
		const std::size_t end = std::min(text.find('\n'), text.size());
		lines.emplace_back(text.substr(0, end));
		text.remove_prefix(std::min(end + 1, text.size()));
	}
	return lines;
}

bool isWordPart(char c)
{
	return c == '_' || (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// Calls `word(begin, end)` for each identifier outside comments.
template <class Word> void forWords(std::string_view text, const Word& word)
{
	std::size_t at = 0;
	while (at < text.size())
	{
		if (text.substr(at, 2) == "//")
		{
			at = std::min(text.find('\n', at), text.size());
			continue;
		}
		if (!isWordPart(text[at]))
		{
			at += 1;
			continue;
		}
		const std::size_t begin = at;
		while (at < text.size() && isWordPart(text[at]))
		{
			at += 1;
		}
		const bool number = text[begin] >= '0' && text[begin] <= '9';
		if (!number && (begin == 0 || text[begin - 1] != '.'))
		{
			word(begin, at);
		}
	}
}

// Replaces words, comments included.
std::string withConstants(const std::string& line, const std::map<std::string, std::string>& constants)
{
	std::string fresh;
	for (std::size_t at = 0; at < line.size();)
	{
		std::size_t end = at + 1;
		while (isWordPart(line[at]) && end < line.size() && isWordPart(line[end]))
		{
			end += 1;
		}
		const std::string word = line.substr(at, end - at);
		const auto found = constants.find(word);
		fresh += found != constants.end() ? found->second : word;
		at = end;
	}
	return fresh;
}

bool decided(const std::string& condition, const std::map<std::string, std::string>& constants)
{
	static const std::regex form(R"((!?)(\w+)(?: (==|!=|<|>|<=|>=) (\d+))?)");
	static const std::regex number(R"(-?\d+)");
	std::smatch match;
	const bool known = std::regex_match(condition, match, form) && constants.contains(match[2]);
	refuseIf(!known || !std::regex_match(constants.at(match[2]), number),
			 "kernels: found '#if " + condition + "', expected a constant that is known", ExitCode::runtime);
	const int left = std::stoi(constants.at(match[2]));
	const int right = match[4].matched ? std::stoi(match[4]) : 0;
	const std::string sign = match[3];
	const bool truth = sign == "=="   ? left == right
					   : sign == "<"  ? left < right
					   : sign == ">"  ? left > right
					   : sign == "<=" ? left <= right
					   : sign == ">=" ? left >= right
									  : left != right;
	return truth != (match[1] == "!");
}

// Number of braces that the line opens but does not close.
int depthOf(std::string_view line)
{
	const std::string_view code = line.substr(0, line.find("//"));
	return static_cast<int>(std::count(code.begin(), code.end(), '{') - std::count(code.begin(), code.end(), '}'));
}

std::string headParagraph(const Lines& lines)
{
	std::string text;
	for (const std::string& line : lines)
	{
		if (!line.starts_with("// "))
		{
			break;
		}
		text += line.find("SPDX") == std::string::npos ? line + "\n" : "";
	}
	return text;
}

// The name before the first parenthesis of a function's first line, or a macro's name.
std::string nameIn(const std::string& line)
{
	static const std::regex head(R"(^(?:#define|\w+) (\w+)[( ].*$)");
	std::smatch match;
	refuseIf(!std::regex_match(line, match, head), "kernels: found '" + line + "', expected a comment, a macro or a function",
			 ExitCode::runtime);
	return match[1];
}

// All identifiers outside comments, except members after a dot.
std::set<std::string> identifiersOf(std::string_view text)
{
	std::set<std::string> names;
	forWords(text, [&](std::size_t begin, std::size_t end) { names.emplace(text.substr(begin, end - begin)); });
	return names;
}

} // namespace

KernelText parseKernels(const std::vector<std::string_view>& files)
{
	KernelText kernels;
	for (const std::string_view file : files)
	{
		const Lines lines = linesOf(file);
		kernels.credits.push_back(headParagraph(lines));
		std::string comment;
		for (std::size_t i = 0; i < lines.size(); ++i)
		{
			if (lines[i].empty())
			{
				comment.clear();
				continue;
			}
			if (lines[i].starts_with("//"))
			{
				comment += lines[i] + "\n";
				continue;
			}
			KernelFunction function{nameIn(lines[i]), comment, lines[i] + "\n", kernels.credits.size() - 1};
			const bool macro = lines[i][0] == '#';
			int depth = depthOf(lines[i]);
			bool opened = lines[i].find('{') != std::string::npos;
			while (!macro && !(opened && depth == 0) && i + 1 < lines.size())
			{
				i += 1;
				function.text += lines[i] + "\n";
				depth += depthOf(lines[i]);
				opened = opened || lines[i].find('{') != std::string::npos;
			}
			kernels.functions.push_back(std::move(function));
			comment.clear();
		}
	}
	return kernels;
}

const KernelText& screenKernels()
{
	static const KernelText text = parseKernels({assets::screen_kernels.begin(), assets::screen_kernels.end()});
	return text;
}

std::string renamed(const std::string& text, const std::map<std::string, std::string>& names)
{
	std::string fresh;
	std::size_t done = 0;
	forWords(text,
			 [&](std::size_t begin, std::size_t end)
			 {
				 const auto found = names.find(text.substr(begin, end - begin));
				 if (found != names.end())
				 {
					 fresh += text.substr(done, begin - done) + found->second;
					 done = end;
				 }
			 });
	return fresh + text.substr(done);
}

std::string resolved(std::string_view text, const std::map<std::string, std::string>& constants)
{
	static const std::regex directive(R"(^\s*#(if|elif|else|endif)\s*(.*?)\s*$)");
	struct Block
	{
		bool outside; // state outside of it
		bool taken;   // one of its branches was taken
		bool now;
	};
	std::vector<Block> blocks{{true, true, true}};
	std::string fresh;
	for (const std::string& line : linesOf(text))
	{
		std::smatch match;
		if (!std::regex_match(line, match, directive))
		{
			fresh += blocks.back().now ? withConstants(line, constants) + "\n" : "";
			continue;
		}
		if (match[1] == "if")
		{
			blocks.push_back({blocks.back().now, false, false});
		}
		Block& block = blocks.back();
		if (match[1] == "endif")
		{
			blocks.pop_back();
			continue;
		}
		block.now = block.outside && !block.taken && (match[1] == "else" || decided(match[2], constants));
		block.taken = block.taken || block.now;
	}
	return fresh;
}

std::string FunctionWriter::add(const std::string& entry, const std::map<std::string, std::string>& constants)
{
	std::map<std::string, std::string> texts; // of the functions reached
	reach(entry, constants, texts);
	refuseIf(texts.empty(), std::string("kernels: found no ") + entry + ", expected one in methods/kernels/*.glsl",
			 ExitCode::runtime);
	std::map<std::string, std::string> names{{"nookSample", entry + "Sample"}, {"nookVariant", entry + "Variant"}};
	std::string result;
	for (const KernelFunction& function : m_kernels.functions)
	{
		const auto found = texts.find(function.name);
		if (found == texts.end())
		{
			continue;
		}
		std::string text = renamed(found->second, names);
		const auto [there, fresh] = m_written.emplace(function.name, text);
		if (!fresh && there->second == text)
		{
			continue;
		}
		if (!fresh) // another method uses it with other constants
		{
			names[function.name] = function.name + "Of" + entry.substr(4);
			text = renamed(text, names);
		}
		m_credits.insert(function.credit);
		result += "\n" + resolved(function.comment, constants) + text;
	}
	return result;
}

bool FunctionWriter::uses(std::string_view name) const
{
	return m_used.contains(std::string(name));
}

std::string FunctionWriter::credits() const
{
	return joinedText(m_credits, "", [this](std::size_t credit) { return "//\n" + m_kernels.credits[credit]; });
}

void FunctionWriter::reach(const std::string& name, const std::map<std::string, std::string>& constants,
						   std::map<std::string, std::string>& texts)
{
	m_used.insert(name);
	for (const KernelFunction& function : m_kernels.functions)
	{
		if (function.name == name && !texts.contains(name))
		{
			const std::string text = resolved(function.text, constants);
			texts[name] = text;
			for (const std::string& used : identifiersOf(text))
			{
				reach(used, constants, texts);
			}
		}
	}
}

} // namespace nook
