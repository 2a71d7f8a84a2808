// SPDX-License-Identifier: GPL-3.0-or-later
#include "verbs.h"

namespace nook
{

std::vector<Verb> addVerbs(CLI::App& nook)
{
	return {addPatternVerb(nook), addTileVerb(nook), addCatalogueVerb(nook), addGBufferVerb(nook), addReferenceVerb(nook),
			addShadeVerb(nook),   addEmitVerb(nook), addCompareVerb(nook),   addReportVerb(nook),  addLevelVerb(nook),
			addVolumesVerb(nook), addInfoVerb(nook), addStressVerb(nook),    addTuneVerb(nook)};
}

} // namespace nook
