// SPDX-License-Identifier: GPL-3.0-or-later
// nook catalogue: every pattern of the catalogue, made or compared.
#include "options.h"
#include "summary.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "core/temporary_file.h"
#include "emit/catalogue.h"
#include "version.h"

#include <filesystem>

namespace nook
{
namespace
{

struct CatalogueOptions
{
	Domain domain = Domain::disk;
	CountRange counts{1, kMaxCatalogueCount};
	bool tiles = false;
	bool check = false;
	std::string folder;
	std::string json;
	std::string progress;
	std::optional<PartNumber> part;
	int threads = 0;
	CLI::Option* domain_given = nullptr;
	CLI::Option* counts_given = nullptr;
};

std::vector<CatalogueEntry> entriesOf(const CatalogueOptions& options)
{
	if (options.domain_given->count() == 0)
	{
		if (options.counts_given->count() > 0 || options.tiles)
		{
			throw Error(ExitCode::usage,
						"--counts, --tiles: without --domain the whole catalogue is made, expected --domain as well");
		}
		return catalogueEntries();
	}
	if (options.tiles && options.domain != Domain::disk)
	{
		throw Error(ExitCode::usage, "--tiles: found " + std::string(nameOf(options.domain)) + ", expected --domain disk");
	}
	const std::vector<CatalogueEntry> entries =
		catalogueEntries(options.domain, options.counts.first, options.counts.last, options.tiles);
	if (entries.empty())
	{
		throw Error(ExitCode::usage, "--counts: the catalogue has no such entry, expected 2 or more on the sphere");
	}
	return entries;
}

std::string pathOf(const CatalogueOptions& options, const std::string& below)
{
	return (nativePath(options.folder) / below).generic_string(); // the same words on every system
}

// Neither the statement nor the log is one of the catalogue's files.
void checkPlaces(const CatalogueOptions& options, const std::vector<CatalogueEntry>& entries)
{
	std::vector<std::string> paths;
	for (const CatalogueEntry& entry : entries)
	{
		paths.push_back(pathOf(options, entry.path));
	}
	checkNames({{}, options.json, {}, options.progress}, paths);
}

void makeFolders(const CatalogueOptions& options, const std::vector<CatalogueEntry>& entries, NewFolders& folders)
{
	for (const CatalogueEntry& entry : entries)
	{
		const std::string path = pathOf(options, entry.path);
		const std::filesystem::path folder = nativePath(path).parent_path();
		std::error_code failed;
		folders.make(folder, failed);
		if (failed)
		{
			throw Error(ExitCode::file, folder.string() + ": cannot be made: " + failed.message());
		}
		checkWritable(path);
	}
}

std::vector<std::string> differences(const CatalogueOptions& options, const std::vector<CatalogueFile>& files)
{
	std::vector<std::string> different;
	for (const CatalogueFile& file : files)
	{
		const std::string path = pathOf(options, file.path);
		if (!std::filesystem::exists(nativePath(path)) || readFile(path) != file.bytes)
		{
			different.push_back(path);
		}
	}
	return different;
}

void run(const CatalogueOptions& options, VerbProgress& progress)
{
	const std::vector<CatalogueEntry> entries = entriesOf(options);
	if (options.part)
	{
		checkPartOutputs({{options.folder}, options.json, {}, options.progress, options.part}, {});
	}
	else
	{
		checkPlaces(options, entries);
	}
	const RunSettings settings = progress.start("catalogue", options.threads, options.progress);
	NewFolders folders;
	if (!options.check && !options.part)
	{
		makeFolders(options, entries, folders);
	}
	const std::vector<CatalogueFile> files = makeCatalogue(entries, NOOK_VERSION, settings);
	const std::vector<std::string> different = options.check ? differences(options, files) : std::vector<std::string>{};

	OutputSet outputs;
	if (!options.check)
	{
		for (const CatalogueFile& file : files)
		{
			outputs.add(pathOf(options, file.path), file.bytes);
		}
	}
	if (!options.json.empty())
	{
		Summary summary("catalogue");
		summary.whole("files", files.size());
		summary.texts("different", different);
		outputs.add(options.json, summary.json());
	}
	outputs.commit();
	if (!different.empty())
	{
		throw Error(ExitCode::difference, different.front() + ": found other bytes than are made now in " +
											  std::to_string(different.size()) + " of " + std::to_string(files.size()) +
											  " files, expected none");
	}
}

} // namespace

Verb addCatalogueVerb(CLI::App& nook)
{
	const auto options = std::make_shared<CatalogueOptions>();
	CLI::App* const app =
		nook.add_subcommand("catalogue", "Makes all patterns of the catalogue, or compares them with what is there");
	options->domain_given = addDomain(*app, options->domain, "One domain (default: all, with tiles)");
	options->counts_given = addCounts(*app, "--counts", options->counts, kMaxCatalogueCount, "Numbers of samples (default 1-64)");
	app->add_flag("--tiles", options->tiles, "Disk: also the 4 x 4 tiles of the free patterns with 4 to 16 lines");
	app->add_flag("--check", options->check, "Writes nothing; exit code 7 when a file there differs from what would be written");
	addText(*app, "-o,--output", options->folder, "FOLDER", "The catalogue's folder; DOMAIN/DOMAIN_NNN.json are made in it")
		->required();
	addJson(*app, options->json);
	addThreads(*app, options->threads);
	addProgress(*app, options->progress);
	addPart(*app, options->part);
	addUnitCache(*app);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
