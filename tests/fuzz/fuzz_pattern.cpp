// SPDX-License-Identifier: GPL-3.0-or-later
// Pattern, tile and filter files: JSON parsed by readPattern, readTile and parseFilter; accepted files must be complete.
#include "fuzz.h"
#include "mutate_json.h"

#include "format/pattern_json.h"
#include "format/tile_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::fuzz::tryTo(
		[&]
		{
			const nook::PatternFile file = nook::parsePatternJson(text, "file");
			if (file.pattern.points.empty() || (file.weights_given && file.pattern.weights.size() != file.pattern.points.size()))
			{
				std::abort();
			}
		});
	nook::fuzz::tryTo(
		[&]
		{
			const nook::TileFile file = nook::parseTileJson(text, "file");
			const auto size_of_tile = static_cast<std::size_t>(file.tile.size);
			const auto tiles = static_cast<std::size_t>(file.tile.moves.empty() ? file.tile.frames : 1);
			if (file.tile.variants.size() != size_of_tile * size_of_tile * tiles ||
				(!file.tile.moves.empty() && file.tile.moves.size() != static_cast<std::size_t>(file.tile.frames)))
			{
				std::abort();
			}
		});
	nook::fuzz::tryTo(
		[&]
		{
			if (nook::parseFilter(text, "file").filter.taps.empty())
			{
				std::abort();
			}
		});
	return 0;
}

NOOK_MUTATED_BY(nook::fuzz::mutatedJsonText)
