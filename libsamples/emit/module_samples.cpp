// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/module.h"

#include "core/error.h"
#include "core/lists.h"
#include "format/input.h"
#include "pattern/cells.h"

#include <variant>

namespace nook
{
namespace
{

// The first `count` samples. Throws Error (invalid_input) where there are fewer, or where they were not made for it.
void shorten(PatternFile& file, std::size_t count, const std::string& path)
{
	Pattern& pattern = file.pattern;
	if (count > pattern.count())
	{
		throw Error(ExitCode::invalid_input, path + ": --counts: found " + std::to_string(pattern.count()) + " samples, expected " +
												 std::to_string(count) + " or more");
	}
	if (count == pattern.count())
	{
		return;
	}
	if (!file.recipe || file.recipe->order != Order::progressive)
	{
		throw Error(ExitCode::invalid_input,
					path + ": recipe: found a pattern whose first samples are none, expected one made with --order progressive");
	}
	pattern.points.resize(count);
	pattern.powers.clear();
	pattern.weights = exactCells(pattern.domain, pattern.points, {}).integrals;
}

// The first `count` samples of each variant of a tile. Their weights stay what they were made for, but for their sum.
void shorten(const TileFile& file, std::size_t count, const std::string& path, std::vector<Pattern>& variants)
{
	if (count > variants.front().count())
	{
		throw Error(ExitCode::invalid_input, path + ": --counts: found " + std::to_string(variants.front().count()) +
												 " samples, expected " + std::to_string(count) + " or more");
	}
	if (count < variants.front().count() && !(file.recipe && file.recipe->progressive))
	{
		throw Error(ExitCode::invalid_input, path + ": --counts: found a tile of " + std::to_string(variants.front().count()) +
												 " samples, expected all of them, or one made with --progressive");
	}
	for (Pattern& variant : variants)
	{
		if (count == variant.count())
		{
			return;
		}
		variant.points.resize(count);
		variant.weights.resize(count);
		const double sum = sumOver(variant.weights);
		if (!(sum > 0.0))
		{
			throw Error(ExitCode::invalid_input, path + ": --counts: found a variant whose first " + std::to_string(count) +
													 " samples have no weight, expected some");
		}
		for (double& w : variant.weights)
		{
			w /= sum;
		}
	}
}

// Variants in a window: those of the tile, or of the method's own samples.
std::size_t windowOf(const ModuleSettings& settings, const ModuleMethod& method)
{
	if (!method.variants.empty())
	{
		return method.variants.size() / static_cast<std::size_t>(layersOf(method));
	}
	ShadeSettings shade = method.shade.value_or(settings.shade);
	shade.method = method.method;
	const auto side = static_cast<std::size_t>(ownSamples(shade).size);
	return side * side;
}

} // namespace

std::string readSamples(const std::string& path, std::optional<std::size_t> count, const ShadeSettings& shade, ModuleMethod& method)
{
	std::variant<PatternFile, TileFile> input = readInput(path);
	if (shade.bands.count > 1)
	{
		checkProgressive(input, path);
	}
	const Domain expected = domainOf(method.method);
	const auto checkDomain = [&](Domain found)
	{
		if (found != expected)
		{
			throw Error(ExitCode::invalid_input, path + ": domain: found " + std::string(nameOf(found)) + ", expected " +
													 std::string(nameOf(expected)) + " for " + std::string(nameOf(method.method)));
		}
	};
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		checkDomain(file->pattern.domain);
		completeWeights(*file);
		shorten(*file, count.value_or(file->pattern.count()), path);
		method.variants = {file->pattern};
		return file->command;
	}
	const TileFile& file = std::get<TileFile>(input);
	checkDomain(file.tile.domain);
	method.variants = file.tile.variants;
	method.frames = file.tile.frames;
	method.moves = file.tile.moves;
	if (count)
	{
		shorten(file, *count, path, method.variants);
	}
	return file.command;
}

void checkWindows(const ModuleSettings& settings)
{
	if (settings.shade.filter != ShadeFilter::window)
	{
		return;
	}
	for (const ModuleMethod& method : settings.methods)
	{
		const std::size_t variants = windowOf(settings, method);
		if (variants < 2 || variants != windowOf(settings, settings.methods.front()))
		{
			throw Error(ExitCode::invalid_input, "--filter window: " + std::string(nameOf(method.method)) + ": found " +
													 std::to_string(method.variants.size()) +
													 " variants, expected tiles of one size for all methods");
		}
	}
}

} // namespace nook
