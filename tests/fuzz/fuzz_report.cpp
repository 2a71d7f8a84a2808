// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of time against error as JSON: what --join puts on a page, and --baseline compares with. Recipes of nook fit.
#include "fuzz.h"
#include "mutate_json.h"

#include "error_report/error_report.h"
#include "methods/recipes.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::fuzz::tryTo(
		[&]
		{
			const nook::ErrorReport report = nook::errorReportFrom(text, "file");
			if (nook::errorReportHtml({&report, 1}, "fuzz").empty() ||
				!nook::compareWithBaseline(report, report).regressions.empty())
			{
				std::abort();
			}
			// What was read is written as what is read again.
			const std::string written = nook::errorReportJson(report);
			if (nook::errorReportJson(nook::errorReportFrom(written, "written")) != written)
			{
				std::abort();
			}
		});
	nook::fuzz::tryTo(
		[&]
		{
			const std::string written = nook::recipesFile(nook::recipesOf(text, "file"), "fuzz");
			if (nook::recipesFile(nook::recipesOf(written, "written"), "fuzz") != written)
			{
				std::abort();
			}
		});
	return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
	nook::fuzz::Chance chance(seed);
	return nook::fuzz::written(nook::fuzz::mutatedJsonText(std::string(reinterpret_cast<const char*>(data), size), most, chance),
							   data, most);
}
