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

namespace
{

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
	inner.values = inside(gbuffer, values, guard);
	return inner;
}

std::vector<glm::vec3> withoutGuard(const GBuffer& gbuffer, const std::vector<glm::vec3>& values, const PictureOptions& picture)
{
	return inside(gbuffer, values, picture.guard_px);
}

} // namespace nook
