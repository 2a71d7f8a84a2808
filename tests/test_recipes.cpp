// SPDX-License-Identifier: GPL-3.0-or-later
// Recipes, what they fit, and the strength and power that every method has.
#include "picture_errors.h"

#include "emit/module.h"
#include "methods/method_table.h"
#include "methods/recipes.h"
#include "pattern/recipe.h"
#include "scene/camera_choice.h"
#include "shade/shade.h"
#include "study/candidates.h"
#include "study/fit.h"

#include "nook_vo3.h"

#include <nlohmann/json.hpp>

namespace nook
{
namespace
{

struct Scene
{
	GBuffer gbuffer;
	std::vector<float> draw(const ShadeSettings& settings, const ShadeSamples& samples, bool gl = false) const
	{
		return (gl ? shadeOnGl(gbuffer, samples, settings, {}) : shadeOnCpu(gbuffer, samples, settings, {}, {})).visibility;
	}
};

Scene cornell(int width_px, int height_px)
{
	const LoadedLevel level = loadLevel("builtin:cornell", {}, {});
	const Tracer tracer(level.level, {});
	const LevelCamera camera = chooseCameras(tracer, 1, {}).front();
	return {castGBuffer(tracer, viewOf(camera, width_px, height_px), width_px, height_px, NormalKind::geometric, {})};
}

ShadeSamples lines(int count)
{
	Recipe recipe{.domain = Domain::disk, .count = count};
	return samplesOf(ShadeMethod::vo_line, {generatePattern(recipe, {})});
}

std::string messageOf(const std::string& text)
{
	return refusalBy([&] { recipesOf(text, "r.json"); });
}

} // namespace

TEST_CASE("recipes: every screen-space method has one of rays, with a strength and a power", "[methods]")
{
	const MethodRow row = GENERATE(from_range(methodTable()));
	if (row.kind == MethodKind::screen)
	{
		CAPTURE(row.name);
		const MethodRecipe* const recipe = recipeFor(raysRecipes(), row.method);
		REQUIRE(recipe != nullptr);
		ShadeSettings settings;
		settings.method = row.method;
		applyRecipe(settings, *recipe, 2.0);
		CHECK(settings.radius_m == 2.0 * recipe->radius);
		CHECK(isShaped(settings));
	}
}

TEST_CASE("recipes: lengths follow the reach, all else stays", "[methods]")
{
	const MethodRecipe& recipe = *recipeFor(raysRecipes(), ShadeMethod::vo_line);
	ShadeSettings small;
	ShadeSettings large;
	applyRecipe(small, recipe, 0.25);
	applyRecipe(large, recipe, 4.0);
	CHECK(large.radius_m == 16.0 * small.radius_m);
	CHECK(large.volume.second_radius_m == 16.0 * small.volume.second_radius_m);
	CHECK(large.volume.third_thickness_m == 16.0 * small.volume.third_thickness_m);
	CHECK(large.strength == small.strength);
	CHECK(large.volume.radii == small.volume.radii);
	CHECK(small.volume.third_radius_m > 0.0);
}

TEST_CASE("recipes: an emitted header sets what nook shade draws with", "[methods]")
{
	ShadeSettings shade;
	applyRecipe(shade, *recipeFor(raysRecipes(), ShadeMethod::vo_line), 1.5);
	const nook_settings settings = nook_vo_line_settings(1.5);
	CHECK(settings.radius == shade.radius_m);
	CHECK(settings.second_radius == shade.volume.second_radius_m);
	CHECK(settings.third_radius == shade.volume.third_radius_m);
	CHECK(settings.thickness == shade.volume.thickness_m);
	CHECK(settings.second_thickness == shade.volume.second_thickness_m);
	CHECK(settings.third_thickness == shade.volume.third_thickness_m);
	CHECK(settings.strength == shade.strength);
	CHECK(settings.power == shade.power);
}

TEST_CASE("recipes: written and read again they are the same, and what is wrong is named", "[methods]")
{
	const std::vector<MethodRecipe> all(raysRecipes().begin(), raysRecipes().end());
	const std::vector<MethodRecipe> again = recipesOf(recipesFile(all, "test"), "again.json");
	REQUIRE(again.size() == all.size());
	for (std::size_t i = 0; i < all.size(); ++i)
	{
		CHECK(recipeJson(again[i]) == recipeJson(all[i]));
	}
	const auto file = [](const std::string& recipe)
	{
		return R"({"format": "nook.recipes/1", "recipes": [)" + recipe + "]}";
	};
	const std::string good = R"({"method": "slices", "radius": 1, "options": {"--slice-thickness": 0.5}})";
	CHECK(messageOf(file(good)).empty());
	CHECK(messageOf(file(good + "," + good)).find("expected each method once") != std::string::npos);
	CHECK(messageOf(file(R"({"method": "aov", "radius": 1, "options": {}})")).find("expected a screen-space method") !=
		  std::string::npos);
	CHECK(messageOf(file(R"({"method": "slices", "radius": 0, "options": {}})")).find("expected a number from") !=
		  std::string::npos);
	CHECK(messageOf(file(R"({"method": "slices", "radius": 1, "options": {"--thickness": 1}})")).find("expected one of slices") !=
		  std::string::npos);
	CHECK(messageOf(file(R"({"method": "slices", "radius": 1, "options": {"--power": -1}})")).find("expected a number from") !=
		  std::string::npos);
	CHECK(messageOf(file(R"({"method": "vo-line", "radius": 1, "options": {"--combine": "sum"}})")).find("its choices") !=
		  std::string::npos);
	CHECK(messageOf(R"({"format": "nook.pattern/1", "recipes": []})").find("nook.recipes/1") != std::string::npos);
	const std::string text = recipesFile(all, "test");
	for (std::size_t length = 0; length + 2 < text.size(); length += 7)
	{
		CHECK_FALSE(messageOf(text.substr(0, length)).empty());
	}
}

TEST_CASE("shade: strength and power change the finished picture alone", "[shade]")
{
	const Scene scene = cornell(48, 36);
	const ShadeSamples samples = lines(6);
	const ShadeFilter filter = GENERATE(ShadeFilter::none, ShadeFilter::bilateral);
	const bool half = GENERATE(false, true);
	ShadeSettings settings;
	settings.filter = filter;
	settings.half_resolution = half;
	std::vector<float> expected = scene.draw(settings, samples);
	for (float& v : expected)
	{
		v = std::pow(std::max(0.0F, 1.0F - 1.4F * (1.0F - v)), 0.7F);
	}
	settings.strength = 1.4;
	settings.power = 0.7;
	CAPTURE(static_cast<int>(filter), half);
	CHECK(differenceOf(scene.draw(settings, samples), expected).worst < 1e-6);
	CHECK(differenceOf(scene.draw(settings, samples, true), expected).worst < 1.0 / 255.0);
}

TEST_CASE("shade: three radii are the product or the least of one radius each", "[shade]")
{
	const Scene scene = cornell(48, 36);
	const ShadeSamples samples = lines(6);
	std::vector<std::vector<float>> single;
	for (const auto& [radius, thickness] : {std::pair(0.3, 0.2), std::pair(0.1, 0.1), std::pair(0.05, 0.2)})
	{
		ShadeSettings one;
		one.radius_m = radius;
		one.volume.thickness_m = thickness;
		single.push_back(scene.draw(one, samples));
	}
	ShadeSettings settings;
	settings.radius_m = 0.3;
	settings.volume = {0.2, 0.1, 0.0, TwoRadii::product, 0.1, 0.05};
	for (const TwoRadii radii : {TwoRadii::product, TwoRadii::minimum})
	{
		settings.volume.radii = radii;
		std::vector<float> expected;
		for (std::size_t i = 0; i < single[0].size(); ++i)
		{
			expected.push_back(radii == TwoRadii::product ? single[0][i] * single[1][i] * single[2][i]
														  : std::min({single[0][i], single[1][i], single[2][i]}));
		}
		CHECK(differenceOf(scene.draw(settings, samples), expected).worst == 0.0);
		CHECK(differenceOf(scene.draw(settings, samples, true), expected).worst < 1.0 / 255.0);
	}
}

TEST_CASE("shade: by the recipe of rays an open plane is open, at any slope", "[shade]")
{
	const double tilt_deg = GENERATE(0.0, 45.0, 80.0);
	const double slope = std::tan(tilt_deg * 3.14159265358979 / 180.0);
	GBuffer gbuffer;
	gbuffer.width_px = 64;
	gbuffer.height_px = 48;
	gbuffer.view.projection = projectionOf({true, 1.0, 3.0, 0.1, 100.0}, 64.0 / 48.0);
	const Projector projector(gbuffer.view.projection, 64, 48);
	for (int i = 0; i < 64 * 48; ++i)
	{
		const ViewLine line = projector.lineOf({i % 64 + 0.5, i / 64 + 0.5});
		gbuffer.depth.push_back(static_cast<float>(50.0 + slope * line.at.x));
		gbuffer.normals.push_back(glm::vec3(glm::normalize(glm::dvec3(slope, 0.0, 1.0))));
	}
	const MethodRow row = GENERATE(from_range(methodTable()));
	if (row.kind == MethodKind::screen && row.emitted && row.domain)
	{
		Candidate candidate = fittedCandidate(row);
		candidate.recipe = *recipeFor(raysRecipes(), row.method);
		const ShadeSettings settings = shadeSettingsOf(candidate, 0.5);
		const std::vector<float> picture = Scene{gbuffer}.draw(settings, samplesOf(candidate, settings, {}));
		CAPTURE(row.name, tilt_deg);
		CHECK(*std::min_element(picture.begin(), picture.end()) >= 1.0F - 1.0F / 255.0F);
	}
}

TEST_CASE("fit: the search finds the least of a bowl, and asks nothing twice", "[fit]")
{
	std::vector<std::vector<double>> asked;
	const auto bowl = [&asked](const std::vector<double>& at)
	{
		asked.push_back(at);
		const double x = std::log(at[0] / 0.31);
		const double y = std::log(at[1] / 2.6);
		return x * x + y * y + 0.5 * x * y;
	};
	const std::vector<double> found = fitNumbers({{1.0, 0.01, 100.0}, {1.0, 0.01, 100.0}}, {2.0, 1.005}, bowl);
	CHECK(found[0] == Approx(0.31).epsilon(0.01));
	CHECK(found[1] == Approx(2.6).epsilon(0.01));
	std::sort(asked.begin(), asked.end());
	CHECK(std::adjacent_find(asked.begin(), asked.end()) == asked.end());
	CHECK(fitNumbers({{1.0, 0.5, 100.0}}, {}, [](const std::vector<double>& at) { return at[0]; })[0] == 0.5); // at the bound
}

TEST_CASE("fit: strength and power are those that a picture was changed by", "[fit]")
{
	std::vector<float> visibility;
	std::vector<float> rays;
	for (int i = 0; i < 4000; ++i)
	{
		visibility.push_back(static_cast<float>(i) / 3999.0F);
		rays.push_back(std::pow(std::max(0.0F, 1.0F - 0.8F * (1.0F - visibility.back())), 1.5F));
	}
	const std::vector<char> counted(visibility.size(), 1);
	const std::vector<ShapeView> views{shapeView(0, visibility, rays, counted)};
	const CurveShape shape = fitShape(views);
	CHECK(shape.strength == Approx(0.8).epsilon(0.03));
	CHECK(shape.power == Approx(1.5).epsilon(0.03));
	CHECK(shapedError(views, shape) < 0.002);
	CHECK(shapedError(views, {}) > 0.03);
}

TEST_CASE("fit: a recipe is nearer to rays than the paper's, and the same on any number of threads", "[fit]")
{
	FitSettings settings;
	settings.starts = {*recipeFor(raysRecipes(), ShadeMethod::hbao), *recipeFor(raysRecipes(), ShadeMethod::statvo)};
	settings.views = 1;
	settings.width_px = 64;
	settings.height_px = 36;
	settings.reference_rays = 32;
	RunSettings one;
	one.threads = 1;
	RunSettings four;
	four.threads = 4;
	const FitReport report = fitRecipes({"builtin:courtyard"}, {"builtin:cornell"}, {}, settings, one);
	REQUIRE(report.fits.size() == 2);
	for (const MethodFit& fit : report.fits)
	{
		REQUIRE(fit.errors.size() == 2);
		CHECK(fit.errors[0].rays < fit.errors[0].paper);
		CHECK(report.levels[1].held_out);
	}
	const std::string text = fitJson(report, "nook fit", "test");
	CHECK(fitJson(fitRecipes({"builtin:courtyard"}, {"builtin:cornell"}, {}, settings, four), "nook fit", "test") == text);
	CHECK(recipesOf(text, "fit.json").size() == 2);
}

} // namespace nook
