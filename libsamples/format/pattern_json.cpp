// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/pattern_json.h"

#include "core/decimal.h"
#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/round.h"
#include "core/text.h"
#include "core/words.h"
#include "format/arrays.h"
#include "format/json_fields.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

std::string recipeJson(const Recipe& recipe)
{
	const auto flag = [](bool value)
	{
		return value ? "true" : "false";
	};
	const auto name = [](auto value)
	{
		return jsonText(nameOf(value));
	};
	return "{\n\t\t\"domain\": " + name(recipe.domain) + ",\n\t\t\"count\": " + std::to_string(recipe.count) +
		   ",\n\t\t\"centre\": " + flag(recipe.centre) + ",\n\t\t\"symmetric\": " + flag(recipe.symmetric) +
		   ",\n\t\t\"method\": " + name(recipe.method) + ",\n\t\t\"minimise\": " + name(recipe.minimise) +
		   ",\n\t\t\"weights\": " + name(recipe.weights) + ",\n\t\t\"voronoi\": \"exact\",\n\t\t\"order\": " + name(recipe.order) +
		   ",\n\t\t\"starts\": " + std::to_string(recipe.starts) + ",\n\t\t\"seed\": " + std::to_string(recipe.seed) +
		   ",\n\t\t\"exponent\": " + doubleText(recipe.exponent) + "\n\t}";
}

Recipe readRecipe(const JsonValue& object, const Pattern& pattern)
{
	object.allowOnly({"domain", "count", "centre", "symmetric", "method", "minimise", "weights", "voronoi", "order", "starts",
					  "seed", "exponent"});
	Recipe recipe;
	recipe.domain = enumOf<Domain>(object.at("domain"));
	recipe.count = static_cast<int>(object.at("count").integer(1, kMaxCount));
	recipe.centre = object.at("centre").boolean();
	recipe.symmetric = object.at("symmetric").boolean();
	recipe.method = enumOf<Method>(object.at("method"));
	recipe.minimise = enumOf<Minimise>(object.at("minimise"));
	recipe.weights = enumOf<WeightRule>(object.at("weights"));
	// Earlier versions also had cells of a grid.
	object.at("voronoi").require(object.at("voronoi").string() == "exact", "\"exact\"");
	recipe.order = enumOf<Order>(object.at("order"));
	recipe.starts = static_cast<int>(object.at("starts").integer(0, 100000));
	recipe.seed = static_cast<uint32_t>(object.at("seed").integer(0, UINT32_MAX));
	recipe.exponent = object.at("exponent").number();
	object.at("domain").require(recipe.domain == pattern.domain, jsonText(nameOf(pattern.domain)) + " as in the pattern");
	object.at("count").require(static_cast<std::size_t>(recipe.count) == pattern.count(),
							   std::to_string(pattern.count()) + " as in the pattern");
	try
	{
		checkRecipe(recipe);
	}
	catch (const Error& error)
	{
		object.fail(std::string("options that do not go together (") + error.what() + ")", "a recipe of nook pattern");
	}
	return recipe;
}

constexpr double kOutside = 1e-6;    // a few roundings of a 32-bit float near 1 (6e-8 each)
constexpr double kUnitLength = 1e-5; // directions printed with five digits
constexpr double kWeightSum = 1e-4;  // thousands of weights printed with seven digits

glm::dvec3 toFloats(const glm::dvec3& p)
{
	return {roundToFloat(p.x), roundToFloat(p.y), roundToFloat(p.z)};
}

constexpr std::size_t kWeightsPerLine = 8;

std::size_t dimensions(Domain domain)
{
	return domain == Domain::disk || domain == Domain::slice ? 2 : 3;
}

template <class Text> std::string listJson(std::span<const double> values, const std::string& indent, const Text& text_of)
{
	std::string text = "[";
	for (std::size_t i = 0; i < values.size(); ++i)
	{
		text += i % kWeightsPerLine == 0 ? "\n" + indent + "\t" : " ";
		text += text_of(values[i]) + (i + 1 < values.size() ? "," : "");
	}
	return text + "\n" + indent + "]";
}

glm::dvec3 readPoint(const JsonValue& point, Domain domain)
{
	const std::size_t size = dimensions(domain);
	const std::string expected = std::to_string(size) + " numbers";
	if (!point.value->is_array() || point.value->size() != size)
	{
		point.expected("an array of " + expected);
	}
	glm::dvec3 p{0.0};
	for (std::size_t axis = 0; axis < size; ++axis)
	{
		p[static_cast<glm::length_t>(axis)] = point.at(axis).number();
	}
	return checkedPoint(domain, p, *point.path + ": " + point.element);
}

std::vector<double> readNumbers(const JsonValue& list, std::size_t count)
{
	list.require(list.arraySize() == count, "an array of " + std::to_string(count) + ", one a point");
	return listOf(count, [&list](std::size_t i) { return list.at(i).number(); });
}

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

std::string rowText(const std::string& path, std::size_t line)
{
	return path + ": row " + std::to_string(line);
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
	refuseInputIf(!sheet.domain.has_value() || sheet.domain == Domain::slice, rowText(sheet.path, line),
				  "the domain " + inQuotes(name), "one of disk, ball, sphere, hemisphere");
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
				refuseInputIf(std::find(known.begin(), known.end(), name) == known.end() ||
								  std::find(sheet.header.begin(), before, name) != before,
							  rowText(path, line), "the column " + inQuotes(name),
							  "a header of x, y, z, half_length, weight, each once");
			}
			continue;
		}
		refuseInputIf(sheet.rows.size() == static_cast<std::size_t>(kMaxCount), rowText(path, line), "more samples",
					  "at most " + std::to_string(kMaxCount));
		sheet.rows.push_back({line, std::move(cells)});
	}
	refuseInputIf(sheet.rows.empty(), path, "no samples", "rows of x,y or x,y,z and perhaps weight");
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
	refuseInput(rowText(sheet.path, row.line), std::to_string(row.cells.size()) + " columns and no header",
				disk ? "x,y or x,y,weight" : "x,y or x,y,z or x,y,z,weight");
}

std::optional<std::size_t> columnOf(const std::vector<std::string>& header, std::string_view name)
{
	const auto found = std::find(header.begin(), header.end(), name);
	return found == header.end() ? std::nullopt : std::optional(static_cast<std::size_t>(found - header.begin()));
}

std::vector<double> numbersOf(const Sheet& sheet, const Row& row, std::size_t columns)
{
	refuseInputIf(row.cells.size() != columns, rowText(sheet.path, row.line), std::to_string(row.cells.size()) + " columns",
				  std::to_string(columns));
	std::vector<double> numbers;
	for (const std::string& cell : row.cells)
	{
		const std::optional<double> number = numberIn(cell);
		refuseInputIf(!number.has_value() || !std::isfinite(*number), rowText(sheet.path, row.line), inQuotes(cell),
					  "a finite number");
		numbers.push_back(*number);
	}
	return numbers;
}

Domain domainOf(const Sheet& sheet, std::optional<Domain> asked, const std::vector<std::string>& header)
{
	if (asked.has_value() && sheet.domain.has_value() && *asked != *sheet.domain)
	{
		refuseInput(sheet.path + ": domain", jsonText(nameOf(*sheet.domain)), jsonText(nameOf(*asked)) + " as asked for");
	}
	const bool has_z = columnOf(header, "z").has_value();
	const std::optional<Domain> said = asked.has_value() ? asked : sheet.domain;
	const Domain domain = said.value_or(has_z ? Domain::ball : Domain::disk);
	const bool disk = domain == Domain::disk;
	refuseInputIf(!columnOf(header, "x").has_value() || !columnOf(header, "y").has_value() || has_z == disk ||
					  (columnOf(header, "half_length").has_value() && !disk),
				  sheet.path + ": columns", joinedText(header, ","),
				  (disk ? "x,y" : "x,y,z") + (" and perhaps weight for the domain " + std::string(nameOf(domain))));
	return domain;
}

} // namespace

std::string patternJson(const Pattern& pattern, const Recipe* recipe, const Quality& quality, const EmitContext& context)
{
	std::string text = "{\n" + jsonHead(kPatternSchema, context) + "\t\"quality\": " + measuresJson(measuresOf(quality)) + ",\n";
	if (recipe != nullptr)
	{
		text += "\t\"recipe\": " + recipeJson(*recipe) + ",\n";
	}
	text += "\t\"domain\": " + jsonText(nameOf(pattern.domain)) + ",\n\t\"count\": " + std::to_string(pattern.count()) + ",\n";
	return text + samplesJson(pattern, "\t") + "\n}\n";
}

PatternFile parsePatternJson(const std::string& text, const std::string& path)
{
	const nlohmann::json document = parseJson(text, path);
	const JsonValue root{&document, &path, ""};
	root.requireObject();
	const bool ours = root.has("schema");
	if (ours)
	{
		requireSchema(root, kPatternSchema);
	}
	root.allowOnly({"schema", "SPDX-License-Identifier", "command", "version", "comment", "quality", "recipe", "domain", "count",
					"points", "weights", "powers"});
	PatternFile file;
	const Domain domain = enumOf<Domain>(root.at("domain"));
	root.at("domain").require(domain != Domain::slice, "that of a pattern; slices come in tiles");
	if (ours || root.has("count"))
	{
		const auto count = static_cast<std::size_t>(root.at("count").integer(1, kMaxCount));
		root.at("points").require(root.at("points").arraySize() == count,
								  "an array of " + std::to_string(count) + ", as count says");
	}
	file.weights_given = ours || root.has("weights");
	file.pattern = readSamples(root, domain, file.weights_given);
	readHead(root, file.command, file.version);
	if (root.has("quality"))
	{
		file.quality = readMeasures<Quality>(root.at("quality"));
	}
	if (root.has("recipe"))
	{
		file.recipe = readRecipe(root.at("recipe"), file.pattern);
	}
	return file;
}

PatternFile readPattern(const std::string& path, std::optional<Domain> domain)
{
	const std::string text = readFile(path);
	if (path.ends_with(".csv"))
	{
		return parsePatternCsv(text, path, domain);
	}
	PatternFile file = parsePatternJson(text, path);
	if (domain.has_value() && file.pattern.domain != *domain)
	{
		refuseInput(path + ": domain", jsonText(nameOf(file.pattern.domain)), jsonText(nameOf(*domain)) + " as asked for");
	}
	return file;
}

glm::dvec3 checkedPoint(Domain domain, const glm::dvec3& point, const std::string& where)
{
	if (domain == Domain::slice)
	{
		const glm::dvec3 rounded = toFloats(point);
		if (!(rounded.x >= 0.0 && rounded.x < 1.0 && rounded.y >= 0.0 && rounded.y < 1.0))
		{
			refuseInput(where, roundedText(point.x, 7) + ", " + roundedText(point.y, 7),
						"an azimuth and a jitter from 0 to below 1");
		}
		return rounded;
	}
	const double length = glm::length(point);
	if (isDirectional(domain))
	{
		if (!(std::fabs(length - 1.0) <= kUnitLength))
		{
			refuseInput(where, "a direction of length " + roundedText(length, 7), "length 1 (within 1e-5)");
		}
		if (domain == Domain::hemisphere && point.z < -1e-6)
		{
			refuseInput(where, "z = " + roundedText(point.z, 7), "a direction of the upper hemisphere, z >= 0");
		}
		return toFloats(point);
	}
	if (!(length <= 1.0 + kOutside))
	{
		refuseInput(where, "a point at distance " + roundedText(length, 7) + " from the centre",
					domain == Domain::disk ? "a point in the unit disk" : "a point in the unit ball");
	}
	glm::dvec3 inside = toFloats(point);
	for (double shrink = 1.0; glm::dot(inside, inside) > 1.0;)
	{
		shrink -= 0x1p-24;
		inside = toFloats(point * (shrink / length));
	}
	return inside;
}

void checkWeights(std::vector<double>& weights, const std::string& where, const SampleName& name_of)
{
	double sum = 0.0;
	for (std::size_t i = 0; i < weights.size(); ++i)
	{
		if (!(weights[i] >= 0.0))
		{
			refuseInput(name_of(i), "the weight " + roundedText(weights[i], 7), "a weight of 0 or more");
		}
		sum += weights[i];
		weights[i] = roundToFloat(weights[i]);
	}
	refuseInputIf(!(std::fabs(sum - 1.0) <= kWeightSum), where, "the sum " + roundedText(sum, 7), "the sum 1 (within 1e-4)");
}

std::string jsonHead(const char* schema, const EmitContext& context)
{
	return "\t\"schema\": " + jsonText(schema) + ",\n\t\"command\": " + jsonText(context.command) +
		   ",\n\t\"version\": " + jsonText(context.version) + ",\n\t\"SPDX-License-Identifier\": \"MIT\",\n";
}

std::string samplesJson(const Pattern& pattern, const std::string& indent)
{
	std::string text = indent + "\"points\": [";
	for (std::size_t i = 0; i < pattern.count(); ++i)
	{
		const glm::dvec3& p = pattern.points[i];
		text += (i == 0 ? "\n" : ",\n") + indent + "\t[" + floatText(p.x) + ", " + floatText(p.y);
		text += dimensions(pattern.domain) == 3 ? ", " + floatText(p.z) + "]" : "]";
	}
	text += "\n" + indent + "],\n" + indent + "\"weights\": ";
	text += listJson(pattern.weights, indent, [](double value) { return floatText(value); });
	if (!pattern.powers.empty())
	{
		text += ",\n" + indent + "\"powers\": " + listJson(pattern.powers, indent, doubleText);
	}
	return text;
}

void requireSchema(const JsonValue& root, const char* schema)
{
	root.requireObject();
	root.at("schema").require(root.at("schema").string() == schema, jsonText(schema));
}

void readHead(const JsonValue& root, std::string& command, std::string& version)
{
	command = root.text("command");
	version = root.text("version");
	root.text("comment");
	root.text("SPDX-License-Identifier");
}

Pattern readSamples(const JsonValue& object, Domain domain, bool weights_given)
{
	Pattern pattern;
	pattern.domain = domain;
	const JsonValue points = object.at("points");
	const std::size_t count = points.arraySize();
	points.require(!(count < 1 || count > static_cast<std::size_t>(kMaxCount)),
				   "an array of 1 to " + std::to_string(kMaxCount) + " points");
	pattern.points = listOf(count, [&](std::size_t i) { return readPoint(points.at(i), domain); });
	if (weights_given)
	{
		const JsonValue weights = object.at("weights");
		pattern.weights = readNumbers(weights, count);
		const std::string where = *object.path + ": " + weights.element;
		checkWeights(pattern.weights, where, [&](std::size_t i) { return where + "[" + std::to_string(i) + "]"; });
	}
	if (object.has("powers"))
	{
		pattern.powers = readNumbers(object.at("powers"), count);
	}
	return pattern;
}

std::string patternCsv(const Pattern& pattern, const Quality& quality, const EmitContext& context)
{
	std::string text = commentBlock(notesOf(context, measuresOf(quality)), "# ");
	text += "# domain: " + std::string(nameOf(pattern.domain)) + "\n" + columnsOf(pattern.domain) + "\n";
	text += joinedText(samplesOf(pattern), "", [](const Sample& sample) { return rowText(sample) + "\n"; });
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
				refuseInput(rowText(path, row.line), "half_length " + roundedText(found, 7),
							roundedText(expected, 7) + " = sqrt(1 - x^2 - y^2)");
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
