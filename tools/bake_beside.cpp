// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_beside.h"

#include "volume_methods.h"

#include "core/error.h"
#include "methods/method_table.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

std::array<std::string_view, 2> volumesBy()
{
	return {volumeRow(false).name, volumeRow(true).name};
}

} // namespace

void addBesideOptions(CLI::App& app, BesideOptions& options)
{
	addText(app, "--volumes", options.path, "FILE.glb",
			"Occlusion volumes of the level that are drawn as well: what is baked is the difference to add to them");
	options.method = addChoiceText(
		app, "--volumes-by", volumesBy(), [&options](std::size_t i) { options.mask = i == 1; },
		"With --volumes: how they are drawn: " + sumMethod() + " (default) or " + maskMethod());
	options.directions_option = addDirections(app, options.directions);
}

void checkBeside(const BesideOptions& options)
{
	if (options.path.empty() && (options.method->count() > 0 || options.directions_option->count() > 0))
	{
		throw Error(ExitCode::usage, std::string(options.method->count() > 0 ? "--volumes-by" : "--directions") +
										 ": found no volumes, expected --volumes");
	}
	checkDirections(*options.directions_option, options.directions, options.mask);
}

Beside::Beside(const BesideOptions& options, const RunSettings& run)
	: m_options(options), m_volumes(readVolumes(options.path)), m_evaluator(std::make_unique<VolumeEvaluator>(m_volumes, run))
{
}

double Beside::visibilityAt(glm::dvec3 position, glm::dvec3 normal) const
{
	return m_options.mask ? m_evaluator->maskedVisibility(position, normal, m_options.directions)
						  : 1.0 - m_volumes.compensation.at(m_evaluator->occlusion(position, normal));
}

BakedKind kindOf(const BesideOptions& options)
{
	return options.path.empty() ? BakedKind::visibility : options.mask ? BakedKind::beside_mask_volumes : BakedKind::beside_volumes;
}

} // namespace nook
