// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/input.h"

#include "core/error.h"
#include "core/file.h"
#include "core/json_reader.h"
#include "core/system.h"
#include "format/pattern_json.h"
#include "pattern/cells.h"

#include <filesystem>

namespace nook
{
namespace
{

bool isTile(const std::string& text, const std::string& path)
{
	const nlohmann::json root = parseJson(text, path);
	const auto schema = root.find("schema");
	return root.is_object() && schema != root.end() && *schema == kTileSchema;
}

} // namespace

std::variant<PatternFile, TileFile> readInput(const std::string& path, std::optional<Domain> domain)
{
	if (nativePath(path).extension() == ".csv" || !isTile(readFile(path), path))
	{
		return readPattern(path, domain);
	}
	TileFile file = readTile(path);
	if (domain && *domain != file.tile.domain)
	{
		throw Error(ExitCode::invalid_input, path + ": domain: found " + std::string(nameOf(file.tile.domain)) + ", expected " +
												 std::string(nameOf(*domain)));
	}
	return file;
}

void completeWeights(PatternFile& file)
{
	if (!file.weights_given)
	{
		file.pattern.weights = exactCells(file.pattern.domain, file.pattern.points, file.pattern.powers).integrals;
	}
}

void checkProgressive(const std::variant<PatternFile, TileFile>& input, const std::string& path)
{
	bool progressive = false;
	if (const PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		progressive = file->recipe && file->recipe->order == Order::progressive;
	}
	else
	{
		const TileFile& tile = std::get<TileFile>(input);
		progressive = (tile.recipe && tile.recipe->progressive) ||
					  (!tile.tile.transforms.empty() && tile.base_command.find("--order progressive") != std::string::npos);
	}
	if (!progressive)
	{
		throw Error(ExitCode::invalid_input, path +
												 ": found samples in any order, expected for bands a pattern in progressive order, "
												 "a tile that turns it, or a progressive tile");
	}
}

} // namespace nook
