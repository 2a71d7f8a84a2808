// SPDX-License-Identifier: GPL-3.0-or-later
// nook report live: a level → a page that makes patterns and shades that level in a browser.
#include "camera_options.h"
#include "level_options.h"
#include "report_verbs.h"
#include "summary.h"

#include "core/error.h"
#include "core/file.h"
#include "core/system.h"
#include "live_report/live_report.h"
#include "version.h"

#include <array>
#include <filesystem>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 1> kLivePages{".html"};

struct LiveOptions
{
	LiveReportSettings settings;
	CameraOptions camera;
	Outputs outputs;
	int threads = 0;
};

// The first of the folders, from where this program is, that has the file; empty: none has.
std::string folderWith(std::initializer_list<const char*> folders, const char* file)
{
	std::error_code none;
	const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", none).parent_path();
	for (const char* const folder : folders)
	{
		const std::filesystem::path path = (here / folder).lexically_normal();
		if (!here.empty() && std::filesystem::exists(path / file, none))
		{
			return path.string();
		}
	}
	return {};
}

void needFile(const std::string& folder, const char* file, const std::string& option, const std::string& expected)
{
	std::error_code none;
	if (folder.empty() || !std::filesystem::exists(nativePath(folder) / file, none))
	{
		throw Error(ExitCode::file,
					option + ": found no " + file + (folder.empty() ? "" : " in " + folder) + ", expected " + expected);
	}
}

// Where the two folders are that the build or the installation has.
void findFolders(LiveReportSettings& settings)
{
	if (settings.package.empty())
	{
		settings.package = folderWith({"../../wasm/npm"}, "nook.wasm");
	}
	needFile(
		settings.package, "nook.wasm", "--npm",
		"the npm package nook-patterns, of 'cmake --preset wasm && cmake --build --preset wasm' or node_modules/nook-patterns");
	if (settings.catalogue.empty())
	{
		settings.catalogue = folderWith({"../share/nook/patterns", "../../../patterns"}, "disk/disk_009.json");
	}
	needFile(settings.catalogue, "disk/disk_009.json", "--catalogue", "nook's catalogue, patterns/ of its sources");
}

void run(LiveOptions& options, VerbProgress& progress)
{
	LiveReportSettings& settings = options.settings;
	settings.version = NOOK_VERSION;
	if (options.camera.automatic > 1)
	{
		refuseValue("--camera", "auto:" + std::to_string(options.camera.automatic), "a name, or auto:1: the page has one view");
	}
	settings.automatic = options.camera.automatic == 1;
	settings.camera = settings.automatic ? "" : options.camera.camera;
	settings.width_px = options.camera.width_px;
	settings.height_px = options.camera.height_px;
	checkOutputs(options.outputs, kLivePages, {settings.level});
	findFolders(settings);
	const LivePage page = liveReport(settings, progress.start("report live", options.threads, options.outputs.progress));
	checkRead(options.outputs, page.read);
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		files.add(path, page.html);
	}
	Summary summary("report live");
	summary.text("command", commandOf(settings));
	summary.text("level", settings.level);
	summary.whole("width_px", static_cast<std::size_t>(settings.width_px));
	summary.whole("height_px", static_cast<std::size_t>(settings.height_px));
	summary.whole("bytes", page.html.size());
	addSide(files, options.outputs, summary.json(), page.read);
	files.commit();
}

} // namespace

Verb addReportLive(CLI::App& report)
{
	const auto options = std::make_shared<LiveOptions>();
	LiveReportSettings& settings = options->settings;
	CLI::App* const app =
		report.add_subcommand("live", "A page that makes patterns, and shades a level with them, in the browser that shows it");
	app->add_option("LEVEL", settings.level, "A level (.gltf .glb .obj .fbx .ply .stl), or builtin:NAME (default builtin:suburb)")
		->type_name("LEVEL");
	addLoadOptions(*app, settings.load);
	addCameraChoice(*app, options->camera);
	options->camera.width_px = settings.width_px;
	options->camera.height_px = settings.height_px;
	addPictureSize(*app, options->camera, "640x360");
	addNumber(
		*app, "--radius", settings.radius_m, 1e-6, 1e6,
		"Radius of the reference's rays in metres, of which the methods' radii are parts (default: by the level's size, at most "
		"0.75)");
	addWhole(*app, "--rays", settings.rays, 1, 16384, "Rays a pixel of the reference (default 256)");
	addText(
		*app, "--npm", settings.package, "FOLDER",
		"The npm package nook-patterns of this version, whose program the page holds (default: that of the preset wasm beside this "
		"build)");
	addText(
		*app, "--catalogue", settings.catalogue, "FOLDER",
		"nook's catalogue, whose measures the page shows beside those of a pattern (default: the one of the installation or of the "
		"sources)");
	addOutputs(*app, options->outputs, kLivePages);
	addThreads(*app, options->threads);
	addProgress(*app, options->outputs.progress);
	return {app, [options](VerbProgress& progress)
			{
				run(*options, progress);
			}};
}

} // namespace nook
