// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_summary.h"

namespace nook
{

void addLevelFacts(Summary& summary, const LoadedLevel& loaded)
{
	summary.text("level", loaded.level.name);
	summary.whole("triangles", loaded.level.triangles.size());
	std::vector<std::string> findings;
	for (const Finding& finding : loaded.diagnosis.findings)
	{
		findings.push_back(finding.id + " " + std::to_string(finding.count));
	}
	summary.texts("findings", findings);
}

} // namespace nook
