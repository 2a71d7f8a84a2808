// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene_options.h"
#include "methods/aov_text.h"

#include "core/decimal.h"
#include "core/image.h"
#include "core/lists.h"

#include <cmath>
#include <limits>

namespace nook
{

// Names as on the command line, in the order of the enumerators.
template <> inline constexpr std::array<std::string_view, 3> kNamesOf<DepthKind>{"linear", "distance", "device"};
template <> inline constexpr std::array<std::string_view, 2> kNamesOf<ClipRange>{"minus-one-to-one", "zero-to-one"};
template <> inline constexpr std::array<std::string_view, 2> kNamesOf<NormalSpace>{"view", "world"};
template <> inline constexpr std::array<std::string_view, 2> kNamesOf<NormalRange>{"plus-minus-one", "zero-to-one"};
namespace
{

// Names of UpAxis, in its order without `file`.
constexpr std::array<std::string_view, 3> kUpAxes{"x", "y", "z"};

// Names of Pose, in its order.
constexpr std::array<std::string_view, 2> kPoses{"file", "rest"};

// Names of TrMeaning, in its order.
constexpr std::array<std::string_view, 3> kTrMeanings{"auto", "transparency", "opacity"};

constexpr std::array<std::string_view, 2> kNormalSources{"file", "from-depth"};
constexpr int kMaxSide = 32768;
constexpr int kMaxAutomatic = 64;
constexpr std::string_view kAutoViews = "auto:";

// So many numbers, or nothing.
template <class Number, std::size_t count>
std::optional<std::array<Number, count>> numbersOf(const std::string& text, double least, double most, char between = ',')
{
	const std::vector<std::string> parts = partsOf(text, between);
	std::array<Number, count> numbers{};
	bool good = parts.size() == count;
	for (std::size_t i = 0; good && i < count; ++i)
	{
		const std::optional<Number> number = numberFrom<Number>(parts[i]);
		good = number && *number >= least && *number <= most;
		numbers[i] = number.value_or(Number{});
	}
	return good ? std::optional(numbers) : std::nullopt;
}

std::array<int, 4> viewportOf(const std::string& name, const std::string& text)
{
	const std::optional<std::array<int, 4>> viewport = numbersOf<int, 4>(text, 0, std::numeric_limits<int>::max());
	refuseValueIf(!viewport || (*viewport)[2] < 1 || (*viewport)[3] < 1, name, text, "X,Y,W,H in whole pixels, as in 0,0,640,360");
	return *viewport;
}

void takeCamera(const std::string& name, const std::string& text, CameraOptions& options)
{
	refuseValueIf(text.empty() || text[0] == '-', name, text, "NAME or auto:K");
	options.camera = text;
	options.automatic = 0;
	if (text.starts_with(kAutoViews))
	{
		const std::optional<int> count = numberFrom<int>(std::string_view(text).substr(kAutoViews.size()));
		refuseValueIf(!count || *count < 1 || *count > kMaxAutomatic, name, text,
					  "auto:K with K from 1 to " + std::to_string(kMaxAutomatic));
		options.automatic = *count;
	}
}

} // namespace

glm::dvec3 positionOf(const std::string& option, const std::string& text)
{
	const std::optional<std::array<double, 3>> numbers = numbersOf<double, 3>(text, -kFarthest_m, kFarthest_m);
	refuseValueIf(!numbers, option, text, "X,Y,Z: three numbers, each from -1e15 to 1e15");
	return {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
}

glm::ivec2 sizeOf(const std::string& option, const std::string& text)
{
	const std::optional<std::array<int, 2>> size = numbersOf<int, 2>(text, 1, kMaxSide, 'x');
	// A G-buffer has four channels.
	refuseValueIf(
		!size || static_cast<std::size_t>((*size)[0]) * static_cast<std::size_t>((*size)[1]) > kMaxImageValues / 4, option, text,
		"WxH, each from 1 to " + std::to_string(kMaxSide) + ", at most " + std::to_string(kMaxImageValues / 4) + " pixels");
	return {(*size)[0], (*size)[1]};
}

namespace
{

Bounds boxFrom(const std::string& option, const std::string& text, const std::string& expected)
{
	const std::optional<std::array<double, 6>> numbers = numbersOf<double, 6>(text, -kFarthest_m, kFarthest_m);
	refuseValueIf(!numbers || (*numbers)[0] > (*numbers)[3] || (*numbers)[1] > (*numbers)[4] || (*numbers)[2] > (*numbers)[5],
				  option, text, expected);
	return {{(*numbers)[0], (*numbers)[1], (*numbers)[2]}, {(*numbers)[3], (*numbers)[4], (*numbers)[5]}};
}

const std::string kSixNumbers = "six numbers X,Y,Z,X,Y,Z, the least corner of a box first, metres";

} // namespace

Bounds boxOf(const std::string& option, const std::string& text)
{
	return boxFrom(option, text, kSixNumbers);
}

std::optional<Bounds> cameraBoxOf(const std::string& option, const std::string& text)
{
	return text == "outside" ? std::nullopt : std::optional(boxFrom(option, text, kSixNumbers + ", or outside"));
}

OptionRow partsRow(const std::string& name, std::vector<std::string>& patterns, const std::string& help, OptionRules rules)
{
	const auto take = [&patterns](const std::string& option, const std::string& text)
	{
		const std::vector<std::string> parts = partsOf(text);
		refuseValueIf(parts.empty() || std::find(parts.begin(), parts.end(), "") != parts.end(), option, text,
					  "patterns of parts, commas between them: Lamp*,material:Glass");
		append(patterns, parts);
	};
	return {name, takesEach("PARTS", take), help, std::move(rules)};
}

void addLoadOptions(CLI::App& app, LoadSettings& load)
{
	addOptions(
		app, {{"--unit", takesNumber(load.unit_m, 1e-9, 1e9),
			   "Metres of one unit of the level's file (default: glTF 1, FBX its own, others 1)"},
			  {"--up", takesIndex(kUpAxes, [&load](std::size_t i) { load.up = static_cast<UpAxis>(i + 1); }),
			   "Axis of the level's file that points up (default: FBX its own, others y)"},
			  {"--strict", takesFlag(load.strict), "Anything odd that is found in the level is an error (exit code 3)"},
			  {"--max-texels", takesWhole(load.max_texels, 1, kMostTexels),
			   "Texels that a picture which acts as a mask may have (default " + std::to_string(kMaxTexels) + ")"},
			  {"--allow-outside", takesFlag(load.allow_outside),
			   "Files that the level names may lie outside its folder and those below it"},
			  {"--pose", takesChoice(kPoses, load.pose),
			   "Skinned and morphed meshes as the level's file shows them, or in their rest pose (default: file)"},
			  {"--tr", takesChoice(kTrMeanings, load.tr),
			   "Meaning of Tr in the level's MTL files, where there is no d (default: auto, transparency but that 1 is opaque)"}});
	addOptions(app, {partsRow("--ignore", load.ignore,
							  "Parts to leave out, by name (Lamp*), path (/Room/**/Lamp), material:NAME or extras:KEY=VALUE; "
							  "commas between several")});
}

void addLevelOptions(CLI::App& app, LevelOptions& options)
{
	addOptions(app, {{"LEVEL", takesText(options.level, "LEVEL"), kLevelHelp, kRequired}});
	addLoadOptions(app, options.load);
}

OptionRow cameraRow(CameraOptions& options)
{
	return {"--camera",
			takesParsed("NAME|auto:K",
						[&options](const std::string& name, const std::string& text) { takeCamera(name, text, options); }),
			"A camera of the level by name (default: its first, or auto:1 where it has none), or auto:K: the K most informative "
			"views, the same ones each time; for K > 1 the names of outputs get -1, -2, ... before their ending"};
}

OptionRow sizeRow(int& width_px, int& height_px)
{
	return {"--size",
			takesParsed("WxH",
						[&width_px, &height_px](const std::string& name, const std::string& text)
						{
							const glm::ivec2 size = sizeOf(name, text);
							width_px = size.x;
							height_px = size.y;
						}),
			"Width and height of the picture in pixels (default " + std::to_string(width_px) + "x" + std::to_string(height_px) +
				")"};
}

void addCameraOptions(CLI::App& app, CameraOptions& options)
{
	addOptions(app,
			   {cameraRow(options),
				{"--eye",
				 takesParsed("X,Y,Z", options.eye, positionOf),
				 "Where the camera stands, in the level's metres; needs --target",
				 {.excludes = {{"--camera"}}, .needs = {{"--target"}}}},
				{"--target", takesParsed("X,Y,Z", options.target, positionOf), "What the camera looks at; +y is up in the picture",
				 needs("--eye")},
				{"--fov", takesNumber(options.fov_y_deg, 0.01, 179.0),
				 "Whole vertical angle of view in degrees (default: the camera's own; 60 with --eye or --world-to-camera)"},
				{"--near", takesNumber(options.near_m, 1e-6, 1e6),
				 "Near plane of the projection in metres (default: the camera's own, else 0.1); rays are not cut by it"},
				{"--projection", takesMatrix(options.projection),
				 "A projection of any kind instead of the camera's: OpenGL's x and y, any depth (reversed, infinite, orthographic, "
				 "off-centre); 16 numbers, column by column",
				 excludes("--fov or --near")},
				{"--world-to-camera", takesMatrix(options.camera_from_world),
				 "Where the camera stands, as a rotation and translation: 16 numbers, column by column; it looks down its -z",
				 excludes("--camera or --eye")},
				sizeRow(options.width_px, options.height_px),
				{"--allow-inside", takesFlag(options.allow_inside),
				 "Accept a camera inside something solid, for levels whose faces are turned round"}});
}

void addGBufferChannels(CLI::App& app, GBufferImport& import)
{
	addOptions(
		app,
		{{"--depth", takesChoice(namesOf<DepthKind>(), import.depth),
		  "What the depth channel holds: metres along the view direction (default), metres from the eye, or a depth buffer's 0 to "
		  "1, whose far end is sky"},
		 {"--clip", takesChoice(namesOf<ClipRange>(), import.clip),
		  "z after the projection that a depth buffer's 0 to 1 stand for (default: minus-one-to-one, as in OpenGL)",
		  needs("--depth device")},
		 {"--sky-depth", takesNumber(import.sky_depth_m, 1e-6, 1e30), "Depths from here on, in metres, are sky (default: 1e10)"},
		 {"--depth-channel", takesText(import.depth_channel, "NAME"), "Depth channel (default: Z, or the one called depth)"},
		 {"--normal-channels", takesText(import.normal_channels, "NAME"),
		  "What stands before .X, .Y, .Z of the normals (default: N, or the one called normal)"},
		 {"--normal-space", takesChoice(namesOf<NormalSpace>(), import.normal_space),
		  "Space of the file's normals (default: view)"},
		 {"--normal-range", takesChoice(namesOf<NormalRange>(), import.normal_range),
		  "Values of the file's normals (default: plus-minus-one); zero-to-one as 8-bit buffers hold them"}});
}

void addGBufferImport(CLI::App& app, GBufferImport& import)
{
	addGBufferChannels(app, import);
	addOptions(app, {{"--normals", takesChoice(kNormalSources, import.normals_from_depth),
					  "Normals of the file (default), or from the depth of five pixels"},
					 {"--viewport", takesParsed("X,Y,W,H", import.viewport, viewportOf),
					  "Only this rectangle of the file, in pixels from its upper left corner; the projection is the rectangle's"},
					 {"--projection", takesMatrix(import.projection),
					  "View to clip space, column by column (default: the file's attribute projection)"},
					 {"--world-to-camera", takesMatrix(import.camera_from_world),
					  "World to view space, in metres, column by column (default: the file's attribute worldToCamera)"}});
}

void checkGBufferImport(const GBufferImport& import)
{
	refuseIf(import.normals_from_depth && (!import.normal_channels.empty() || import.normal_space != NormalSpace::view ||
										   import.normal_range != NormalRange::plus_minus_one),
			 "--normals from-depth: the file's normals are not read, expected no option about them");
}

OptionRow falloffUnitRow(std::optional<double>& unit_m)
{
	return {"--falloff-u", takesNumber(unit_m, 1e-9, 1e9), "u of --falloff alchemy, metres (default: a tenth of the radius)",
			needs("--falloff alchemy", "both or none")};
}

double falloffUnit(const std::optional<double>& unit_m, double radius_m, Falloff falloff)
{
	refuseValueIf(std::isfinite(radius_m) && radius_m > 1e9, "--radius", numberText(radius_m),
				  "metres from 0.000001 to 1000000000, or inf");
	refuseIf(!unit_m && falloff == Falloff::alchemy && std::isinf(radius_m),
			 "--falloff-u: found none, expected metres, since the radius is without end");
	return unit_m.value_or(0.1 * radius_m);
}

void addLevelFacts(Facts& facts, const LoadedLevel& loaded)
{
	facts.text("level", loaded.level.name);
	facts.whole("triangles", loaded.level.triangles.size());
	facts.texts("findings", mapped(loaded.diagnosis.findings,
								   [](const Finding& finding) { return finding.id + " " + std::to_string(finding.count); }));
}

OptionRow featureOption(const FeatureRow& row, ShadeSettings& settings, const std::string& more, OptionRules rules)
{
	const auto add = [&row, &settings](CLI::App& app, const std::string& name, const std::string& help) -> CLI::Option*
	{
		const auto set = [&row, &settings](auto value)
		{
			row.value.set(settings, static_cast<double>(value));
		};
		switch (row.kind)
		{
		case FeatureKind::flag:
			return app.add_flag_function(
				name, [set](std::int64_t count) { set(count > 0 ? 1 : 0); }, help);
		case FeatureKind::whole:
			return takesWholeBy(set, static_cast<uint64_t>(row.least), static_cast<uint64_t>(row.most))(app, name, help);
		case FeatureKind::number: return takesNumberBy(set, row.least, row.most)(app, name, help);
		case FeatureKind::choice: break;
		}
		return takesIndex(row.choices, set)(app, name, help);
	};
	return {std::string(row.option), add, std::string(row.help) + more, std::move(rules)};
}

std::vector<OptionRow> featureOptions(unsigned place, const std::function<bool(const FeatureRow&)>& fits, ShadeSettings& settings,
									  const OptionRules& rules)
{
	std::vector<OptionRow> options;
	for (const FeatureRow& row : featureTable())
	{
		if ((row.places & place) != 0 && fits(row))
		{
			const bool shade = place == kInShade;
			std::string more;
			more += shade && !row.needs.empty() ? "; needs " + std::string(row.needs) : "";
			more += !shade && !row.setting.empty() ? "; nook_settings." + std::string(row.setting) : "";
			options.push_back(featureOption(row, settings, more, rules));
		}
	}
	return options;
}

GivenFeatures givenFeatures(const CLI::App& app, unsigned place)
{
	GivenFeatures given;
	for (const FeatureRow& row : featureTable())
	{
		const CLI::Option* const option = app.get_option_no_throw(std::string(row.option));
		if ((row.places & place) != 0 && option != nullptr && option->count() > 0)
		{
			given.push_back(&row);
		}
	}
	return given;
}

std::string featuresText(const CLI::App& app, const GivenFeatures& features)
{
	std::string text;
	for (const FeatureRow* const row : features)
	{
		const std::string option(row->option);
		text += " " + option + (row->kind == FeatureKind::flag ? "" : " " + app.get_option(option)->results().front());
	}
	return text;
}

OptionRow recipeRow(std::string& name, OptionRules rules)
{
	return {
		"--recipe", takesText(name, "paper|rays|FILE.json"),
		"rays (default): --radius is the reach of rays with linear falloff, and radii, thickness, strength and power are fitted to "
		"them; paper: the method as published, --radius its own; or a file of nook fit. Options that are given count more",
		std::move(rules)};
}

std::string volumeMethods(const std::string& between)
{
	return methodNames([](const MethodRow& row) { return row.kind == MethodKind::volumes; }, between);
}

std::string sumMethod()
{
	return std::string(volumeRow(false).name);
}

std::string maskMethod()
{
	return std::string(volumeRow(true).name);
}

OptionRow directionsRow(int& directions, OptionRules rules)
{
	const auto take = [&directions](uint64_t number)
	{
		refuseValueIf(number % 32 != 0, "--directions", std::to_string(number), "a multiple of 32");
		directions = static_cast<int>(number);
	};
	return {"--directions", takesWholeBy(take, kLeastDirections, kMostDirections),
			maskMethod() + ": directions of a pixel's mask, a multiple of 32 (default 128)", std::move(rules)};
}

} // namespace nook
