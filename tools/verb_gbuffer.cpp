// SPDX-License-Identifier: GPL-3.0-or-later
// nook gbuffer: a level and a camera → depth and normals.
#include "camera_options.h"
#include "level_options.h"
#include "options.h"
#include "scene_summary.h"
#include "summary.h"

#include "core/error.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "scene/tracer.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kFormats{".exr"};
constexpr std::array<std::string_view, 3> kNormalKinds{"geometric", "interpolated", "from-depth"};

struct GBufferOptions
{
	LevelOptions level;
	CameraOptions camera;
	NormalKind normals = NormalKind::geometric;
	Outputs outputs;
	int threads = 0;
};

void declare(CLI::App& app, GBufferOptions& options)
{
	addLevelOptions(app, options.level);
	addCameraOptions(app, options.camera);
	addChoiceText(
		app, "--normals", kNormalKinds, [&options](std::size_t i) { options.normals = static_cast<NormalKind>(i); },
		"Normals of the triangles (default), interpolated between their vertices, or found from the depth alone");
	addOutputs(app, options.outputs, kFormats);
	addThreads(app, options.threads);
}

void run(const GBufferOptions& options)
{
	checkCameraOptions(options.camera);
	const int count = pictureCount(options.camera);
	Outputs outputs = options.outputs;
	outputs.files.clear();
	for (const std::string& file : options.outputs.files)
	{
		const std::vector<std::string> files = pictureFiles(file, count);
		outputs.files.insert(outputs.files.end(), files.begin(), files.end());
	}
	checkOutputs(outputs, kFormats, {options.level.level});
	const RunSettings settings = runSettings(options.threads);
	const LoadedLevel loaded = loadLevel(options.level.level, options.level.load, settings);
	const Tracer tracer(loaded.level, settings);
	const std::vector<NamedView> views = viewsOf(options.camera, tracer, settings);

	OutputSet files;
	Summary summary("gbuffer");
	addLevelFacts(summary, loaded);
	std::vector<std::string> cameras;
	std::size_t sky = 0;
	std::size_t pixels = 0;
	for (std::size_t i = 0; i < views.size(); ++i)
	{
		const GBuffer gbuffer =
			castGBuffer(tracer, views[i].view, options.camera.width_px, options.camera.height_px, options.normals, settings);
		const Notes notes{{"Software", "nook " NOOK_VERSION},
						  {"nook:level", loaded.level.name},
						  {"nook:camera", views[i].name},
						  {"nook:normals", std::string(kNormalKinds[static_cast<std::size_t>(options.normals)])}};
		const std::string bytes = gbufferBytes(gbuffer, notes);
		for (std::size_t file = i; file < outputs.files.size(); file += views.size())
		{
			files.add(outputs.files[file], bytes);
		}
		cameras.push_back(views[i].name);
		sky += static_cast<std::size_t>(
			std::count_if(gbuffer.depth.begin(), gbuffer.depth.end(), [](float d) { return std::isinf(d); }));
		pixels += gbuffer.depth.size();
	}
	summary.texts("cameras", cameras);
	summary.whole("width_px", static_cast<std::size_t>(options.camera.width_px));
	summary.whole("height_px", static_cast<std::size_t>(options.camera.height_px));
	summary.number("sky_share", static_cast<double>(sky) / static_cast<double>(pixels));
	addSide(files, outputs, summary.json(), loaded.level.files);
	files.commit();
}

} // namespace

Verb addGBufferVerb(CLI::App& nook)
{
	const auto options = std::make_shared<GBufferOptions>();
	CLI::App* const app = nook.add_subcommand("gbuffer", "Casts rays from a camera: depth and normals as OpenEXR");
	declare(*app, *options);
	return {app, [options]
			{
				run(*options);
			}};
}

} // namespace nook
