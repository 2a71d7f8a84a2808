// SPDX-License-Identifier: GPL-3.0-or-later
#include "debug_options.h"

#include "method_options.h"
#include "options.h"

#include "core/error.h"

#include <array>
#include <string>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 5> kViews{"edges", "lod", "layers", "samples", "noise"};
constexpr std::array<const char*, 5> kShown{"any method", "--method vo-area, sao, or alchemy with --depth-levels",
											"--method statvo", "a method with samples, any but statvo",
											"a method with samples, any but statvo"};

} // namespace

void addDebugOption(CLI::App& app, ShadeSettings& settings)
{
	addChoiceText(
		app, "--debug", kViews, [&settings](std::size_t i) { settings.debug = static_cast<DebugView>(i); },
		"Draws what happens instead of visibility, before any filter, 0 to 1: edges, where a filter finds another surface beside "
		"a pixel; lod, the mean level of coarser depths that samples read, of all; layers, those that StatVO looks at, of all; "
		"samples, those taken, of all; noise, the standard deviation over all variants of the window");
}

std::string_view debugName(const ShadeSettings& settings)
{
	return settings.debug ? kViews[static_cast<std::size_t>(*settings.debug)] : "visibility";
}

void checkDebug(const ShadeSettings& settings)
{
	if (settings.debug && !debugShows(*settings.debug, settings))
	{
		throw Error(ExitCode::usage, "--debug: found " + std::string(debugName(settings)) + " with --method " +
										 std::string(nameOf(settings.method)) + ", of which it says nothing, expected " +
										 kShown[static_cast<std::size_t>(*settings.debug)]);
	}
}

void checkDebug(const ShadeSettings& settings, const ShadeSamples& samples)
{
	if (settings.debug == DebugView::noise && samples.size == 1 && settings.method != ShadeMethod::sao)
	{
		throw Error(ExitCode::usage,
					"--debug: found noise with a pattern, the same at every pixel, expected --pattern with a tile");
	}
}

} // namespace nook
