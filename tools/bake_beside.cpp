// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake_beside.h"

#include "options.h"

#include "core/error.h"
#include "methods/directions.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <array>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kVolumesBy{"aov", "aov-mask"};

} // namespace

void addBesideOptions(CLI::App& app, BesideOptions& options)
{
	addText(app, "--volumes", options.path, "FILE.glb",
			"Occlusion volumes of the level that are drawn as well: what is baked is the difference to add to them");
	options.method = addChoiceText(
		app, "--volumes-by", kVolumesBy, [&options](std::size_t i) { options.mask = i == 1; },
		"With --volumes: how they are drawn: aov (default) or aov-mask");
	options.directions_option = addWhole(app, "--directions", options.directions, kLeastDirections, kMostDirections,
										 "--volumes-by aov-mask: directions of a mask, a multiple of 32 (default 128)");
}

void checkBeside(const BesideOptions& options)
{
	if (options.path.empty() && (options.method->count() > 0 || options.directions_option->count() > 0))
	{
		throw Error(ExitCode::usage, std::string(options.method->count() > 0 ? "--volumes-by" : "--directions") +
										 ": found no volumes, expected --volumes");
	}
	if (options.directions_option->count() > 0 && !options.mask)
	{
		throw Error(ExitCode::usage, "--directions: found with --volumes-by aov, expected aov-mask");
	}
	if (options.directions % 32 != 0)
	{
		refuseValue("--directions", std::to_string(options.directions), "a multiple of 32");
	}
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
