// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/catalogue.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"
#include "pattern/quality.h"

#include <catch2/catch.hpp>

#include <filesystem>

using namespace nook;

namespace
{

const std::filesystem::path kPatterns = std::filesystem::path(NOOK_SOURCE_DIR) / "patterns";

void checkSame(double measured, double written)
{
	CHECK(measured == Approx(written).epsilon(1e-9).margin(1e-12));
}

} // namespace

TEST_CASE("catalogue: every entry is there, and measures again what it says of itself", "[catalogue]")
{
	int patterns = 0;
	int tiles = 0;
	for (const CatalogueEntry& entry : catalogueEntries())
	{
		INFO(entry.path);
		const PatternFile file = readPattern((kPatterns / entry.path).string());
		REQUIRE(file.quality.has_value());
		REQUIRE(file.recipe.has_value());
		CHECK(file.command == patternCommand(*file.recipe));
		const Quality again = measurePattern(file.pattern, {2, {}});
		checkSame(again.plane, file.quality->plane);
		checkSame(again.noise, file.quality->noise);
		checkSame(again.bias, file.quality->bias);
		checkSame(again.plane_exact, file.quality->plane_exact);
		checkSame(again.spread, file.quality->spread);
		checkSame(again.cliff.value_or(0.0), file.quality->cliff.value_or(0.0));
		checkSame(again.centre.value_or(0.0), file.quality->centre.value_or(0.0));
		checkSame(again.crease.value_or(0.0), file.quality->crease.value_or(0.0));
		checkSame(again.cap.value_or(0.0), file.quality->cap.value_or(0.0));
		if (file.recipe->symmetric && again.centre.has_value())
		{
			CHECK(*again.centre <= 1e-6);
		}
		patterns += 1;
		if (!entry.tile_path.empty())
		{
			const TileFile tile = readTile((kPatterns / entry.tile_path).string());
			const TileQuality tile_again = measureTile(tile.tile, file.pattern, {2, {}});
			REQUIRE(tile.quality.has_value());
			checkSame(tile_again.window.value(), tile.quality->window.value());
			checkSame(tile_again.variant_plane.value(), tile.quality->variant_plane.value());
			checkSame(tile_again.base_plane.value(), tile.quality->base_plane.value());
			CHECK(*tile_again.variant_plane <= 1.3 * *tile_again.base_plane);
			tiles += 1;
		}
	}
	CHECK(patterns == 3 * 64 + 2 * 64 + 63 + 64);
	CHECK(tiles == 13);
}
