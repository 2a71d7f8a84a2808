// SPDX-License-Identifier: GPL-3.0-or-later
#include "still_options.h"

#include "volume_methods.h"

#include "core/error.h"
#include "scene/load.h"

#include <algorithm>
#include <cassert>

namespace nook
{

void addStillOptions(CLI::App& app, StillOptions& options)
{
	addText(app, "--bake", options.bake, "FILE.glb",
			"Values at the vertices of the level that the G-buffer shows (nook bake): --method bake draws them alone, " +
				volumeMethods(" and ") +
				" add those that were made beside their volumes; with another method only what moves darkens them");
	addText(app, "--static", options.still, "FILE.exr",
			"With --volumes and a screen-space method: a G-buffer of the same camera without what moves (with --bake it is known)");
}

void checkStill(const StillOptions& options, bool volumes, bool screen)
{
	if (options.alone && options.bake.empty())
	{
		throw Error(ExitCode::usage, "--bake: found none with --method bake, expected a file of nook bake");
	}
	if (options.alone && volumes)
	{
		throw Error(ExitCode::usage, "--volumes: found with --method bake, expected --method " + volumeMethods(" or "));
	}
	if (!options.still.empty() && !options.bake.empty())
	{
		throw Error(ExitCode::usage, "--static: found with --bake, which says it, expected one of them");
	}
	if (!options.still.empty() && (!volumes || !screen))
	{
		throw Error(ExitCode::usage,
					"--static: found without " + std::string(volumes ? "a screen-space method" : "--volumes") + ", expected both");
	}
}

namespace
{

void readBake(const StillOptions& options, bool volumes, bool mask, const GBuffer& gbuffer, const RunSettings& run, Still& still)
{
	const LoadedLevel loaded = loadLevel(options.bake, {}, run);
	const BakedValues values = loadBakedValues(options.bake, loaded.level, run);
	const BakedKind expected = !volumes ? BakedKind::visibility : mask ? BakedKind::beside_mask_volumes : BakedKind::beside_volumes;
	if (values.kind != expected)
	{
		const auto nameOf = [](BakedKind kind)
		{
			return kind == BakedKind::visibility       ? "visibility"
				   : kind == BakedKind::beside_volumes ? "the difference to volumes (" + sumMethod() + ")"
													   : "the difference to masks (" + maskMethod() + ")";
		};
		throw Error(ExitCode::invalid_input, options.bake + ": found " + nameOf(values.kind) + ", expected " + nameOf(expected) +
												 (volumes ? ", as of nook bake --volumes" : ", as of nook bake without --volumes"));
	}
	const Tracer tracer(loaded.level, run);
	still.baked = bakedPicture(tracer, values, gbuffer, run);
	still.gbuffer = std::move(still.baked->still);
	still.files = loaded.level.files;
	still.baked_pixels =
		static_cast<std::size_t>(std::count(still.baked->is_baked.begin(), still.baked->is_baked.end(), uint8_t{1}));
}

} // namespace

Still readStill(const StillOptions& options, bool volumes, bool mask, const GBuffer& gbuffer, const RunSettings& run)
{
	Still still;
	if (!options.bake.empty())
	{
		readBake(options, volumes, mask, gbuffer, run, still);
	}
	if (!options.still.empty())
	{
		still.gbuffer = readGBuffer(options.still, {});
		still.files.push_back(options.still);
		if (still.gbuffer->width_px != gbuffer.width_px || still.gbuffer->height_px != gbuffer.height_px ||
			still.gbuffer->view.projection != gbuffer.view.projection ||
			still.gbuffer->view.camera_from_world != gbuffer.view.camera_from_world)
		{
			throw Error(ExitCode::invalid_input,
						options.still + ": found another size or camera than the picture's, expected the same view");
		}
	}
	if (still.gbuffer)
	{
		still.is_still = alignStill(*still.gbuffer, gbuffer);
		still.moving_pixels = static_cast<std::size_t>(std::count(still.is_still.begin(), still.is_still.end(), uint8_t{0}));
		if (still.gbuffer->depth == gbuffer.depth)
		{
			still.gbuffer.reset(); // nothing moves: both pictures are one
		}
	}
	return still;
}

std::vector<float> visibilityOfStill(const Still& still, const std::vector<float>& by_volumes, std::size_t pixels)
{
	std::vector<float> visibility = by_volumes.empty() ? std::vector<float>(pixels, 1.0F) : by_volumes;
	for (std::size_t i = 0; still.baked && i < pixels; ++i)
	{
		if (still.baked->is_baked[i] != 0)
		{
			const float value = still.baked->values[i];
			visibility[i] = std::clamp(by_volumes.empty() ? value : by_volumes[i] + value, 0.0F, 1.0F);
		}
	}
	return visibility;
}

std::vector<float> overStill(const Still& still, const std::vector<float>& known, const std::vector<float>& screen,
							 const std::vector<float>& screen_still)
{
	assert(known.size() == screen.size());
	std::vector<float> visibility(known.size());
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		const bool is_still = !still.is_still.empty() && still.is_still[i] != 0;
		if (!is_still)
		{
			visibility[i] = std::min(known[i], screen[i]);
			continue;
		}
		const float before = screen_still.empty() ? screen[i] : screen_still[i];
		visibility[i] = screen[i] < before ? known[i] * (screen[i] / before) : known[i];
	}
	return visibility;
}

void addStillFacts(Summary& summary, const StillOptions& options, const Still& still)
{
	if (!options.bake.empty())
	{
		summary.whole("baked_pixels", still.baked_pixels);
	}
	if (!still.is_still.empty())
	{
		summary.whole("moving_pixels", still.moving_pixels);
	}
}

} // namespace nook
