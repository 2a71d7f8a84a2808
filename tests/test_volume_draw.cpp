// SPDX-License-Identifier: GPL-3.0-or-later
// nook_volumes_draw.h compared with a reference that multiplies whole matrices.
#include "small_gbuffers.h"
#include "small_volumes.h"
#include "testing.h"

#include "shade/aov_gl_parts.h"
#include "shade/gl_context.h"
#include "volume/compensate.h"
#include "volume/occluders.h"

namespace
{

struct Setting
{
	std::string name;
	glm::dmat4 projection;
	bool zero_to_one;
};

// A tilted near plane through (0, 0, -0.5); after Eric Lengyel, Oblique View Frustum Depth Projection and Clipping, 2005.
glm::dmat4 withObliqueNear(glm::dmat4 p, bool zero_to_one, bool reversed)
{
	const glm::dvec3 n = glm::normalize(glm::dvec3(0.2, 0.3, -1.0));
	const glm::dvec4 plane(n, 0.5 * n.z); // > 0 on the far side
	glm::dmat4 plain = p;                 // its z is irrelevant except for the far corner
	plain[2][2] = -1.0;
	plain[3][2] = -0.2;
	const glm::dvec4 corner = glm::inverse(plain) * glm::dvec4(1.0, 1.0, 1.0, 1.0);
	const double scale =
		(zero_to_one ? 1.0 : 2.0) * glm::dot(glm::dvec4(p[0][3], p[1][3], p[2][3], p[3][3]), corner) / glm::dot(plane, corner);
	for (int column = 0; column < 4; ++column)
	{
		const double z = plane[column] * scale - (zero_to_one ? 0.0 : p[column][3]);
		p[column][2] = reversed ? p[column][3] - z : z;
	}
	return p;
}

// All of projections(), oblique near planes, and each of those flipped as engines do for Vulkan.
std::vector<Setting> settings()
{
	std::vector<Setting> all;
	for (const NamedProjection& projection : projections(4.0 / 3.0))
	{
		all.push_back({projection.name, projection.matrix, projection.clip == ClipRange::zero_to_one});
	}
	const glm::dmat4 finite = all[0].projection;
	const glm::dmat4 shifted = all[2].projection;
	all.push_back({"oblique near plane", withObliqueNear(finite, false, false), false});
	all.push_back({"oblique near plane, zero to one", withObliqueNear(shifted, true, false), true});
	all.push_back({"oblique near plane, reversed", withObliqueNear(shifted, true, true), true});
	glm::dmat4 parallel = all[6].projection;
	parallel[0][2] = 0.004;
	parallel[1][2] = -0.006;
	all.push_back({"parallel, oblique near plane", parallel, false});
	const std::size_t count = all.size();
	for (std::size_t i = 0; i < count; ++i)
	{
		Setting down = all[i];
		for (int column = 0; column < 4; ++column)
		{
			down.projection[column][1] = -down.projection[column][1];
		}
		down.name += ", y down";
		all.push_back(down);
	}
	return all;
}

nook_volumes::Camera cameraFor(const Setting& setting, const glm::dmat4& view)
{
	nook_volumes::Camera camera;
	std::copy_n(&view[0][0], 16, camera.camera_from_world);
	std::copy_n(&setting.projection[0][0], 16, camera.projection);
	camera.width = 24;
	camera.height = 18;
	camera.zero_to_one = setting.zero_to_one;
	return camera;
}

double deviceOf(const Setting& setting, glm::dvec4 clip)
{
	const double z = clip.z / clip.w;
	return std::clamp(setting.zero_to_one ? z : 0.5 * z + 0.5, 0.0, 1.0);
}

// x and y of the picture, y upward: NDC's own for OpenGL, otherwise with row 0 at the top.
glm::dvec2 seenBy(const nook_volumes::Camera& camera, glm::dvec4 clip)
{
	const double y = clip.y / clip.w;
	return {clip.x / clip.w, camera.faces_by_rows && camera.first_row_ndc_y < 0.0 ? -y : y};
}

struct Facing
{
	int right = 0;
	int wrong = 0;
};

// Winding of the triangles of all volumes in the picture, and the side of them that the eye is on.
Facing facingOf(const PackedVolumes& packed, const nook_volumes::Camera& camera, const Setting& setting, const glm::dmat4& view)
{
	nook_volumes::Frame frame;
	REQUIRE(frame.set(nook_volumes::Header(), camera) == nullptr);
	const glm::dmat4 world_from_camera = glm::inverse(view);
	const bool parallel = setting.projection[3][3] != 0.0;
	Facing facing;
	for (const nook_volumes::Cluster& cluster : packed.clusters)
	{
		for (uint32_t i = cluster.first_index; i < cluster.first_index + cluster.index_count; i += 3)
		{
			glm::dvec3 at[3];
			glm::dvec2 seen[3];
			double nearest = 1.0;
			for (uint32_t k = 0; k < 3; ++k)
			{
				const nook_volumes::Corner& point = packed.vertices[cluster.first_vertex + packed.indices[i + k]];
				const std::uint16_t numbers[3] = {point.x, point.y, point.z};
				for (int axis = 0; axis < 3; ++axis)
				{
					at[k][axis] = cluster.vertex_origin[axis] + static_cast<double>(cluster.vertex_step[axis]) * numbers[axis];
				}
				const glm::dvec4 clip = setting.projection * view * glm::dvec4(at[k], 1.0);
				nearest = std::min(nearest, clip.w);
				seen[k] = seenBy(camera, clip);
			}
			// Direction of a line of sight: from the eye, or along the view direction plus the shear of an off-centre lens.
			glm::dvec3 sight = at[0] - glm::dvec3(world_from_camera[3]);
			if (parallel)
			{
				const glm::dmat4& p = setting.projection;
				sight = glm::dmat3(world_from_camera) * glm::dvec3(p[2][0] / p[0][0], p[2][1] / p[1][1], -1.0);
			}
			const glm::dvec3 normal = glm::cross(at[1] - at[0], at[2] - at[0]);
			const double toward = -glm::dot(glm::normalize(normal), glm::normalize(sight));
			const glm::dvec2 a = seen[1] - seen[0];
			const glm::dvec2 b = seen[2] - seen[0];
			if (nearest > 0.01 && std::fabs(toward) > 1e-3 && glm::length(normal) > 1e-9)
			{
				const bool counter_clockwise = a.x * b.y - a.y * b.x > 0.0;
				((toward > 0.0) == (counter_clockwise != frame.mirrored()) ? facing.right : facing.wrong) += 1;
			}
		}
	}
	return facing;
}

// Sums with occlusions given by `of`, and neighbours whose sums differ slightly.
template <class Of> std::vector<TripleValues> triplesOf(Of&& of)
{
	Random random(1, 5);
	std::vector<TripleValues> triples(2000);
	for (TripleValues& triple : triples)
	{
		triple.there = {true, random.uniform() < 0.9, random.uniform() < 0.9};
		triple.sums[0] = random.uniform();
		for (std::size_t i = 0; i < 3; ++i)
		{
			triple.sums[i] = i == 0 ? triple.sums[0] : std::clamp(triple.sums[0] + 0.05 * (random.uniform() - 0.5), 0.0, 1.0);
			triple.occlusions[i] = of(triple.sums[i], random);
		}
	}
	return triples;
}

Compensation straight()
{
	Compensation curve;
	for (std::size_t i = 0; i < curve.occlusion.size(); ++i)
	{
		curve.occlusion[i] = static_cast<double>(i) / 32.0;
	}
	return curve;
}

} // namespace

TEST_CASE("volumes' frame: front faces run as it says, for OpenGL and for Vulkan, mirrored views too", "[volume_draw]")
{
	const VolumeSet set = volumesOf(builtinLevel("cornell"), 0.4, 8);
	const PackedVolumes packed = packVolumes(set, {true}, {});
	glm::dmat4 mirror(1.0);
	mirror[0][0] = -1.0;
	std::set<bool> answers;
	for (const Setting& setting : settings())
	{
		for (const glm::dmat4& view : {someView(), mirror * someView(), someView() * mirror})
		{
			nook_volumes::Camera camera = cameraFor(setting, view);
			for (const bool by_rows : {false, true})
			{
				for (const double first_row : {-1.0, 1.0})
				{
					camera.faces_by_rows = by_rows;
					camera.first_row_ndc_y = first_row;
					const Facing facing = facingOf(packed, camera, setting, view);
					INFO(setting.name << ", by rows " << by_rows << ", row 0 at " << first_row << ": " << facing.right << " right");
					CHECK(facing.wrong == 0);
					CHECK(facing.right > 100);
				}
			}
		}
	}
}

TEST_CASE("volumes' frame: depth bounds and the frustum hold all that a cluster reaches, for any projection", "[volume_draw]")
{
	const VolumeSet set = volumesOf(builtinLevel("courtyard"), 1.0, 64);
	const PackedVolumes packed = packVolumes(set, {}, {});
	int out_of_sight = 0; // of cameras that see only part of the courtyard
	for (const Setting& setting : settings())
	{
		// One-sided volumes begin behind their planes, by 1.01 times the sum of the two (aov_vertex.glsl).
		for (const double bias : {0.0, 0.4})
		{
			nook_volumes::Frame frame;
			nook_volumes::Camera camera = cameraFor(setting, someView());
			camera.bias = bias;
			camera.position_error = 0.25 * bias;
			const double behind = 1.01 * 1.25 * bias;
			REQUIRE(frame.set(headerOf(set, true), camera) == nullptr);
			double narrowest = 1.0;
			int in_picture = 0;
			for (std::size_t i = 0; i < packed.clusters.size(); i += 5)
			{
				double least = 0.0;
				double most = 0.0;
				frame.depthBounds(packed.clusters[i], least, most);
				CHECK((least >= 0.0 && least <= most && most <= 1.0));
				narrowest = std::min(narrowest, most - least);
				const bool in_sight = frame.inSight(packed.clusters[i]);
				out_of_sight += in_sight ? 0 : 1;
				const glm::dvec3 low = set.clusters[i].least - behind;
				const glm::dvec3 size = set.clusters[i].most + behind - low;
				for (int sample = 0; sample < 125; ++sample)
				{
					const glm::dvec3 share(0.25 * (sample % 5), 0.25 * (sample / 5 % 5), 0.25 * (sample / 25));
					const glm::dvec4 clip = setting.projection * someView() * glm::dvec4(low + share * size, 1.0);
					if (clip.w > 0.0 && std::fabs(clip.x) <= clip.w && std::fabs(clip.y) <= clip.w)
					{
						const double device = deviceOf(setting, clip);
						INFO(setting.name << ", bias " << bias << ": " << device << " in " << least << " to " << most);
						CHECK((device >= least && device <= most));
						CHECK(in_sight);
						in_picture += 1;
					}
				}
			}
			INFO(setting.name << ", bias " << bias);
			CHECK((bias > 0.0 || narrowest < 0.1));
			CHECK(in_picture > 1000);
		}
	}
	CHECK(out_of_sight > 0);
}

TEST_CASE("volumes' frame: a cluster holds the eye as far as its volumes begin behind their planes", "[volume_draw]")
{
	nook_volumes::Cluster cluster = {};
	for (int axis = 0; axis < 3; ++axis)
	{
		cluster.origin[axis] = 100.0;
		cluster.least[axis] = -1.0F;
		cluster.most[axis] = 2.0F;
	}
	const double off = GENERATE(-1.1, -1.0, 4.0, 4.1); // from its lower end; the upper one is at 3
	for (int axis = 0; axis < 3; ++axis)
	{
		glm::dvec3 eye(100.5);
		eye[axis] = 99.0 + off;
		glm::dmat4 view(1.0);
		view[3] = glm::dvec4(-eye, 1.0);
		nook_volumes::Camera camera = cameraFor(settings().front(), view);
		camera.bias = 0.8;
		camera.position_error = 0.2;
		nook_volumes::Frame frame;
		REQUIRE(frame.set(nook_volumes::Header(), camera) == nullptr);
		CHECK(frame.holdsEye(cluster) == (off == -1.0 || off == 4.0));
	}
}

TEST_CASE("volumes' frame: projections of another convention are refused by its name", "[volume_draw]")
{
	const Setting setting = GENERATE(from_range(settings()));
	const auto faultOf = [&setting](const glm::dmat4& projection)
	{
		Setting other = setting;
		other.projection = projection;
		nook_volumes::Frame frame;
		const char* const fault = frame.set(nook_volumes::Header(), cameraFor(other, someView()));
		return std::string(fault == nullptr ? "" : fault);
	};
	const glm::dmat4& p = setting.projection;
	CHECK(faultOf(p).empty());
	CHECK(faultOf(0.37 * p).empty());
	glm::dmat4 left = p;
	left[2] = -p[2];
	const bool oblique = p[0][2] != 0.0 || p[1][2] != 0.0; // a parallel one has planes on both sides
	CHECK(((oblique && p[3][3] != 0.0) || faultOf(left).find("left-handed") != std::string::npos));
	CHECK(faultOf(-p).find("left-handed") != std::string::npos);
	CHECK(faultOf(glm::transpose(p)).find("row-major") != std::string::npos);
	glm::dmat4 broken = p;
	broken[2][2] = std::nan("");
	CHECK(faultOf(broken).find("NaN") != std::string::npos);
	CHECK(faultOf(glm::dmat4(0.0)).find("skew") != std::string::npos);
}

TEST_CASE("volumes' frame: the shader reads depth back from a depth buffer of any projection", "[volume_draw]")
{
	const GlContext context;
	const std::string text = "#version 330 core\n#define NOOK_FRAGMENT\n#define main nookOfVolumes\n" +
							 aovText({GlslTarget::gl330, 0, true}) +
							 "#undef main\nvoid main()\n{\n\tnook_occlusion = nookDepth(ivec2(gl_FragCoord.xy));\n}\n";
	Random rng(7);
	for (const Setting& setting : settings())
	{
		for (const double first_row : {-1.0, 1.0})
		{
			nook_volumes::Camera camera = cameraFor(setting, someView());
			camera.first_row_ndc_y = first_row;
			nook_volumes::Frame frame;
			REQUIRE(frame.set(nook_volumes::Header(), camera) == nullptr);
			const glm::dmat4 camera_from_clip = glm::inverse(setting.projection);
			std::vector<float> devices;
			std::vector<double> depths; // empty: nothing in front of the eye
			for (int i = 0; i < camera.width * camera.height; ++i)
			{
				const double x = -1.0 + 2.0 * (i % camera.width + 0.5) / camera.width;
				const double y = first_row * (1.0 - 2.0 * (static_cast<double>(i / camera.width) + 0.5) / camera.height);
				const auto device = static_cast<float>(rng.uniform());
				const auto z = static_cast<double>(device) * (setting.zero_to_one ? 1.0 : 2.0) - (setting.zero_to_one ? 0.0 : 1.0);
				const glm::dvec4 at = camera_from_clip * glm::dvec4(x, y, z, 1.0);
				devices.push_back(device);
				depths.push_back(at.w > 0.0 && -at.z / at.w > 0.0 && -at.z / at.w < 50.0 ? -at.z / at.w : 0.0);
			}
			const GlTexture stored(camera.width, camera.height, 1, devices.data());
			const GlTexture read(PictureShape{PictureFormat::scalar, camera.width, camera.height});
			GlPass pass(text);
			pass.bind("nook_depths", stored);
			pass.bindBlock("NookVolumes", std::as_bytes(std::span(&frame.block, 1)));
			pass.draw(read);
			const std::vector<float> found = readFloats(read);
			int compared = 0;
			double worst = 0.0;
			for (std::size_t i = 0; i < depths.size(); ++i)
			{
				if (depths[i] > 0.0)
				{
					compared += 1;
					worst = std::max(worst, std::fabs(static_cast<double>(found[i]) - depths[i]) / (depths[i] + 0.5));
				}
			}
			INFO(setting.name << ", row 0 at " << first_row << ": worst " << worst << " of " << compared);
			CHECK(worst <= 1e-4);
			CHECK(compared > 150);
		}
	}
}

TEST_CASE("volumes: a reader without a file is empty, not a crash", "[volume_draw]")
{
	const nook_volumes::Volumes volumes;
	CHECK(volumes.header().version == 0);
	CHECK(volumes.header().distance == 0.0);
	CHECK_FALSE(volumes.hasPrisms());
	CHECK(volumes.clusterCount() == 0);
	CHECK(volumes.compensated(0.5) == 0.0);
	nook_volumes::Volumes refused;
	CHECK(refused.open("no such file", 12) != nullptr);
	CHECK(refused.header().version == 0);
}

// Curves fitted to AOV eq. 14, including gradients.

TEST_CASE("compensation: eq. 14 of triples is 0 for the curve that they are made with, and is found from another", "[compensate]")
{
	const Compensation paper;
	const std::vector<TripleValues> triples = triplesOf([&](double sum, Random& /*random*/) { return paper.at(sum); });
	CHECK(curveError(paper, triples) == Approx(0.0).margin(1e-12));
	const double before = curveError(straight(), triples);
	CHECK(before > 0.1);
	const Compensation fitted = fitToPictures(straight(), triples);
	CHECK(curveError(fitted, triples) < 0.1 * before);
	CHECK(std::is_sorted(fitted.occlusion.begin(), fitted.occlusion.end()));
	CHECK(fitted.occlusion[0] == 0.0);
	CHECK(fitted.at(0.5) == Approx(paper.at(0.5)).margin(0.02));
}

TEST_CASE("compensation: of two curves with the same values, the one with the steps of the picture", "[compensate]")
{
	// Values are all 0.3, but steps are half of the sums'. A step of eq. 14 counts as much as a value.
	std::vector<TripleValues> triples = triplesOf([](double /*sum*/, Random& /*random*/) { return 0.3; });
	for (TripleValues& triple : triples)
	{
		for (std::size_t i = 1; i < 3; ++i)
		{
			triple.occlusions[i] = triple.occlusions[0] + 0.5 * (triple.sums[i] - triple.sums[0]);
		}
	}
	const Compensation fitted = fitToPictures(straight(), triples);
	CHECK(curveError(fitted, triples) < curveError(straight(), triples));
	const double slope = (fitted.at(0.7) - fitted.at(0.3)) / 0.4;
	CHECK(slope > 0.1);
	CHECK(slope < 0.6);
}

TEST_CASE("compensation: by RMSE it is the values that count, not the steps", "[compensate]")
{
	std::vector<TripleValues> triples = triplesOf([](double sum, Random& /*random*/) { return 0.5 * sum; });
	for (TripleValues& triple : triples)
	{
		triple.occlusions[1] = triple.occlusions[2] = triple.occlusions[0];
	}
	const Compensation fitted = fitToPictures(straight(), triples, CurveMeasure::rmse);
	CHECK(curveError(fitted, triples, CurveMeasure::rmse) < 1e-4);
	CHECK(fitted.at(0.6) == Approx(0.3).margin(0.01));
	const CurveErrors errors = errorsOf(fitted, triples);
	CHECK(errors.rmse * errors.rmse == Approx(curveError(fitted, triples, CurveMeasure::rmse)));
	CHECK(errors.eq14 == curveError(fitted, triples));
	CHECK(std::fabs(errors.mean) <= errors.rmse);
	// A curve that is half too dark.
	CHECK(errorsOf(straight(), triples).mean < -0.1);
}

TEST_CASE("compensation: a curve that is worse in views kept out is refused", "[compensate]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	VolumeSet set;
	set.distance_m = 1.0;
	set.exact_bounds = true;
	set.occluders = occludersOf(level, {}, {}).occluders;
	CompensateSettings settings{.rays = 64, .pictures = {2, 0, 200}, .kept_out = {2, 2, 200}};
	for (const CurveMeasure measure : {CurveMeasure::eq14, CurveMeasure::rmse})
	{
		settings.measure = measure;
		const CompensateResult good = compensateVolumes(set, tracer, settings, {2, {}});
		REQUIRE(good.views.size() == 2);
		CHECK(good.check.triples == good.views[0].triples + good.views[1].triples);
		CHECK(!good.refused);
		CHECK(good.curve.occlusion != Compensation::paper());
		const bool rmse = measure == CurveMeasure::rmse;
		CHECK((rmse ? good.check.after.rmse <= good.check.before.rmse : good.check.after.eq14 <= good.check.before.eq14));
	}
	// Fitted to a single point.
	settings.views = settings.per_view = settings.by_area = 1;
	settings.pictures = {1, 0, 1};
	const CompensateResult bad = compensateVolumes(set, tracer, settings, {2, {}});
	CHECK(bad.refused);
	CHECK(bad.check.after.rmse > bad.check.before.rmse);
	CHECK(bad.curve.occlusion == Compensation::paper());
	CHECK(bad.curve.range == 1.0);
	CHECK(bad.ray_distance_m == Approx(1.0 / 0.6));
}

TEST_CASE("compensation: the points of pictures are a pixel apart, and on surfaces", "[compensate]")
{
	const Level level = builtinLevel("cornell");
	const Tracer tracer(level, {});
	PictureSettings settings{.views = 2, .per_view = 100};
	const std::vector<PictureTriple> triples = pictureTriples(tracer, settings, {});
	REQUIRE(triples.size() > 100);
	std::size_t near_by = 0;
	for (const PictureTriple& triple : triples)
	{
		const double step_m = glm::distance(triple.points[0].position, triple.points[1].position);
		near_by += triple.there[1] && step_m > 0.0 && step_m < 0.05 ? 1U : 0U;
		CHECK(glm::length(triple.points[2].normal) == Approx(1.0));
	}
	CHECK(10 * near_by > 9 * triples.size());
	settings.views = 0;
	CHECK(pictureTriples(tracer, settings, {}).empty());
}
