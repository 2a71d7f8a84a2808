// SPDX-License-Identifier: GPL-3.0-or-later
// The contents of the catalogue: patterns, tiles and their files.
#pragma once

#include "core/progress.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"

#include <string>
#include <vector>

namespace nook
{

inline constexpr int kMaxCatalogueCount = 64;

// One pattern and optionally its tile.
struct CatalogueEntry
{
	std::string path; // relative to the catalogue's folder: "disk/disk_009_symmetric.json"
	Recipe recipe;
	std::string tile_path; // "disk/disk_009_tile4.json", or empty
	TileRecipe tile;
};

// Counts first to last, 1 to kMaxCatalogueCount: disk free, centred and symmetric; ball free and symmetric; sphere (from 2) and
// hemisphere free. tiles: also the 4 × 4 tiles of free disk patterns with 4 to 16 lines.
std::vector<CatalogueEntry> catalogueEntries(Domain domain, int first, int last, bool tiles);

// All domains, all counts, and tiles.
std::vector<CatalogueEntry> catalogueEntries();

struct CatalogueFile
{
	std::string path;
	std::string bytes;
};

// Makes the files of the entries, several in parallel. Results are in the order of the entries, each tile after its pattern.
std::vector<CatalogueFile> makeCatalogue(const std::vector<CatalogueEntry>& entries, const std::string& version,
										 const RunSettings& run = {});

} // namespace nook
