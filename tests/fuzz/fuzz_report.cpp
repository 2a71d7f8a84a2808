// SPDX-License-Identifier: GPL-3.0-or-later
// Reports of error against time as JSON, as read by --join and --baseline, and recipes of nook fit.
#include "fuzz.h"
#include "mutate_json.h"

#include "methods/recipes.h"
#include "study/error_report.h"

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
			// A report that was read must survive being written and read again.
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

NOOK_MUTATED_BY(nook::fuzz::mutatedJsonText)
