// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume_options.h"

#include "memory_option.h"
#include "place_options.h"

#include "core/error.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::array<std::string_view, 2> kCurveMeasures{"eq14", "rmse"};          // of CurveMeasure, in its order
constexpr std::array<std::string_view, 3> kSides{"auto", "oriented", "two-sided"}; // of Sides, in its order

bool read(std::string_view text, double& value)
{
	const char* const end = text.data() + text.size();
	const std::from_chars_result result = std::from_chars(text.data(), end, value);
	return result.ec == std::errc{} && result.ptr == end && std::isfinite(value);
}

// "1/512" or "0.002".
void takeShare(const std::string& option, const std::string& text, double& share, bool whole_too = true)
{
	const std::size_t slash = text.find('/');
	double whole = 1.0;
	const bool good = read(std::string_view(text).substr(0, slash), share) &&
					  (slash == std::string::npos || read(std::string_view(text).substr(slash + 1), whole)) && whole > 0.0;
	share /= whole;
	if (!good || !(share > 0.0 && (share < 1.0 || (whole_too && share <= 1.0))))
	{
		refuseValue(option, text, std::string("a share above 0, ") + (whole_too ? "at most" : "below") + " 1: 0.002 or 1/512");
	}
}

// "2", or "none" as 0.
void takeExtent(const std::string& option, const std::string& text, OccluderSettings& settings)
{
	double& extent = settings.extent;
	settings.extent_always = true;
	if (text == "none")
	{
		extent = 0.0;
		return;
	}
	if (!read(text, extent) || !(extent >= 0.1 && extent <= 1e6))
	{
		refuseValue(option, text, "0.1 or more, at most 1e6, or none");
	}
}

// "0.02", "auto", "auto:0.1".
void takeDetail(const std::string& option, const std::string& text, VolumeSettings& settings)
{
	constexpr std::string_view kAuto = "auto";
	if (!text.starts_with(kAuto))
	{
		takeShare(option, text, settings.occluders.detail, false);
		return;
	}
	double& more = settings.detail_more.emplace(DetailSettings{}.more);
	if (text != kAuto)
	{
		takeShare(option, text.substr(0, kAuto.size() + 1) == "auto:" ? text.substr(kAuto.size() + 1) : text, more);
	}
}

void takeFlat(const std::string& option, const std::string& text, double& flat)
{
	if (!read(text, flat) || !(flat >= 1e-6 && flat <= 0.05))
	{
		refuseValue(option, text, "a share from 1e-6 to 0.05");
	}
}

void addOccluderOptions(CLI::App& app, VolumeOptions& options)
{
	VolumeSettings& settings = options.settings;
	addChoiceText(
		app, "--sides", kSides, [&settings](std::size_t i) { settings.occluders.sides = static_cast<Sides>(i); },
		"Which sides of a polygon darken: the front of closed opaque surfaces and both of all others (auto, default), the front "
		"alone, or both");
	app.add_flag_callback(
		"--no-merge", [&settings] { settings.occluders.merge = false; },
		"A polygon for each triangle; else neighbours in one plane become one, or a few that are convex");
	app.add_option_function<std::string>(
		   "--flat",
		   [&settings, &options](const std::string& text)
		   {
			   takeFlat("--flat", text, settings.occluders.flat);
			   options.flat_given = true;
		   },
		   "How far off their plane merged neighbours may lie, as a share of the distance, 1e-6 to 0.05 (default 1e-4; what is "
		   "two-sided at most 5e-5)")
		->type_name("SHARE");
	app.add_option_function<std::string>(
		   "--extent", [&settings](const std::string& text) { takeExtent("--extent", text, settings.occluders); },
		   "Cuts merged polygons in halves until they are at most this many times the distance long, 0.1 or more, or none "
		   "(default 2, or twice, four times … that where a quarter more polygons would not do): smaller ones fall off sideways, "
		   "which is nearer to what rays give")
		->type_name("X");
	app.add_option_function<std::string>(
		   "--detail", [&settings](const std::string& text) { takeDetail("--detail", text, settings); },
		   "Simplifies one-sided surfaces first, moving them by about this share at most of the distance, below 1; auto: as far as "
		   "errors at sampled points grow by a twentieth at most, auto:SHARE: by that share (default: not)")
		->type_name("SHARE");
}

void addDropOptions(CLI::App& app, VolumeOptions& options)
{
	DropSettings& drop = options.settings.drop;
	app.add_flag("--no-drop", options.no_drop, "All volumes: the three --keep options in one");
	app.add_flag_callback(
		"--keep-unlit", [&drop] { drop.no_receiver = false; },
		"Also volumes that darken nothing: no surface within them sees their polygon");
	app.add_flag_callback(
		"--keep-sides", [&drop] { drop.sides = false; }, "Also the sides of two-sided polygons that darken nothing");
	app.add_flag_callback(
		"--keep-inside", [&drop] { drop.inside = false; }, "Also what lies inside solids, where no camera comes");
	app.add_flag_callback(
		"--drop-hidden", [&drop] { drop.hidden = true; },
		"Drops sides that see none of the surfaces that they darken, which are behind something opaque (sampled; minutes for "
		"some 200,000 polygons)");
	app.add_option_function<std::string>(
		   "--hidden-loss",
		   [&options](const std::string& text)
		   {
			   double& bound = options.settings.drop.hidden_bound;
			   bound = 0.0;
			   if (text != "0")
			   {
				   takeShare("--hidden-loss", text, bound, false);
			   }
			   options.hidden_loss_given = true;
		   },
		   "Of occlusion: what a sampled point may lose by --drop-hidden before there is a warning, and with --strict exit code 7 "
		   "(default: 1/64)")
		->type_name("SHARE");
	app.add_flag_callback(
		"--flat-normals", [&drop] { drop.smooth_normals = false; },
		"For renderers that shade with the triangles' normals: what would darken nothing but surfaces whose normals are "
		"interpolated between vertices is dropped, too");
	app.add_option_function<std::string>(
		   "--drop-below", [&drop](const std::string& text) { takeShare("--drop-below", text, drop.below); },
		   "Drops the least contributions, as long as no receiver loses more occlusion than this in all: 1/512 (default: none)")
		->type_name("SHARE");
	const auto take_boxes = [&drop](const std::vector<std::string>& texts)
	{
		for (const std::string& text : texts)
		{
			drop.visible_from.push_back(boxOf("--visible-from", text));
		}
	};
	app.add_option_function<std::vector<std::string>>(
		   "--visible-from", take_boxes,
		   "A box that holds cameras, may be repeated: volumes that darken only what none of them sees are dropped (default: "
		   "cameras may be anywhere)")
		->type_name("BOX")
		->allow_extra_args(false);
}

} // namespace

void addVolumeOptions(CLI::App& app, VolumeOptions& options)
{
	VolumeSettings& settings = options.settings;
	addNumber(app, "--distance", settings.distance_m, 1e-6, 1e9, "How far a polygon darkens what lies before it, metres")
		->type_name("M")
		->required();
	addNumber(app, "--ray-distance", settings.ray_distance_m, 1e-6, 1e10,
			  "Radius of the ray-traced reference with linear falloff that they stand for, metres (default: distance / 0.6, or "
			  "fitted by --compensate)")
		->type_name("M");
	addOccluderOptions(app, options);
	addDropOptions(app, options);
	app.add_option_function<std::string>(
		   "--trim", [&settings](const std::string& text) { takeShare("--trim", text, settings.trim.emplace().share); },
		   "Makes volumes lower and narrower where no sampled point loses more than this share of the sum of all volumes by "
		   "that (or of 0.05, where that is more): fewer fragments; 0.1, 0.15 (default: not)")
		->type_name("SHARE");
	app.add_flag_callback(
		"--compensate", [&settings] { settings.compensate.emplace(); },
		"Fits the curve from sums of volumes to occlusion to this level, by rays (default: the paper's curve)");
	addChoiceText(
		app, "--compensate-measure", kCurveMeasures, [&options](std::size_t i) { options.measure = static_cast<CurveMeasure>(i); },
		"What --compensate fits the curve to: the values' RMSE (default), or AOV's eq. 14, mostly differences of neighbours");
	app.add_flag_callback(
		"--verify", [&settings] { settings.verify.emplace(); },
		"Evaluates all volumes and those kept at sampled points, and says how far they differ");
	app.add_flag("--exact-bounds", settings.exact_bounds,
				 "Volumes hold every point that they darken; else sharp corners are cut at twice the distance");
	addMemory(app, settings.memory_bytes,
			  "2GiB: where a level may take more, leaves out steps and warns; refuses it, before work starts, where that is not "
			  "enough, or with --strict (default: no limit)");
}

void settleVolumeOptions(VolumeOptions& options)
{
	VolumeSettings& settings = options.settings;
	settings.occluders.distance_m = settings.distance_m;
	if (!settings.occluders.merge && (options.flat_given || settings.occluders.extent_always))
	{
		throw Error(ExitCode::usage, "--no-merge: found with --flat or --extent, expected one or the other");
	}
	if (options.measure)
	{
		if (!settings.compensate)
		{
			throw Error(ExitCode::usage, "--compensate-measure: found without --compensate, expected both");
		}
		settings.compensate->measure = *options.measure;
	}
	if (options.hidden_loss_given && !settings.drop.hidden)
	{
		throw Error(ExitCode::usage, "--hidden-loss: found without --drop-hidden, expected both");
	}
	if (options.no_drop)
	{
		if (settings.drop.below > 0.0 || settings.drop.hidden || !settings.drop.visible_from.empty() ||
			!settings.drop.smooth_normals)
		{
			throw Error(ExitCode::usage, "--no-drop: found with --drop-below, --drop-hidden, --flat-normals or --visible-from, "
										 "expected one or the other");
		}
		settings.drop.no_receiver = false;
		settings.drop.sides = false;
		settings.drop.inside = false;
	}
	else if (!settings.drop.no_receiver && (!settings.drop.visible_from.empty() || !settings.drop.smooth_normals))
	{
		throw Error(ExitCode::usage, "--keep-unlit: found with --visible-from or --flat-normals, expected one or the other");
	}
}

} // namespace nook
