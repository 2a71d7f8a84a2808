// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit/catalogue.h"

#include "core/lists.h"
#include "core/work_units.h"
#include "format/pattern_json.h"
#include "format/tile_json.h"

#include <algorithm>
#include <filesystem>

namespace nook
{
namespace
{

constexpr int kFirstTile = 4;
constexpr int kLastTile = 16;

std::vector<Variant> variantsOf(Domain domain)
{
	switch (domain)
	{
	case Domain::disk: return {Variant::free, Variant::centred, Variant::symmetric};
	case Domain::ball: return {Variant::free, Variant::symmetric};
	case Domain::sphere:
	case Domain::hemisphere:
	case Domain::slice: break;
	}
	return {Variant::free};
}

CatalogueEntry entryOf(Domain domain, Variant variant, int count)
{
	CatalogueEntry entry;
	entry.recipe.domain = domain;
	entry.recipe.count = count;
	entry.recipe.centre = variant == Variant::centred;
	entry.recipe.symmetric = variant == Variant::symmetric;
	const std::string name(nameOf(domain));
	const std::string number = std::to_string(count);
	const std::string stem = name + "/" + name + "_" + std::string(3 - std::min<std::size_t>(3, number.size()), '0') + number;
	entry.path = stem + (variant == Variant::free ? "" : "_" + std::string(nameOf(variant))) + ".json";
	return entry;
}

// Cost in seconds: proportional to the pairs of samples; cells in the ball cost ten times those of a disk.
double costOf(const CatalogueEntry& entry)
{
	const double count = entry.recipe.count;
	const double each = entry.recipe.domain == Domain::ball ? 10.0 : 1.0;
	return each * (count + count * count / 8.0) + (entry.tile_path.empty() ? 0.0 : 40.0 * count);
}

std::vector<CatalogueFile> makeEntry(const CatalogueEntry& entry, const std::string& version)
{
	const Pattern pattern = generatePattern(entry.recipe);
	const EmitContext context{patternCommand(entry.recipe), version, "", ""};
	std::vector<CatalogueFile> files;
	files.push_back({entry.path, patternJson(pattern, &entry.recipe, measurePattern(pattern), context)});
	if (!entry.tile_path.empty())
	{
		const PatternTile tile = generateTile(pattern, entry.tile);
		const std::string base = std::filesystem::path(entry.path).filename().string();
		const EmitContext tile_context{tileCommand(entry.tile, base), version, "", context.command};
		files.push_back({entry.tile_path, tileJson(tile, &entry.tile, measureTile(tile, pattern), tile_context)});
	}
	return files;
}

} // namespace

std::vector<CatalogueEntry> catalogueEntries(Domain domain, int first, int last, bool tiles)
{
	std::vector<CatalogueEntry> entries;
	const int least = domain == Domain::sphere ? 2 : 1;
	for (const Variant variant : variantsOf(domain))
	{
		for (int count = std::max(first, least); count <= std::min(last, kMaxCatalogueCount); ++count)
		{
			CatalogueEntry entry = entryOf(domain, variant, count);
			if (tiles && domain == Domain::disk && variant == Variant::free && count >= kFirstTile && count <= kLastTile)
			{
				entry.tile_path = entry.path.substr(0, entry.path.rfind('.')) + "_tile4.json";
			}
			entries.push_back(entry);
		}
	}
	return entries;
}

std::vector<CatalogueEntry> catalogueEntries()
{
	std::vector<CatalogueEntry> all;
	for (const Domain domain : {Domain::disk, Domain::ball, Domain::sphere, Domain::hemisphere})
	{
		append(all, catalogueEntries(domain, 1, kMaxCatalogueCount, true));
	}
	return all;
}

void visit(Archive& archive, CatalogueFile& file)
{
	archive(file.path, file.bytes);
}

std::vector<CatalogueFile> makeCatalogue(const std::vector<CatalogueEntry>& entries, const std::string& version,
										 const RunSettings& run)
{
	std::vector<std::vector<CatalogueFile>> made(entries.size());
	runStage({"catalogue", entries.size(), [&](std::size_t i) { return costOf(entries[i]); },
			  [&](std::size_t i) { made[i] = makeEntry(entries[i], version); },
			  [&](std::size_t i, Archive& archive)
			  {
				  archive(made[i]);
			  }},
			 run);
	if (isShare(run))
	{
		return {};
	}
	std::vector<CatalogueFile> files;
	for (std::vector<CatalogueFile>& of_entry : made)
	{
		std::move(of_entry.begin(), of_entry.end(), std::back_inserter(files));
	}
	return files;
}

} // namespace nook
