// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_json.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/text.h"
#include "format/arrays.h"
#include "format/source_text.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

constexpr double kHalfLengthError = 1e-4;

struct Row
{
	std::size_t line = 0; // starting at 1
	std::vector<std::string> cells;
};

struct Sheet
{
	std::string path;
	std::vector<std::string> header; // empty: none
	std::vector<Row> rows;
	std::optional<Domain> domain; // from a comment
};

[[noreturn]] void fail(const std::string& path, std::size_t line, const std::string& found, const std::string& expected)
{
	throw Error(ExitCode::invalid_input, path + ": row " + std::to_string(line) + ": found " + found + ", expected " + expected);
}

std::string_view trimmed(std::string_view text)
{
	const std::string_view blank = " \t\r";
	const std::size_t first = text.find_first_not_of(blank);
	return first == std::string_view::npos ? std::string_view{} : text.substr(first, text.find_last_not_of(blank) - first + 1);
}

std::string inQuotes(std::string_view text)
{
	return text.size() <= 48 ? jsonText(text) : jsonText(text.substr(0, 45)) + "...";
}

std::vector<std::string> cellsOf(std::string_view line)
{
	std::vector<std::string> cells;
	for (;;)
	{
		const std::size_t comma = line.find(',');
		cells.emplace_back(trimmed(line.substr(0, comma)));
		if (comma == std::string_view::npos)
		{
			return cells;
		}
		line.remove_prefix(comma + 1);
	}
}

// "nan" and "inf" parse as numbers here, so that they are rejected as values instead of being taken for a header.
std::optional<double> numberIn(std::string_view cell)
{
	double value = 0.0;
	const std::string_view digits = cell.starts_with('+') ? cell.substr(1) : cell;
	const std::from_chars_result end = readDecimal(digits.data(), digits.data() + digits.size(), value);
	const bool whole = !digits.empty() && end.ptr == digits.data() + digits.size();
	if (whole && end.ec == std::errc::result_out_of_range)
	{
		return std::nan("");
	}
	return whole && end.ec == std::errc{} ? std::optional(value) : std::nullopt;
}

void readComment(Sheet& sheet, std::string_view comment, std::size_t line)
{
	comment = trimmed(comment.substr(1));
	if (!comment.starts_with("domain:"))
	{
		return;
	}
	const std::string_view name = trimmed(comment.substr(7));
	sheet.domain = valueNamed<Domain>(name);
	if (!sheet.domain.has_value() || sheet.domain == Domain::slice)
	{
		fail(sheet.path, line, "the domain " + inQuotes(name), "one of disk, ball, sphere, hemisphere");
	}
}

Sheet readSheet(std::string_view text, const std::string& path)
{
	Sheet sheet;
	sheet.path = path;
	if (text.starts_with("\xef\xbb\xbf")) // UTF-8 byte order mark, as spreadsheets write it
	{
		text.remove_prefix(3);
	}
	for (std::size_t line = 1; !text.empty(); ++line)
	{
		const std::size_t end = text.find('\n');
		const std::string_view content = trimmed(text.substr(0, end));
		text.remove_prefix(end == std::string_view::npos ? text.size() : end + 1);
		if (content.empty())
		{
			continue;
		}
		if (content.front() == '#')
		{
			readComment(sheet, content, line);
			continue;
		}
		std::vector<std::string> cells = cellsOf(content);
		const bool first = sheet.header.empty() && sheet.rows.empty();
		if (first && std::none_of(cells.begin(), cells.end(), [](const std::string& cell) { return numberIn(cell).has_value(); }))
		{
			sheet.header = std::move(cells);
			for (std::size_t i = 0; i < sheet.header.size(); ++i)
			{
				const std::string& name = sheet.header[i];
				const std::array<std::string_view, 5> known{"x", "y", "z", "half_length", "weight"};
				const auto before = sheet.header.begin() + static_cast<std::ptrdiff_t>(i);
				if (std::find(known.begin(), known.end(), name) == known.end() ||
					std::find(sheet.header.begin(), before, name) != before)
				{
					fail(path, line, "the column " + inQuotes(name), "a header of x, y, z, half_length, weight, each once");
				}
			}
			continue;
		}
		if (sheet.rows.size() == static_cast<std::size_t>(kMaxCount))
		{
			fail(path, line, "more samples", "at most " + std::to_string(kMaxCount));
		}
		sheet.rows.push_back({line, std::move(cells)});
	}
	if (sheet.rows.empty())
	{
		throw Error(ExitCode::invalid_input, path + ": found no samples, expected rows of x,y or x,y,z and perhaps weight");
	}
	return sheet;
}

// Column names of a sheet without a header, guessed from the first row.
std::vector<std::string> guessedHeader(const Sheet& sheet, std::optional<Domain> domain)
{
	const Row& row = sheet.rows.front();
	const bool disk = domain == Domain::disk;
	switch (row.cells.size())
	{
	case 2: return {"x", "y"};
	case 3: return disk ? std::vector<std::string>{"x", "y", "weight"} : std::vector<std::string>{"x", "y", "z"};
	case 4:
		if (!disk)
		{
			return {"x", "y", "z", "weight"};
		}
		[[fallthrough]];
	default: break;
	}
	fail(sheet.path, row.line, std::to_string(row.cells.size()) + " columns and no header",
		 disk ? "x,y or x,y,weight" : "x,y or x,y,z or x,y,z,weight");
}

std::optional<std::size_t> columnOf(const std::vector<std::string>& header, std::string_view name)
{
	const auto found = std::find(header.begin(), header.end(), name);
	return found == header.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - header.begin()));
}

std::vector<double> numbersOf(const Sheet& sheet, const Row& row, std::size_t columns)
{
	if (row.cells.size() != columns)
	{
		fail(sheet.path, row.line, std::to_string(row.cells.size()) + " columns", std::to_string(columns));
	}
	std::vector<double> numbers;
	for (const std::string& cell : row.cells)
	{
		const std::optional<double> number = numberIn(cell);
		if (!number.has_value() || !std::isfinite(*number))
		{
			fail(sheet.path, row.line, inQuotes(cell), "a finite number");
		}
		numbers.push_back(*number);
	}
	return numbers;
}

Domain domainOf(const Sheet& sheet, std::optional<Domain> asked, const std::vector<std::string>& header)
{
	if (asked.has_value() && sheet.domain.has_value() && *asked != *sheet.domain)
	{
		throw Error(ExitCode::invalid_input, sheet.path + ": domain: found " + jsonText(nameOf(*sheet.domain)) + ", expected " +
												 jsonText(nameOf(*asked)) + " as asked for");
	}
	const bool has_z = columnOf(header, "z").has_value();
	const std::optional<Domain> said = asked.has_value() ? asked : sheet.domain;
	const Domain domain = said.value_or(has_z ? Domain::ball : Domain::disk);
	const bool disk = domain == Domain::disk;
	if (!columnOf(header, "x").has_value() || !columnOf(header, "y").has_value() || has_z == disk ||
		(columnOf(header, "half_length").has_value() && !disk))
	{
		throw Error(ExitCode::invalid_input, sheet.path + ": columns: found " + joinedText(header, ",") + ", expected " +
												 (disk ? "x,y" : "x,y,z") + " and perhaps weight for the domain " +
												 std::string(nameOf(domain)));
	}
	return domain;
}

} // namespace

std::string patternCsv(const Pattern& pattern, const Quality& quality, const EmitContext& context)
{
	std::string text = commentBlock(notesOf(context, measuresOf(quality)), "# ");
	text += "# domain: " + std::string(nameOf(pattern.domain)) + "\n" + columnsOf(pattern.domain) + "\n";
	for (const Sample& sample : samplesOf(pattern))
	{
		text += rowText(sample) + "\n";
	}
	return text;
}

PatternFile parsePatternCsv(const std::string& text, const std::string& path, std::optional<Domain> domain)
{
	const Sheet sheet = readSheet(text, path);
	const std::vector<std::string> header =
		sheet.header.empty() ? guessedHeader(sheet, domain.has_value() ? domain : sheet.domain) : sheet.header;
	PatternFile file;
	Pattern& pattern = file.pattern;
	pattern.domain = domainOf(sheet, domain, header);
	const std::size_t x = columnOf(header, "x").value();
	const std::size_t y = columnOf(header, "y").value();
	const std::optional<std::size_t> z = columnOf(header, "z");
	const std::optional<std::size_t> weight = columnOf(header, "weight");
	const std::optional<std::size_t> half_length = columnOf(header, "half_length");
	for (const Row& row : sheet.rows)
	{
		const std::vector<double> numbers = numbersOf(sheet, row, header.size());
		const glm::dvec3 p{numbers[x], numbers[y], z.has_value() ? numbers[*z] : 0.0};
		pattern.points.push_back(checkedPoint(pattern.domain, p, path + ": row " + std::to_string(row.line)));
		if (half_length.has_value())
		{
			const double expected = std::sqrt(std::max(0.0, 1.0 - p.x * p.x - p.y * p.y));
			// Near the rim the square root amplifies rounding errors of x and y; compare the squares there.
			const double found = numbers[*half_length];
			if (!(std::fabs(found * found - expected * expected) <= kHalfLengthError))
			{
				fail(path, row.line, "half_length " + roundedText(found, 7), roundedText(expected, 7) + " = sqrt(1 - x^2 - y^2)");
			}
		}
		if (weight.has_value())
		{
			pattern.weights.push_back(numbers[*weight]);
		}
	}
	file.weights_given = weight.has_value();
	if (file.weights_given)
	{
		checkWeights(pattern.weights, path + ": weight column",
					 [&](std::size_t i) { return path + ": row " + std::to_string(sheet.rows[i].line); });
	}
	return file;
}

} // namespace nook
