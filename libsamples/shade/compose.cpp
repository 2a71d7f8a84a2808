// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/compose.h"

#include "bake/bake.h"
#include "core/error.h"
#include "core/lists.h"
#include "core/words.h"
#include "format/tile_json.h"
#include "methods/feature_checks.h"
#include "pattern/recipe.h"
#include "pattern/tile.h"
#include "volume/volume_glb.h"

#include <algorithm>
#include <cassert>

namespace nook
{
namespace
{

// Per pixel, what is known of surfaces that do not move.
struct Static
{
	std::optional<BakedPicture> baked;
	std::optional<GBuffer> gbuffer; // of what does not move, where it differs from the picture's
	std::vector<uint8_t> is_fixed;  // 1: the pixel shows what does not move; empty: not known
	std::vector<std::string> files; // read
};

void readBake(const ComposeSettings& settings, const GBuffer& gbuffer, const RunSettings& run, Static& fixed)
{
	const LoadedLevel loaded = loadLevel(settings.bake, {}, run);
	const BakedValues values = loadBakedValues(settings.bake, loaded.level, run);
	const bool volumes = !settings.volumes.empty();
	const BakedKind expected = !volumes            ? BakedKind::visibility
							   : settings.aov.mask ? BakedKind::mask_volume_difference
												   : BakedKind::volume_difference;
	if (values.kind != expected)
	{
		const auto kindName = [](BakedKind kind)
		{
			return kind == BakedKind::visibility
					   ? "visibility"
					   : std::string("the difference to ") + (kind == BakedKind::volume_difference ? "volumes (" : "masks (") +
							 std::string(volumeRow(kind != BakedKind::volume_difference).name) + ")";
		};
		refuseInput(settings.bake, kindName(values.kind),
					kindName(expected) + (volumes ? ", as of nook bake --volumes" : ", as of nook bake without --volumes"));
	}
	const Tracer tracer(loaded.level, run);
	fixed.baked = bakedPicture(tracer, values, gbuffer, run);
	fixed.gbuffer = std::move(fixed.baked->fixed);
	fixed.files = loaded.level.files;
}

// Throws Error (invalid_input) for a bake that was made for something else, or a G-buffer of another size or camera.
Static readStatic(const ComposeSettings& settings, const GBuffer& gbuffer, const RunSettings& run)
{
	Static fixed;
	if (!settings.bake.empty())
	{
		readBake(settings, gbuffer, run, fixed);
	}
	if (!settings.fixed.empty())
	{
		fixed.gbuffer = readGBuffer(settings.fixed, {});
		fixed.files.push_back(settings.fixed);
		refuseInputIf(fixed.gbuffer->width_px != gbuffer.width_px || fixed.gbuffer->height_px != gbuffer.height_px ||
						  fixed.gbuffer->view.projection != gbuffer.view.projection ||
						  fixed.gbuffer->view.camera_from_world != gbuffer.view.camera_from_world,
					  settings.fixed, "another size or camera than the picture's", "the same view");
	}
	if (fixed.gbuffer)
	{
		fixed.is_fixed = alignStatic(*fixed.gbuffer, gbuffer);
		if (fixed.gbuffer->depth == gbuffer.depth)
		{
			fixed.gbuffer.reset(); // nothing moves: both pictures are one
		}
	}
	return fixed;
}

// Visibility by volumes (empty if there are none) and by the bake; their sum if the bake holds the difference.
std::vector<float> visibilityOfStatic(const Static& fixed, const std::vector<float>& by_volumes, std::size_t pixels)
{
	std::vector<float> visibility = by_volumes.empty() ? std::vector<float>(pixels, 1.0F) : by_volumes;
	for (std::size_t i = 0; fixed.baked && i < pixels; ++i)
	{
		if (fixed.baked->is_baked[i] != 0)
		{
			const float value = fixed.baked->values[i];
			visibility[i] = std::clamp(by_volumes.empty() ? value : by_volumes[i] + value, 0.0F, 1.0F);
		}
	}
	return visibility;
}

// Screen space over what is known, 1 where nothing is. `screen_fixed`: without what moves; empty: nothing moves.
std::vector<float> overStatic(const Static& fixed, const std::vector<float>& known, const std::vector<float>& screen,
							  const std::vector<float>& screen_fixed)
{
	assert(known.size() == screen.size());
	std::vector<float> visibility(known.size());
	for (std::size_t i = 0; i < visibility.size(); ++i)
	{
		const bool is_fixed = !fixed.is_fixed.empty() && fixed.is_fixed[i] != 0;
		if (!is_fixed)
		{
			visibility[i] = std::min(known[i], screen[i]);
			continue;
		}
		const float before = screen_fixed.empty() ? screen[i] : screen_fixed[i];
		visibility[i] = screen[i] < before ? known[i] * (screen[i] / before) : known[i];
	}
	return visibility;
}

void addTimes(Shaded& shaded, const Shaded& more)
{
	shaded.seconds += more.seconds;
	append(shaded.passes, more.passes);
}

Shaded drawScreen(const ComposeSettings& settings, const ShadeSamples& samples, const GBuffer& gbuffer, const RunSettings& run)
{
	return settings.gl ? shadeOnGl(gbuffer, samples, settings.shade, settings.drawing)
					   : shadeOnCpu(gbuffer, samples, settings.shade, run, settings.drawing);
}

// Without --pattern.
Pattern defaultPattern(const ShadeSettings& settings, const RunSettings& run)
{
	const MethodRow& row = rowOf(settings.method);
	if (row.own_pattern != nullptr)
	{
		return row.own_pattern(row.default_count);
	}
	Recipe recipe{.domain = domainOf(settings.method)};
	recipe.count = row.default_count / radiiOf(settings.volume); // as many depths
	recipe.symmetric = settings.volume.paired;
	recipe.order = settings.bands.count > 1 ? Order::progressive : Order::none;
	return generatePattern(recipe, run);
}

PatternTile tileFor(const std::string& path, const ShadeSettings& settings, const RunSettings& run)
{
	const Domain domain = domainOf(settings.method);
	if (path.empty())
	{
		TileRecipe tile{.kind = TileKind::random};
		return generateTile(defaultPattern(settings, run), tile, run);
	}
	std::variant<PatternFile, TileFile> input =
		readInput(path, mayTakeTile(settings.method) ? std::nullopt : std::optional(domain));
	PatternTile tile;
	if (PatternFile* const file = std::get_if<PatternFile>(&input))
	{
		completeWeights(*file);
		tile.domain = file->pattern.domain;
		tile.size = 1;
		tile.variants = {file->pattern};
	}
	else
	{
		tile = std::get<TileFile>(input).tile;
	}
	if (settings.bands.count > 1)
	{
		checkProgressive(input, path);
	}
	refuseInputIf(tile.domain != domain, path + ": domain", std::string(nameOf(tile.domain)),
				  std::string(nameOf(domain)) + " for --method " + std::string(nameOf(settings.method)));
	return tile;
}

// The samples of a pattern or a tile, or nook's own without a path. Throws Error if the file does not suit method or frame.
ShadeSamples shadeSamples(const std::string& path, const std::optional<int>& frame, const ShadeSettings& settings,
						  const RunSettings& run)
{
	const bool tile_alone = mayTakeTile(settings.method) && !path.empty();
	refuseIf(frame && (path.empty() || !(takesPattern(settings.method) || tile_alone)),
			 "--frame: found without a tile, expected --pattern with one made by nook tile --frames");
	if (!takesPattern(settings.method) && !tile_alone)
	{
		return ownSamples(settings);
	}
	PatternTile tile = tileFor(path, settings, run);
	refuseIf(frame && tile.frames == 1, path + ": frames: found one, expected several for --frame", ExitCode::invalid_input);
	if (settings.volume.paired)
	{
		for (Pattern& variant : tile.variants)
		{
			variant = pairedPattern(variant);
		}
	}
	ShadeSamples samples = samplesOf(settings.method, tile.variants, layersOf(tile));
	samples.variant = variantOfFrame(tile, frame.value_or(0));
	return samples;
}

ShadeSamples checkedSamples(const ComposeSettings& settings, const RunSettings& run)
{
	ShadeSamples samples = shadeSamples(settings.pattern, settings.frame, settings.shade, run);
	if (settings.shade.filter == ShadeFilter::window && samples.size == 1)
	{
		const bool given = !settings.pattern.empty();
		throw Error(ExitCode::usage, "--filter: found 'window' with " +
										 (given ? settings.pattern : "--method " + std::string(nameOf(settings.shade.method))) +
										 ", whose samples have no window, expected " +
										 (given ? "--pattern with a tile" : "another filter"));
	}
	checkDebug(settings.shade, samples);
	return samples;
}

Shaded drawVolumes(const ComposeSettings& settings, const GBuffer& gbuffer, const RunSettings& run, Composed& composed)
{
	const VolumeSet volumes = readVolumes(settings.volumes);
	AovShaded drawn = settings.gl ? aovOnGl(gbuffer, volumes, settings.aov, settings.drawing)
								  : aovOnCpu(gbuffer, volumes, settings.aov, run, settings.drawing);
	composed.volumes = drawn.counts;
	composed.distance_m = volumes.distance_m;
	composed.ray_distance_m = volumes.ray_distance_m;
	return std::move(drawn.shaded);
}

// The rows of the picture within the guard band.
template <class Value> std::vector<Value> inside(const GBuffer& gbuffer, const std::vector<Value>& values, int guard)
{
	std::vector<Value> inner;
	for (int y = guard; y < gbuffer.height_px - guard; ++y)
	{
		const auto row = values.begin() + static_cast<std::ptrdiff_t>(y) * gbuffer.width_px;
		inner.insert(inner.end(), row + guard, row + gbuffer.width_px - guard);
	}
	return inner;
}

} // namespace

Composed compose(const ComposeSettings& settings, const GBuffer& gbuffer, const RunSettings& run)
{
	Composed composed;
	const bool has_volumes = !settings.volumes.empty();
	const Static fixed = readStatic(settings, gbuffer, run);
	if (fixed.baked)
	{
		composed.baked_pixels =
			static_cast<std::size_t>(std::count(fixed.baked->is_baked.begin(), fixed.baked->is_baked.end(), uint8_t{1}));
	}
	if (!fixed.is_fixed.empty())
	{
		composed.moving_pixels = static_cast<std::size_t>(std::count(fixed.is_fixed.begin(), fixed.is_fixed.end(), uint8_t{0}));
	}
	composed.files = fixed.files;
	if (settings.screen)
	{
		composed.samples = checkedSamples(settings, run);
		composed.shaded = drawScreen(settings, composed.samples, gbuffer, run);
	}
	const Shaded volumes = has_volumes ? drawVolumes(settings, gbuffer, run, composed) : Shaded{};
	std::vector<float> known = visibilityOfStatic(fixed, volumes.visibility, gbuffer.depth.size());
	if (!settings.screen)
	{
		composed.shaded = volumes;
		composed.shaded.renderer = has_volumes ? volumes.renderer : "CPU";
		composed.shaded.visibility = std::move(known);
	}
	else if (has_volumes || fixed.baked)
	{
		addTimes(composed.shaded, volumes);
		std::vector<float> without; // what moves
		if (fixed.gbuffer)
		{
			const Shaded drawn = drawScreen(settings, composed.samples, *fixed.gbuffer, run);
			addTimes(composed.shaded, drawn);
			without = drawn.visibility;
		}
		composed.shaded.visibility = overStatic(fixed, known, composed.shaded.visibility, without);
	}
	return composed;
}

Picture withoutGuard(const std::string& path, const GBuffer& gbuffer, const std::vector<float>& values, int guard_px)
{
	Picture inner{gbuffer.width_px - 2 * guard_px, gbuffer.height_px - 2 * guard_px, {}};
	refuseInputIf(inner.width_px < 1 || inner.height_px < 1, path,
				  std::to_string(gbuffer.width_px) + " x " + std::to_string(gbuffer.height_px) + " pixels",
				  "more than --guard " + std::to_string(guard_px) + " leaves nothing of");
	inner.values = inside(gbuffer, values, guard_px);
	return inner;
}

std::vector<glm::vec3> withoutGuard(const GBuffer& gbuffer, const std::vector<glm::vec3>& values, int guard_px)
{
	return inside(gbuffer, values, guard_px);
}

} // namespace nook
