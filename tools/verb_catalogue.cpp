// SPDX-License-Identifier: GPL-3.0-or-later
// nook catalogue: every pattern of the catalogue, made or compared.
#include "options.h"

#include "core/error.h"
#include "core/file.h"
#include "core/lists.h"
#include "core/system.h"
#include "emit/catalogue.h"
#include "version.h"

#include <filesystem>

namespace nook
{
namespace
{

struct CatalogueOptions
{
	std::optional<Domain> domain;
	CountRange counts{1, kMaxCatalogueCount};
	bool tiles = false;
	bool check = false;
	std::string folder;
	Outputs outputs;
};

std::vector<CatalogueEntry> entriesOf(const CatalogueOptions& options)
{
	if (!options.domain)
	{
		return catalogueEntries();
	}
	const std::vector<CatalogueEntry> entries =
		catalogueEntries(*options.domain, options.counts.first, options.counts.last, options.tiles);
	refuseIf(entries.empty(), "--counts: the catalogue has no such entry, expected 2 or more on the sphere");
	return entries;
}

std::string pathOf(const CatalogueOptions& options, const std::string& below)
{
	return (nativePath(options.folder) / below).generic_string(); // the same words on every system
}

void makeFolders(const CatalogueOptions& options, const std::vector<CatalogueEntry>& entries, NewFolders& folders)
{
	for (const CatalogueEntry& entry : entries)
	{
		const std::string path = pathOf(options, entry.path);
		const std::filesystem::path folder = nativePath(path).parent_path();
		std::error_code failed;
		folders.make(folder, failed);
		refuseIf(bool(failed), folder.string() + ": cannot be made: " + failed.message(), ExitCode::file);
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

void run(CatalogueOptions& options, VerbProgress& progress)
{
	const std::vector<CatalogueEntry> entries = entriesOf(options);
	// Neither the statement nor the log is one of the catalogue's files.
	checkNames(options.outputs, mapped(entries, [&options](const CatalogueEntry& entry) { return pathOf(options, entry.path); }));
	const RunSettings settings = progress.start("catalogue", options.outputs.threads, options.outputs.progress);
	NewFolders folders;
	if (!options.check && !options.outputs.share)
	{
		makeFolders(options, entries, folders);
	}
	const std::vector<CatalogueFile> files = makeCatalogue(entries, NOOK_VERSION, settings);
	if (options.outputs.share)
	{
		return;
	}
	const std::vector<std::string> different = options.check ? differences(options, files) : std::vector<std::string>{};

	Facts facts = verbFacts("catalogue");
	facts.whole("files", files.size());
	facts.texts("different", different);
	OutputSet outputs;
	for (const CatalogueFile& file : options.check ? std::vector<CatalogueFile>{} : files)
	{
		outputs.add(pathOf(options, file.path), file.bytes);
	}
	addSide(outputs, options.outputs, facts.json(), {});
	outputs.commit();
	if (!different.empty())
	{
		throw Error(ExitCode::difference, different.front() + ": found other bytes than are made now in " +
											  std::to_string(different.size()) + " of " + std::to_string(files.size()) +
											  " files, expected none");
	}
}

void declare(CLI::App& app, CatalogueOptions& options)
{
	const OptionRule domain{"--domain", "--domain as well", "without --domain, which makes the whole catalogue"};
	addOptions(
		app,
		{{"--domain", takesChoice(patternDomains(), options.domain), "One domain (default: all, with tiles)"},
		 {"--counts", takesCounts(options.counts, kMaxCatalogueCount), "Numbers of samples (default 1-64)", {.needs = {domain}}},
		 {"--tiles",
		  takesFlag(options.tiles),
		  "Disk: also the 4 x 4 tiles of the free patterns with 4 to 16 lines",
		  {.needs = {domain, {"--domain disk", "--domain disk", "with another domain"}}}},
		 {"--check", takesFlag(options.check), "Writes nothing; exit code 7 when a file there differs from what would be written"},
		 {"-o,--output", takesText(options.folder, "FOLDER"), "The catalogue's folder; DOMAIN/DOMAIN_NNN.json are made in it",
		  kRequired}});
	addJson(app, options.outputs.json);
	addRun(app, options.outputs, true);
}

} // namespace

Verb addCatalogueVerb(CLI::App& nook)
{
	return addVerb<CatalogueOptions>(nook, "catalogue", "Makes all patterns of the catalogue, or compares them with what is there",
									 declare, run);
}

} // namespace nook
