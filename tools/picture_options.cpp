// SPDX-License-Identifier: GPL-3.0-or-later
#include "picture_options.h"

#include "options.h"

#include "core/error.h"
#include "core/number.h"

#include <algorithm>

namespace nook
{

void addPictureOptions(CLI::App& app, ShadeSettings& settings, PictureOptions& picture)
{
	addWhole(
		app, "--guard", picture.guard_px, 0, 4096,
		"Pixels on each side of FILE that are neighbours but no part of the picture: the output is smaller by them (default 0)");
	addNumber(
		app, "--max-pixels", settings.max_radius_px, 1.0, 65536.0,
		"The greatest radius in the picture, near the camera (default: its height); the summary counts the pixels it changes");
	addNumber(app, "--min-pixels", settings.min_radius_px, 0.0, 65536.0, "The least radius in the picture, far away (default 0)");
}

void checkPictureOptions(const ShadeSettings& settings)
{
	if (settings.max_radius_px > 0.0 && settings.min_radius_px > settings.max_radius_px)
	{
		refuseValue("--min-pixels", numberText(settings.min_radius_px), "at most --max-pixels");
	}
}

Picture withoutGuard(const std::string& path, const GBuffer& gbuffer, const std::vector<float>& values,
					 const PictureOptions& picture)
{
	const int guard = picture.guard_px;
	Picture inner{gbuffer.width_px - 2 * guard, gbuffer.height_px - 2 * guard, {}};
	if (inner.width_px < 1 || inner.height_px < 1)
	{
		throw Error(ExitCode::invalid_input, path + ": found " + std::to_string(gbuffer.width_px) + " x " +
												 std::to_string(gbuffer.height_px) + " pixels, expected more than --guard " +
												 std::to_string(guard) + " leaves nothing of");
	}
	for (int y = guard; y < guard + inner.height_px; ++y)
	{
		const auto row = values.begin() + static_cast<std::ptrdiff_t>(y) * gbuffer.width_px + guard;
		inner.values.insert(inner.values.end(), row, row + inner.width_px);
	}
	return inner;
}

} // namespace nook
