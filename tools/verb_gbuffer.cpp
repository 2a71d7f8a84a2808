// SPDX-License-Identifier: GPL-3.0-or-later
// nook gbuffer: a level and a camera, or a G-buffer of an engine → depth and normals.
#include "call.h"
#include "scene_options.h"

#include "core/system.h"
#include "scene/tracer.h"
#include "version.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kGBufferFormats{".exr"};
constexpr std::array<std::string_view, 3> kNormalKinds{"geometric", "interpolated", "from-depth"};

// Beside kLoadOptions, those that make sense for a level only.
constexpr std::array<std::string_view, 7> kCameraOptions{"--camera", "--eye",  "--target",      "--fov",
														 "--near",   "--size", "--allow-inside"};

struct GBufferOptions
{
	const CLI::App* app = nullptr;
	LevelOptions level;
	CameraOptions camera;
	GBufferImport import;
	std::optional<NormalKind> normals;
	Outputs outputs;
};

void declare(CLI::App& app, GBufferOptions& options)
{
	addOptions(app, {{"LEVEL", takesText(options.level.level, "LEVEL"),
					  "A level (.gltf .glb .obj .fbx .ply .stl), builtin:NAME, or a G-buffer of an engine (.exr)", kRequired}});
	addLoadOptions(app, options.level.load);
	addCameraOptions(app, options.camera);
	addGBufferChannels(app, options.import);
	addOptions(app, {{"--normals", takesChoice(kNormalKinds, options.normals),
					  "Normals of the triangles (default), interpolated between their vertices, or found from the depth alone"}});
	addOutputs(app, options.outputs, kGBufferFormats);
	addRun(app, options.outputs);
	options.app = &app;
}

Notes notesOf(const std::string& level, const std::string& camera, std::string_view normals)
{
	return {
		{"Software", "nook " NOOK_VERSION}, {"nook:level", level}, {"nook:camera", camera}, {"nook:normals", std::string(normals)}};
}

// Sizes and sky of all pictures of one run.
struct PictureFacts
{
	int width_px = 0;
	int height_px = 0;
	std::size_t pixels = 0;
	std::size_t sky = 0;

	void add(const GBuffer& gbuffer)
	{
		width_px = gbuffer.width_px;
		height_px = gbuffer.height_px;
		pixels += gbuffer.depth.size();
		sky += static_cast<std::size_t>(
			std::count_if(gbuffer.depth.begin(), gbuffer.depth.end(), [](float depth_m) { return std::isinf(depth_m); }));
	}
	void addTo(Facts& facts) const
	{
		facts.whole("width_px", width_px);
		facts.whole("height_px", height_px);
		facts.number("sky_share", static_cast<double>(sky) / static_cast<double>(pixels));
	}
};

void givePixels(const GBuffer& gbuffer)
{
	const auto height = static_cast<std::size_t>(gbuffer.height_px);
	const auto width = static_cast<std::size_t>(gbuffer.width_px);
	give<float>("depth", gbuffer.depth, {height, width});
	give<float>("normals", gbuffer.normals, {height, width, 3});
	give<double>("projection", std::vector{gbuffer.view.projection}, {16});
	give<double>("world_to_camera", std::vector{gbuffer.view.camera_from_world}, {16});
}

// From what an engine wrote to what every verb reads without options.
void convert(const GBufferOptions& options, VerbProgress& progress)
{
	const std::string file = "with '" + options.level.level + "', expected a level";
	refuseGiven(*options.app, kLoadOptions, file);
	refuseGiven(*options.app, kCameraOptions, file);
	GBufferImport import = options.import;
	import.projection = options.camera.projection;
	import.camera_from_world = options.camera.camera_from_world;
	import.normals_from_depth = options.normals == NormalKind::from_depth;
	if (options.normals && !import.normals_from_depth)
	{
		refuseValue("--normals", std::string(kNormalKinds[static_cast<std::size_t>(*options.normals)]),
					"from-depth, or none for those of the file");
	}
	checkGBufferImport(import);
	checkOutputs(options.outputs, kGBufferFormats, {options.level.level});
	progress.start("gbuffer", options.outputs.threads, options.outputs.progress);
	const GBuffer gbuffer = readGBuffer(options.level.level, import);
	const std::string name = nativePath(options.level.level).filename().string();
	const Notes notes = notesOf(name, "given", import.normals_from_depth ? "from-depth" : "given");
	Facts facts = verbFacts("gbuffer");
	facts.text("gbuffer", name);
	PictureFacts picture;
	picture.add(gbuffer);
	picture.addTo(facts);
	writeOutputs(options.outputs, [&](const std::string&) { return gbufferBytes(gbuffer, notes); }, facts.json(),
				 {options.level.level});
}

void cast(const GBufferOptions& options, VerbProgress& progress)
{
	refuseGiven(*options.app, kChannelOptions, "with '" + options.level.level + "', expected a G-buffer (.exr)");
	checkCameras(options.camera);
	const auto count = static_cast<std::size_t>(pictureCount(options.camera));
	const Outputs outputs =
		expanded(options.outputs, [count](const std::string& file) { return pictureFiles(file, static_cast<int>(count)); });
	checkOutputs(outputs, kGBufferFormats, {options.level.level});
	const RunSettings settings = progress.start("gbuffer", options.outputs.threads, options.outputs.progress);
	const std::shared_ptr<const LoadedLevel> shared = levelOf(options.level.level, options.level.load, settings);
	const LoadedLevel& loaded = *shared;
	checkRead(outputs, loaded.level.files);
	const Tracer tracer(loaded.level, settings);
	const NormalKind normals = options.normals.value_or(NormalKind::geometric);

	OutputSet files;
	std::vector<std::string> cameras;
	std::size_t from_outside = 0;
	PictureFacts pictures;
	for (const NamedView& view : viewsOf(options.camera, tracer, settings))
	{
		const GBuffer gbuffer =
			castGBuffer(tracer, view.view, options.camera.width_px, options.camera.height_px, normals, settings);
		pictures.add(gbuffer);
		givePixels(gbuffer);
		const Notes notes = notesOf(loaded.level.name, view.name, kNormalKinds[static_cast<std::size_t>(normals)]);
		const std::string bytes = outputs.files.empty() ? "" : gbufferBytes(gbuffer, notes);
		for (std::size_t file = cameras.size(); file < outputs.files.size(); file += count)
		{
			files.add(outputs.files[file], bytes);
		}
		cameras.push_back(view.name);
		from_outside += view.from_outside ? 1U : 0U;
	}
	Facts facts = verbFacts("gbuffer");
	addLevelFacts(facts, loaded);
	facts.texts("cameras", cameras);
	facts.whole("views_from_outside", from_outside);
	pictures.addTo(facts);
	addSide(files, outputs, facts.json(), loaded.level.files);
	files.commit();
}

void run(GBufferOptions& options, VerbProgress& progress)
{
	if (options.level.level.ends_with(".exr"))
	{
		convert(options, progress);
	}
	else
	{
		cast(options, progress);
	}
}

} // namespace

Verb addGBufferVerb(CLI::App& nook)
{
	return addVerb<GBufferOptions>(nook, "gbuffer", "Casts rays from a camera: depth and normals as OpenEXR", declare, run);
}

} // namespace nook
