// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/whole_stage.h"

#include "core/kept_answers.h"

#include <cassert>

namespace nook
{
namespace
{

bool isKept(const RunSettings& run)
{
	return run.units != nullptr && run.units->isKept();
}

} // namespace

void runShared(const WorkStage& stage, const RunSettings& run)
{
	assert(stage.count == 1);
	if (run.units == nullptr || isKept(run) || !keepsAnswers())
	{
		stage.compute(0);
		return;
	}
	const KeptAnswer kept(run.units->keyOf(stage.name));
	if (!kept.answer() || !stage.load(0, *kept.answer()))
	{
		stage.compute(0);
		kept.keep(stage.save(0));
	}
}

void runWhole(const WorkStage& stage, const RunSettings& run)
{
	if (isKept(run))
	{
		runStage(stage, {1, {}, run.units});
		return;
	}
	runShared(stage, run);
}

} // namespace nook
