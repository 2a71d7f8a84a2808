// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs.h"

#include "components.h"
#include "report_verbs.h"

#include "core/error.h"

namespace nook
{

void refuseWithout(const std::string& component, const std::string& what)
{
	throw Error(ExitCode::unsupported, what + ": found a program without the component " + component +
										   ", expected one that was built with it (NOOK_COMPONENTS)");
}

namespace
{

// It stands in the help, and says that it is not there.
[[maybe_unused]] Verb absentVerb(CLI::App& app, const std::string& name, const std::string& component)
{
	CLI::App* const verb = app.add_subcommand(name, "Not in this build: needs the component " + component);
	verb->allow_extras();
	const std::string whole = app.get_parent() != nullptr ? app.get_name() + " " + name : name;
	return {verb, [whole, component](VerbProgress&)
			{
				refuseWithout(component, whole);
			}};
}

template <bool there, class Add> Verb verbOf(CLI::App& nook, const char* name, const char* component, const Add& add)
{
	if constexpr (there)
	{
		return add(nook);
	}
	else
	{
		return absentVerb(nook, name, component);
	}
}

} // namespace

// Functions of components that are not there are named in generic lambdas alone: what is not called is not linked.
std::vector<Verb> addVerbs(CLI::App& nook)
{
	return {addPatternVerb(nook),
			addTileVerb(nook),
			addCatalogueVerb(nook),
			verbOf<kHasLevels>(nook, "gbuffer", "levels", [](auto& app) { return addGBufferVerb(app); }),
			verbOf<kHasLevels>(nook, "reference", "levels", [](auto& app) { return addReferenceVerb(app); }),
			verbOf<kHasShading>(nook, "shade", "shading", [](auto& app) { return addShadeVerb(app); }),
			addEmitVerb(nook),
			verbOf<kHasLevels>(nook, "compare", "levels", [](auto& app) { return addCompareVerb(app); }),
			addReportVerb(nook),
			verbOf<kHasLevels>(nook, "level", "levels", [](auto& app) { return addLevelVerb(app); }),
			verbOf<kHasLevels>(nook, "volumes", "levels", [](auto& app) { return addVolumesVerb(app); }),
			verbOf<kHasLevels>(nook, "bake", "levels", [](auto& app) { return addBakeVerb(app); }),
			addInfoVerb(nook),
			addMergeVerb(nook),
			verbOf<kHasReports>(nook, "stress", "reports", [](auto& app) { return addStressVerb(app); }),
			verbOf<kHasReports>(nook, "fit", "reports", [](auto& app) { return addFitVerb(app); }),
			verbOf<kHasReports>(nook, "tune", "reports", [](auto& app) { return addTuneVerb(app); }),
			verbOf<kHasLevels>(nook, "plan", "levels", [](auto& app) { return addPlanVerb(app); }),
			verbOf<kHasLevels>(nook, "batch", "levels", [](auto& app) { return addBatchVerb(app); })};
}

Verb addReportErrorVerb(CLI::App& report)
{
	return verbOf<kHasReports>(report, "error", "reports", [](auto& app) { return addReportError(app); });
}

Verb addReportLiveVerb(CLI::App& report)
{
	return verbOf<kHasReports>(report, "live", "reports", [](auto& app) { return addReportLive(app); });
}

} // namespace nook
