// SPDX-License-Identifier: GPL-3.0-or-later
#include "volume/build.h"

#include "core/text.h"
#include "methods/method_table.h"

#include <algorithm>

namespace nook
{
namespace
{

void addMerged(const OccluderCounts& merged, Facts& to)
{
	to.whole("level_triangles", merged.triangles, "triangles");
	to.whole("triangles_simplified", merged.proxies);
	to.when(merged.proxies != merged.triangles).line("  after simplification: " + std::to_string(merged.proxies));
	to.reason("triangles_thin", merged.thin, "dropped, without area");
	to.reason("triangles_duplicate", merged.duplicates, "dropped, there twice");
	to.reason("triangles_reversed", merged.reversed, "dropped, the back of another");
	to.whole("polygons_merged", merged.polygons, "convex polygons of them");
	to.reason("polygons_two_sided", merged.two_sided, "two-sided");
	to.reason("regions_not_merged", merged.fallbacks, "flat regions that overlap themselves, joined triangle by triangle");
	to.number("simplification_m", merged.deviation_m);
	to.when(merged.deviation_m > 0.0)
		.line("  simplification moved surfaces by at most " + roundedText(merged.deviation_m, 4) + " m");
}

void addDetail(const DetailChoice& choice, Facts& to)
{
	std::vector<Facts> trials;
	for (const DetailTrial& trial : choice.trials)
	{
		Facts& item = trials.emplace_back();
		item.number("detail", trial.detail);
		item.whole("polygons", trial.polygons);
		item.number("rmse_paper", trial.paper_rmse);
		item.number("rmse_fitted", trial.fitted_rmse);
	}
	to.number("detail", choice.detail);
	to.whole("detail_points", choice.points);
	to.items("detail_trials", trials);
	std::string words = "detail chosen: " + (choice.detail > 0.0 ? roundedText(choice.detail, 4) + " of the distance" : "all");
	for (const DetailTrial& trial : choice.trials)
	{
		if (trial.detail == choice.detail)
		{
			words += ", RMSE " + roundedText(trial.fitted_rmse, 4) + " at " + std::to_string(choice.points) + " points, with all " +
					 roundedText(choice.trials[0].fitted_rmse, 4);
		}
	}
	to.line(words);
}

void addDropped(const DropCounts& dropped, Facts& to)
{
	to.reason("dropped_inside", dropped.inside, "dropped, inside solids");
	to.reason("dropped_convex", dropped.convex, "dropped, no surface there sees them");
	to.reason("dropped_alone", dropped.alone, "dropped, no surface within them");
	to.reason("dropped_enclosed", dropped.enclosed, "dropped, darken what is inside solids");
	to.reason("dropped_unseen", dropped.unseen, "dropped, darken what no camera sees");
	to.reason("dropped_below", dropped.below, "dropped, contribute too little");
	to.reason("turned", dropped.turned, "two-sided, now one-sided");
	to.number("greatest_loss", dropped.greatest_loss);
	to.when(dropped.below > 0).line("  by that no receiver loses more than " + roundedText(dropped.greatest_loss, 4) + " (proven)");
	if (dropped.check_rays > 0)
	{
		to.whole("sight_rays", dropped.check_rays, "rays from the boxes that checked what they see");
		to.whole("sight_missed", dropped.check_missed, "of those, found a surface that was taken for unseen");
	}
}

void addTrimmed(const TrimCounts& trimmed, Facts& to)
{
	to.whole("trimmed", trimmed.trimmed, "volumes shortened");
	to.number("trim_mean_reach", trimmed.mean_reach, "volumes reach on average along their normals, of the distance");
	to.number("trim_surface", trimmed.surface, "of the surface of those that points tell of, about, is left");
	to.whole("trim_receivers", trimmed.receivers);
	to.whole("trim_receivers_left_out", trimmed.left_out);
	to.whole("trim_whole", trimmed.whole);
	to.whole("trim_shares", trimmed.shares);
	to.whole("trim_shares_lost", trimmed.lost);
	to.number("trim_greatest_loss", trimmed.greatest_loss);
	to.number("trim_mean_loss", trimmed.mean_loss);
	to.line("  by that points lose " + roundedText(trimmed.mean_loss, 4) + " on average, at most " +
			roundedText(trimmed.greatest_loss, 4) + ", at the " + std::to_string(trimmed.receivers) + " points it was done for");
	if (trimmed.left_out > 0)
	{
		to.line("  large: " + std::to_string(trimmed.left_out) + " further points were not asked, since these get something from " +
				std::to_string(trimmed.shares) + " volumes in all; " + std::to_string(trimmed.whole) +
				" volumes that fewer than four points tell of stay whole");
	}
}

void addVerified(const std::string& prefix, const VerifyResult& verified, const std::string& what, Facts& to)
{
	to.whole(prefix + "_receivers", verified.receivers);
	to.number(prefix + "_greatest", verified.greatest);
	to.number(prefix + "_greatest_compensated", verified.greatest_compensated);
	to.number(prefix + "_mean", verified.mean);
	to.numbers(prefix + "_worst_m", {verified.worst_position.x, verified.worst_position.y, verified.worst_position.z});
	to.line(what + " occlusion by at most " + roundedText(verified.greatest, 4) + " (" +
			roundedText(verified.greatest_compensated, 4) + " compensated), by " + roundedText(verified.mean, 4) +
			" on average, at " + std::to_string(verified.receivers) + " points");
}

void addErrors(const CurveCheck& check, Facts& to)
{
	to.whole("points", check.triples);
	to.number("rmse_before", check.before.rmse);
	to.number("rmse", check.after.rmse);
	to.number("mean_before", check.before.mean);
	to.number("mean", check.after.mean);
	to.number("eq14_before", check.before.eq14);
	to.number("eq14", check.after.eq14);
}

// In views that the curve was not fitted to.
void addKeptOut(const CompensateResult& compensated, Facts& to)
{
	const CurveCheck& check = compensated.check;
	std::vector<Facts> views;
	for (const CurveCheck& view : compensated.views)
	{
		addErrors(view, views.emplace_back());
	}
	std::vector<Facts> all(check.triples > 0 ? 1 : 0);
	for (Facts& item : all)
	{
		addErrors(check, item);
	}
	to.items("compensate_kept_out", all);
	to.items("compensate_kept_out_views", views);
	to.whole("compensate_refused", compensated.refused ? 1 : 0);
	const auto change = [](double before, double after)
	{
		return roundedText(after, 4) + ", before " + roundedText(before, 4);
	};
	if (check.triples > 0)
	{
		to.line("in " + std::to_string(views.size()) + " views kept out of the fit: RMSE " +
				change(check.before.rmse, check.after.rmse) + "; mean " + change(check.before.mean, check.after.mean) +
				"; eq. 14 " + change(check.before.eq14, check.after.eq14));
	}
	to.when(!compensated.refused && check.after.rmse > check.before.rmse)
		.line("  the RMSE is worse: --compensate-measure rmse fits to that");
	to.when(compensated.refused).line("  that is worse than the paper's curve, which is kept");
}

void addCompensated(const CompensateResult& compensated, const CompensateSettings& settings, Facts& to)
{
	std::vector<Facts> trials;
	for (const RatioTrial& trial : compensated.trials)
	{
		Facts& item = trials.emplace_back();
		item.number("ratio", trial.ratio);
		item.number("paper", trial.paper);
		item.number("fitted", trial.fitted);
	}
	to.whole("compensate_receivers", compensated.receivers);
	to.items("compensate_trials", trials);
	if (compensated.best < compensated.trials.size())
	{
		const RatioTrial& best = compensated.trials[compensated.best];
		to.line("compensation fitted at " + std::to_string(compensated.receivers) + " points: mean squared log difference " +
				roundedText(best.fitted, 4) + ", with the paper's curve " + roundedText(best.paper, 4));
	}
	to.whole("compensate_triples", compensated.triples);
	if (compensated.triples > 0)
	{
		to.number("compensate_error_points", compensated.error_before);
		to.number("compensate_error", compensated.error);
		const bool rmse = settings.measure == CurveMeasure::rmse;
		to.text("compensate_measure", rmse ? "rmse" : "eq14");
		to.line("and to pictures at " + std::to_string(compensated.triples) + " points" +
				(rmse ? ": mean square " : " and their neighbours: eq. 14 of AOV ") + roundedText(compensated.error, 4) +
				", before " + roundedText(compensated.error_before, 4));
	}
	addKeptOut(compensated, to);
}

void addDistances(double distance_m, double ray_distance_m, Facts& to)
{
	to.number("distance_m", distance_m, "distance", " m");
	to.number("ray_distance_m", ray_distance_m, "drawn by " + std::string(volumeRow(false).name) + ", stand for rays of", " m");
	to.number("mask_ray_distance_m", distance_m, "drawn by " + std::string(volumeRow(true).name) + ", stand for rays of", " m");
}

void addFile(std::size_t bytes, std::size_t clusters, std::size_t polygons, double error_m, double plane_error_m, Facts& to)
{
	to.whole("clusters", clusters, "clusters");
	to.whole("bytes", bytes, "bytes");
	if (polygons > 0)
	{
		to.number("bytes_per_polygon", static_cast<double>(bytes) / static_cast<double>(polygons), "bytes per polygon");
	}
	to.number("quantisation_error_m", error_m, "corners moved by 16-bit numbers, at most", " m");
	to.number("plane_error_m", plane_error_m, "surfaces off the planes of their polygons by that, at most", " m");
}

} // namespace

void describeBuilt(const BuiltVolumes& built, const VolumeFile& file, const VolumeSettings& settings,
				   const std::optional<VerifyResult>& quantised, Facts& to)
{
	const PackedVolumes& packed = file.packed;
	addDistances(settings.distance_m, built.set.ray_distance_m, to);
	if (built.detail)
	{
		addDetail(*built.detail, to);
	}
	addMerged(built.merged, to);
	addDropped(built.dropped, to);
	if (built.trimmed)
	{
		addTrimmed(*built.trimmed, to);
	}
	to.reason("dropped_flat", packed.flat_polygons, "dropped, no area in 16-bit numbers");
	to.number("dropped_flat_m2", packed.flat_area_m2);
	to.whole("straightened_corners", packed.flat_corners);
	to.whole("polygons", packed.polygons.size(), "volumes");
	to.whole("corners", packed.corners.size());
	to.whole("prism_vertices", packed.vertices.size());
	to.whole("file_triangles", packed.indices.size() / 3);
	addFile(file.bytes.size(), packed.clusters.size(), packed.polygons.size(), packed.greatest_error_m, packed.plane_error_m, to);
	to.whole("memory_estimate_bytes", built.memory_estimate_bytes);
	to.when(!built.left_out.empty()).text("left_out", built.left_out);
	if (built.compensated)
	{
		addCompensated(*built.compensated, *settings.compensate, to);
	}
	if (built.verified)
	{
		addVerified("verify", *built.verified, built.trimmed ? "dropping and shortening change" : "dropping changes", to);
	}
	if (quantised)
	{
		addVerified("quantisation", *quantised, "16-bit numbers change", to);
	}
	to.texts("warnings", built.warnings);
}

void describeVolumes(const VolumeSet& volumes, const VolumeFileFacts& file, Facts& to)
{
	const std::vector<Occluder>& polygons = volumes.occluders.polygons;
	to.text("kind", "volumes");
	to.line(std::string("volumes: ") + (file.layout == VolumeLayout::prisms ? "prisms" : "polygons") +
			(file.compressed ? ", compressed" : ""));
	to.text("layout", file.layout == VolumeLayout::prisms ? "prisms" : "polygons");
	to.whole("compressed", file.compressed ? 1 : 0);
	to.text("level", file.level);
	to.text("generator", file.generator);
	to.line("level: " + oneLine(file.level) + ", by " + oneLine(file.generator));
	addDistances(volumes.distance_m, volumes.ray_distance_m, to);
	to.whole("polygons", polygons.size(), "volumes");
	const auto two_sided = static_cast<std::size_t>(
		std::count_if(polygons.begin(), polygons.end(), [](const Occluder& polygon) { return polygon.two_sided; }));
	const auto clear = static_cast<std::size_t>(
		std::count_if(polygons.begin(), polygons.end(), [](const Occluder& polygon) { return polygon.alpha < 1.0F; }));
	const auto trimmed = static_cast<std::size_t>(
		std::count_if(polygons.begin(), polygons.end(), [](const Occluder& polygon) { return polygon.reach < 1.0F; }));
	to.reason("polygons_two_sided", two_sided, "two-sided");
	to.reason("polygons_clear", clear, "let some light through");
	to.reason("polygons_trimmed", trimmed, "shortened");
	to.whole("corners", volumes.occluders.corners.size(), "corners");
	to.reason("prism_vertices", file.vertices, "points of prisms");
	to.whole("file_triangles", file.indices / 3);
	to.whole("exact_bounds", volumes.exact_bounds ? 1 : 0);
	const bool paper = volumes.compensation.range == 1.0 && volumes.compensation.occlusion == Compensation::paper();
	to.line(std::string("compensation: ") + (paper ? "the paper's curve" : "of this level"));
	to.text("compensation", paper ? "paper" : "level");
	to.number("compensation_range", volumes.compensation.range);
	to.numbers("compensation_curve", {volumes.compensation.occlusion.begin(), volumes.compensation.occlusion.end()});
	addFile(file.bytes, volumes.clusters.size(), polygons.size(), file.greatest_error_m, volumes.plane_error_m, to);
}

} // namespace nook
