// SPDX-License-Identifier: GPL-3.0-or-later
// The catalogue: which patterns and tiles it holds, and the files that they are.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"

#include <optional>
#include <string>
#include <vector>

namespace nook
{

inline constexpr int kMaxCatalogueCount = 64;

// One pattern, and perhaps a tile of it.
struct CatalogueEntry
{
	std::string path; // below the catalogue's folder: "disk/disk_009_symmetric.json"
	Recipe recipe;
	std::string tile_path; // "disk/disk_009_tile4.json", or empty
	TileRecipe tile;
};

// Counts first to last, 1 to kMaxCatalogueCount: disk free, centred and symmetric; ball free and symmetric; sphere (from 2) and
// hemisphere free. tiles: also the 4 × 4 tiles of free disk patterns with 4 to 16 lines.
std::vector<CatalogueEntry> catalogueEntries(Domain domain, int first, int last, bool tiles);

// Everything: all domains, all counts, tiles.
std::vector<CatalogueEntry> catalogueEntries();

struct CatalogueFile
{
	std::string path;
	std::string bytes;
};

// Makes the files of the entries, several at a time; in the order of the entries, a tile behind its pattern.
std::vector<CatalogueFile> makeCatalogue(const std::vector<CatalogueEntry>& entries, const std::string& version,
										 const RunSettings& run = {});

} // namespace nook
