// SPDX-License-Identifier: GPL-3.0-or-later
#include "debug_options.h"

#include "options.h"

#include "core/error.h"
#include "methods/method_table.h"

#include <array>
#include <string>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 5> kViews{"edges", "lod", "layers", "samples", "noise"};

// What a view is of: "--method vo-area, sao, or alchemy with --depth-levels".
std::string shownBy(DebugView view)
{
	const auto shows = [view](const MethodRow& row)
	{
		ShadeSettings settings;
		settings.method = row.method;
		return row.kind == MethodKind::screen && debugShows(view, settings);
	};
	switch (view)
	{
	case DebugView::edges: return "any method";
	case DebugView::samples:
	case DebugView::noise:
		return "a method with samples, any but " +
			   methodNames([&](const MethodRow& row) { return row.kind == MethodKind::screen && !shows(row); });
	case DebugView::lod:
	case DebugView::layers: break;
	}
	std::string text = "--method " + methodNames(shows);
	for (const MethodRow& row : methodTable())
	{
		const bool more = view == DebugView::lod && !row.levels_option.empty();
		text += more ? ", or " + std::string(row.name) + " with " + std::string(row.levels_option) : "";
	}
	return text;
}

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
										 shownBy(*settings.debug));
	}
}

void checkDebug(const ShadeSettings& settings, const ShadeSamples& samples)
{
	if (settings.debug == DebugView::noise && samples.size == 1 && rowOf(settings.method).noise_variants == 0)
	{
		throw Error(ExitCode::usage,
					"--debug: found noise with a pattern, the same at every pixel, expected --pattern with a tile");
	}
}

} // namespace nook
