// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/kernel_text.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <optional>
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

std::string joined(const Lines& lines)
{
	std::string text;
	for (const std::string& line : lines)
	{
		text += line + "\n";
	}
	return text;
}

std::size_t indentOf(const std::string& line)
{
	return std::min(line.find_first_not_of('\t'), line.size());
}

bool is(const std::string& line, std::string_view trimmed)
{
	return std::string_view(line).substr(indentOf(line)) == trimmed;
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

// "nook.samples" → "9" in code; comments keep the name.
std::string withConstants(std::string line, const std::map<std::string, std::string>& constants)
{
	if (line.find('.') == std::string::npos)
	{
		return line; // every name has one
	}
	for (const auto& [name, value] : constants)
	{
		for (std::size_t at = line.find(name); at != std::string::npos && at < line.find("//"); at = line.find(name, at + 1))
		{
			const std::size_t end = at + name.size();
			if (end == line.size() || !isWordPart(line[end]))
			{
				line.replace(at, name.size(), value);
			}
		}
	}
	return line;
}

std::string decided(const std::smatch& match)
{
	const int left = std::stoi(match[2]);
	const int right = std::stoi(match[4]);
	const std::string sign = match[3];
	const bool truth = sign == "=="   ? left == right
					   : sign == "!=" ? left != right
					   : sign == "<"  ? left < right
					   : sign == ">"  ? left > right
					   : sign == "<=" ? left <= right
									  : left >= right;
	return match[1].str() + (truth ? "true" : "false");
}

void replaceAll(std::string& text, const std::string& old, const std::string& fresh)
{
	for (std::size_t at = text.find(old); at != std::string::npos; at = text.find(old, at))
	{
		text.replace(at, old.size(), fresh);
	}
}

// The condition of an `if`, as far as it is decided.
std::string simplerCondition(std::string line)
{
	static const std::regex comparison(R"((\(|&& |\|\| )(-?\d+) (==|!=|<=|>=|<|>) (-?\d+)(?=\)| &&| \|\|))");
	std::smatch match;
	while (std::regex_search(line, match, comparison))
	{
		line = match.prefix().str() + decided(match) + match.suffix().str();
	}
	const bool all_and = line.find("||") == std::string::npos;
	const bool all_or = line.find("&&") == std::string::npos;
	const std::string before = line.substr(0, line.find("if (")) + "if (";
	if (all_and)
	{
		replaceAll(line, "true && ", "");
		replaceAll(line, " && true)", ")");
		if (line.find("(false &&") != std::string::npos || line.find("&& false)") != std::string::npos ||
			line.find("&& false &&") != std::string::npos)
		{
			line = before + "false)";
		}
	}
	if (all_or)
	{
		replaceAll(line, "false || ", "");
		replaceAll(line, " || false)", ")");
		if (line.find("(true ||") != std::string::npos || line.find("|| true)") != std::string::npos ||
			line.find("|| true ||") != std::string::npos)
		{
			line = before + "true)";
		}
	}
	return line;
}

// The line of the brace that ends the block which `open` begins.
std::size_t closing(const Lines& lines, std::size_t open)
{
	const std::size_t indent = indentOf(lines[open]);
	std::size_t at = open + 1;
	while (at < lines.size() && !(indentOf(lines[at]) == indent && is(lines[at], "}")))
	{
		at += 1;
	}
	return at;
}

void erase(Lines& lines, std::size_t first, std::size_t end)
{
	lines.erase(lines.begin() + static_cast<std::ptrdiff_t>(first), lines.begin() + static_cast<std::ptrdiff_t>(end));
}

bool isElse(const Lines& lines, std::size_t at)
{
	return at < lines.size() && (is(lines[at], "else") || lines[at].find("\telse if (") != std::string::npos);
}

// Takes out of its braces the block that begins at `head` (its `if` or `else`), and drops what a return in it makes unreachable.
void unwrap(Lines& lines, std::size_t head)
{
	std::size_t end = closing(lines, head + 1);
	erase(lines, end, end + 1);
	erase(lines, head, head + 2);
	end -= 2;
	const std::size_t inside = indentOf(lines[head]);
	bool leaves = false;
	for (std::size_t i = head; i < end; ++i)
	{
		leaves = leaves || (indentOf(lines[i]) == inside && lines[i].find("\treturn ") != std::string::npos);
		lines[i].erase(0, 1);
	}
	if (leaves)
	{
		std::size_t after = end;
		while (after < lines.size() && indentOf(lines[after]) + 1 >= inside)
		{
			after += 1;
		}
		erase(lines, end, after);
	}
}

// Resolves the first decided `if`; false where there is none.
bool resolveOne(Lines& lines)
{
	for (std::size_t i = 0; i + 1 < lines.size(); ++i)
	{
		const bool truth = is(lines[i], "if (true)");
		if (!truth && !is(lines[i], "if (false)"))
		{
			continue;
		}
		if (!truth)
		{
			erase(lines, i, closing(lines, i + 1) + 1);
			if (i < lines.size() && is(lines[i], "else"))
			{
				unwrap(lines, i);
			}
			else if (isElse(lines, i))
			{
				lines[i].replace(lines[i].find("else if"), 7, "if");
				lines[i] = simplerCondition(lines[i]);
			}
			return true;
		}
		const std::size_t after = closing(lines, i + 1) + 1;
		while (isElse(lines, after))
		{
			erase(lines, after, closing(lines, after + 1) + 1);
		}
		unwrap(lines, i);
		return true;
	}
	return false;
}

bool hasWord(std::string_view line, std::string_view name)
{
	bool found = false;
	forWords(line, [&](std::size_t begin, std::size_t end) { found = found || line.substr(begin, end - begin) == name; });
	return found;
}

// A whole line that is "name = …;", or += and so on.
bool isAssignment(std::string_view line, std::string_view name)
{
	const std::size_t tabs = line.find_first_not_of('\t');
	if (tabs == 0 || tabs == std::string_view::npos || line.back() != ';' || line.substr(tabs, name.size()) != name)
	{
		return false;
	}
	const std::string_view rest = line.substr(tabs + name.size());
	const bool changes = rest.size() > 2 && std::string_view("-+*/").find(rest[1]) != std::string_view::npos;
	return rest.substr(0, 1) == " " && rest.substr(changes ? 2 : 1, 2) == "= ";
}

// Removes one variable that is written at most, or one empty `if`; false where there is none.
bool pruneOne(Lines& lines)
{
	static const std::regex declaration(R"(^\t+(?:const )?(?:bool|int|float|[iu]?vec[234]|mat[234]) (\w+) = .*;$)");
	for (std::size_t i = 0; i < lines.size(); ++i)
	{
		if (lines[i].find("\tif (") != std::string::npos && i + 2 < lines.size() && is(lines[i + 1], "{") &&
			is(lines[i + 2], "}") && !isElse(lines, i + 3))
		{
			erase(lines, i, i + 3);
			return true;
		}
		std::smatch match;
		if (lines[i].find(" = ") == std::string::npos || !std::regex_match(lines[i], match, declaration))
		{
			continue;
		}
		const std::string name = match[1];
		const auto only_written = [&](const std::string& line)
		{
			return isAssignment(line, name);
		};
		const auto reads = [&](const std::string& line)
		{
			return &line != &lines[i] && !only_written(line) && hasWord(line, name);
		};
		if (std::none_of(lines.begin(), lines.end(), reads))
		{
			erase(lines, i, i + 1);
			lines.erase(std::remove_if(lines.begin(), lines.end(), only_written), lines.end());
			return true;
		}
	}
	return false;
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

// The name before the first parenthesis of a function's first line, or of a macro.
std::string nameIn(const std::string& line)
{
	static const std::regex head(R"(^(?:#define|\w+) (\w+)[( ].*$)");
	std::smatch match;
	if (!std::regex_match(line, match, head))
	{
		throw Error(ExitCode::runtime, "kernels: found '" + line + "', expected a comment, a macro or a function");
	}
	return match[1];
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
			if (lines[i][0] != '#')
			{
				while (lines[i] != "}" && i + 1 < lines.size())
				{
					i += 1;
					function.text += lines[i] + "\n";
				}
			}
			kernels.functions.push_back(std::move(function));
			comment.clear();
		}
	}
	return kernels;
}

std::set<std::string> identifiersOf(std::string_view text)
{
	std::set<std::string> names;
	forWords(text, [&](std::size_t begin, std::size_t end) { names.emplace(text.substr(begin, end - begin)); });
	return names;
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

std::string specialised(const std::string& text, const std::map<std::string, std::string>& constants)
{
	Lines lines = linesOf(text);
	for (std::string& line : lines)
	{
		line = withConstants(line, constants);
		if (line.find("if (") != std::string::npos)
		{
			line = simplerCondition(line);
		}
	}
	while (resolveOne(lines))
	{
	}
	while (pruneOne(lines))
	{
	}
	return joined(lines);
}

} // namespace nook
