// SPDX-License-Identifier: GPL-3.0-or-later
#include "gbuffer_options.h"

#include "core/error.h"
#include "options.h"

#include <array>
#include <charconv>

namespace nook
{

// Names as on the command line, in the order of the enumerators.
template <> std::span<const std::string_view> namesOf<DepthKind>()
{
	static constexpr std::array<std::string_view, 3> kNames{"linear", "distance", "device"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<ClipRange>()
{
	static constexpr std::array<std::string_view, 2> kNames{"minus-one-to-one", "zero-to-one"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<NormalSpace>()
{
	static constexpr std::array<std::string_view, 2> kNames{"view", "world"};
	return kNames;
}

template <> std::span<const std::string_view> namesOf<NormalRange>()
{
	static constexpr std::array<std::string_view, 2> kNames{"plus-minus-one", "zero-to-one"};
	return kNames;
}

namespace
{

constexpr std::array<std::string_view, 2> kNormalSources{"file", "from-depth"};

std::array<int, 4> viewportOf(const std::string& text)
{
	std::array<int, 4> viewport{};
	const char* at = text.data();
	const char* const end = at + text.size();
	bool good = true;
	for (std::size_t i = 0; good && i < viewport.size(); ++i)
	{
		const std::from_chars_result read = std::from_chars(at, end, viewport[i]);
		good = read.ec == std::errc{} && viewport[i] >= (i < 2 ? 0 : 1) &&
			   (i == 3 ? read.ptr == end : read.ptr != end && *read.ptr == ',');
		at = read.ptr + (good && i < 3 ? 1 : 0);
	}
	if (!good)
	{
		refuseValue("--viewport", text, "X,Y,W,H in whole pixels, as in 0,0,640,360");
	}
	return viewport;
}

} // namespace

std::vector<CLI::Option*> addGBufferChannels(CLI::App& app, GBufferImport& import)
{
	return {
		addChoice(app, "--depth", import.depth,
				  "What the depth channel holds: metres along the view direction (default), metres from the eye, or a depth "
				  "buffer's 0 to 1, whose far end is sky"),
		addChoice(app, "--clip", import.clip,
				  "z after the projection that a depth buffer's 0 to 1 stand for (default: minus-one-to-one, as in OpenGL)"),
		addNumber(app, "--sky-depth", import.sky_depth_m, 1e-6, 1e30, "Depths from here on, in metres, are sky (default: 1e10)"),
		addText(app, "--depth-channel", import.depth_channel, "NAME", "Depth channel (default: Z, or the one called depth)"),
		addText(app, "--normal-channels", import.normal_channels, "NAME",
				"What stands before .X, .Y, .Z of the normals (default: N, or the one called normal)"),
		addChoice(app, "--normal-space", import.normal_space, "Space of the file's normals (default: view)"),
		addChoice(app, "--normal-range", import.normal_range,
				  "Values of the file's normals (default: plus-minus-one); zero-to-one as 8-bit buffers hold them")};
}

void addGBufferImport(CLI::App& app, GBufferImport& import)
{
	addGBufferChannels(app, import);
	addChoiceText(
		app, "--normals", kNormalSources, [&import](std::size_t i) { import.normals_from_depth = i == 1; },
		"Normals of the file (default), or from the depth of five pixels");
	app.add_option_function<std::string>(
		   "--viewport", [&import](const std::string& text) { import.viewport = viewportOf(text); },
		   "Only this rectangle of the file, in pixels from its upper left corner; the projection is the rectangle's")
		->type_name("X,Y,W,H");
	addMatrix(app, "--projection", import.projection,
			  "View to clip space, column by column (default: the file's attribute projection)");
	addMatrix(app, "--world-to-camera", import.camera_from_world,
			  "World to view space, in metres, column by column (default: the file's attribute worldToCamera)");
}

void checkGBufferImport(const GBufferImport& import)
{
	if (import.clip != ClipRange::minus_one_to_one && import.depth != DepthKind::device)
	{
		throw Error(ExitCode::usage, "--clip: only a depth buffer has a clip range, expected --depth device as well");
	}
	if (import.normals_from_depth && (!import.normal_channels.empty() || import.normal_space != NormalSpace::view ||
									  import.normal_range != NormalRange::plus_minus_one))
	{
		throw Error(ExitCode::usage, "--normals from-depth: the file's normals are not read, expected no option about them");
	}
}

} // namespace nook
