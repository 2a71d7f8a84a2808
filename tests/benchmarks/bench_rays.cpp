// SPDX-License-Identifier: GPL-3.0-or-later
// The reference's rays beside bare Embree, and its directions beside stratified ones.
//   nook_bench_rays [LEVEL…]   default builtin:courtyard
// First table: millions of rays a second on one thread and on all, the same rays in every row: Embree's calls in bare loops over
// rays that lie ready in memory, and nook's whole reference (directions made, turned, traced, summed, standard errors). Second
// table: the error of one pixel at 16 to 256 rays against 8192 rays.
#include "core/math.h"
#include "core/parallel.h"
#include "core/random.h"
#include "scene/camera_choice.h"
#include "scene/gbuffer.h"
#include "scene/load.h"
#include "scene/reference.h"
#include "scene/sample_set.h"

#include <embree3/rtcore.h>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

namespace
{

using namespace nook;

constexpr int kWidth = 160;
constexpr int kHeight = 90;
constexpr int kRepeats = 5;

double secondsOf(const std::function<void()>& work)
{
	const auto start = std::chrono::steady_clock::now();
	work();
	return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// Rays as Embree takes them, all opaque triangles of the level around its centre.
class BareEmbree
{
public:
	explicit BareEmbree(const Level& level)
	{
		const Bounds bounds = boundsOf(level);
		m_centre = 0.5 * (bounds.least + bounds.most);
		for (const glm::dvec3& position : level.positions)
		{
			const glm::vec3 p(position - m_centre);
			m_vertices.insert(m_vertices.end(), {p.x, p.y, p.z});
		}
		m_vertices.push_back(0.0F);
		for (std::size_t i = 0; i < level.triangles.size(); ++i)
		{
			if (level.material_list[level.materials[i]].alpha_mode == AlphaMode::opaque)
			{
				m_corners.push_back(level.triangles[i]);
			}
		}
		m_device = rtcNewDevice(nullptr);
		m_scene = rtcNewScene(m_device);
		rtcSetSceneFlags(m_scene, RTC_SCENE_FLAG_ROBUST);
		RTCGeometry geometry = rtcNewGeometry(m_device, RTC_GEOMETRY_TYPE_TRIANGLE);
		rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, m_vertices.data(), 0, 12,
								   level.positions.size());
		rtcSetSharedGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, m_corners.data(), 0, 12, m_corners.size());
		rtcCommitGeometry(geometry);
		rtcAttachGeometry(m_scene, geometry);
		rtcReleaseGeometry(geometry);
		rtcCommitScene(m_scene);
	}
	BareEmbree(const BareEmbree&) = delete;
	BareEmbree& operator=(const BareEmbree&) = delete;
	~BareEmbree()
	{
		rtcReleaseScene(m_scene);
		rtcReleaseDevice(m_device);
	}

	glm::dvec3 centre() const
	{
		return m_centre;
	}
	RTCScene scene() const
	{
		return m_scene;
	}

private:
	glm::dvec3 m_centre{};
	std::vector<float> m_vertices;
	std::vector<glm::uvec3> m_corners;
	RTCDevice m_device = nullptr;
	RTCScene m_scene = nullptr;
};

struct Scene
{
	LoadedLevel loaded;
	RunSettings run;
	Tracer tracer;
	GBuffer gbuffer;

	explicit Scene(const std::string& name)
		: loaded(loadLevel(name, {}, all())), run(all()), tracer(loaded.level, run),
		  gbuffer(castGBuffer(tracer, view(), kWidth, kHeight, NormalKind::geometric, run))
	{
	}

	static RunSettings all()
	{
		return {availableThreads(), {}};
	}
	View view() const
	{
		const std::vector<LevelCamera>& cameras = loaded.level.cameras;
		return viewOf(cameras.empty() ? chooseCameras(tracer, 1, run)[0] : cameras[0], kWidth, kHeight);
	}
};

// The rays of every pixel with a surface, as the reference makes them.
std::vector<std::vector<RTCRay>> raysOf(const Scene& scene, const BareEmbree& bare, int count, float radius_m)
{
	const SampleSet set(SampleDomain::hemisphere, count);
	const Projector projector(scene.gbuffer.view.projection, kWidth, kHeight);
	const glm::dmat4 world_from_camera = glm::inverse(scene.gbuffer.view.camera_from_world);
	const auto n = static_cast<std::size_t>(count);
	std::vector<float> x(n);
	std::vector<float> y(n);
	std::vector<float> z(n);
	std::vector<std::vector<RTCRay>> bundles;
	for (std::size_t pixel = 0; pixel < scene.gbuffer.depth.size(); ++pixel)
	{
		if (!std::isfinite(scene.gbuffer.depth[pixel]))
		{
			continue;
		}
		const glm::dvec3 at =
			positionOf(scene.gbuffer, projector, static_cast<int>(pixel) % kWidth, static_cast<int>(pixel) / kWidth);
		const glm::dvec3 normal = glm::dmat3(world_from_camera) * glm::dvec3(scene.gbuffer.normals[pixel]);
		const glm::dvec3 tangent =
			glm::normalize(glm::cross(normal, std::fabs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
		const glm::dvec3 bitangent = glm::cross(normal, tangent);
		const glm::vec3 origin(glm::dvec3(world_from_camera * glm::dvec4(at, 1.0)) - bare.centre() + 1e-3 * normal);
		Random random(1, pixel);
		set.place(random, x, y, z);
		std::vector<RTCRay> rays(n);
		for (std::size_t i = 0; i < n; ++i)
		{
			const glm::vec3 d(static_cast<double>(x[i]) * tangent + static_cast<double>(y[i]) * bitangent +
							  static_cast<double>(z[i]) * normal);
			rays[i] = RTCRay{origin.x, origin.y, origin.z, 0.0F, d.x, d.y, d.z, 0.0F, radius_m, ~0U, 0, 0};
		}
		bundles.push_back(std::move(rays));
	}
	return bundles;
}

void streamOf(RTCScene scene, std::vector<RTCRay>& rays, RTCIntersectContextFlags flags)
{
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	context.flags = flags;
	rtcOccluded1M(scene, &context, rays.data(), static_cast<unsigned>(rays.size()), sizeof(RTCRay));
}

void packetsOf(RTCScene scene, std::vector<RTCRay>& rays)
{
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	alignas(64) int valid[16];
	alignas(64) RTCRay16 packet;
	for (std::size_t first = 0; first < rays.size(); first += 16)
	{
		for (std::size_t i = 0; i < 16; ++i)
		{
			const RTCRay& ray = rays[std::min(first + i, rays.size() - 1)];
			valid[i] = first + i < rays.size() ? -1 : 0;
			packet.org_x[i] = ray.org_x;
			packet.org_y[i] = ray.org_y;
			packet.org_z[i] = ray.org_z;
			packet.dir_x[i] = ray.dir_x;
			packet.dir_y[i] = ray.dir_y;
			packet.dir_z[i] = ray.dir_z;
			packet.tnear[i] = 0.0F;
			packet.tfar[i] = ray.tfar;
			packet.time[i] = 0.0F;
			packet.mask[i] = ~0U;
			packet.id[i] = 0;
			packet.flags[i] = 0;
		}
		rtcOccluded16(valid, scene, &context, &packet);
		for (std::size_t i = 0; i < 16 && first + i < rays.size(); ++i)
		{
			rays[first + i].tfar = packet.tfar[i];
		}
	}
}

void singlesOf(RTCScene scene, std::vector<RTCRay>& rays)
{
	RTCIntersectContext context;
	rtcInitIntersectContext(&context);
	for (RTCRay& ray : rays)
	{
		rtcOccluded1(scene, &context, &ray);
	}
}

struct Form
{
	const char* name;
	void (*trace)(RTCScene, std::vector<RTCRay>&);
};
const Form kForms[] = {
	{"stream",
	 [](RTCScene scene, std::vector<RTCRay>& rays)
	 {
		 streamOf(scene, rays, RTC_INTERSECT_CONTEXT_FLAG_INCOHERENT);
	 }},
	{"stream, coherent",
	 [](RTCScene scene, std::vector<RTCRay>& rays)
	 {
		 streamOf(scene, rays, RTC_INTERSECT_CONTEXT_FLAG_COHERENT);
	 }},
	{"packets of 16", packetsOf},
	{"single rays", singlesOf},
};

// Least seconds of some repeats, all forms taking turns, so that a busy machine hits all alike.
void printRates(const Scene& scene, const BareEmbree& bare, int threads, int count, float radius_m)
{
	const std::vector<std::vector<RTCRay>> fresh = raysOf(scene, bare, count, radius_m);
	const double rays = static_cast<double>(fresh.size()) * count;
	ReferenceSettings settings;
	settings.radius_m = static_cast<double>(radius_m);
	settings.rays = count;
	const RunSettings run{threads, {}};
	std::vector<double> best(std::size(kForms) + 1, 1e300);
	for (int repeat = 0; repeat < kRepeats; ++repeat)
	{
		for (std::size_t form = 0; form < std::size(kForms); ++form)
		{
			std::vector<std::vector<RTCRay>> bundles = fresh;
			constexpr std::size_t kChunk = 256;
			const std::size_t chunks = (bundles.size() + kChunk - 1) / kChunk;
			std::atomic<std::size_t> blocked = 0;
			const auto chunk = [&](std::size_t c)
			{
				std::size_t count_here = 0;
				for (std::size_t i = c * kChunk; i < std::min(bundles.size(), (c + 1) * kChunk); ++i)
				{
					kForms[form].trace(bare.scene(), bundles[i]);
					count_here += static_cast<std::size_t>(
						std::count_if(bundles[i].begin(), bundles[i].end(), [](const RTCRay& ray) { return ray.tfar < 0.0F; }));
				}
				blocked += count_here;
			};
			best[form] = std::min(best[form], secondsOf([&] { parallelFor(chunks, threads, chunk); }));
		}
		best.back() = std::min(best.back(), secondsOf([&] { referenceOfGBuffer(&scene.tracer, scene.gbuffer, settings, run); }));
	}
	std::printf("%8d %5d %8.3g", threads, count, static_cast<double>(radius_m));
	for (const double seconds : best)
	{
		std::printf(" %17.2f", 1e-6 * rays / seconds);
	}
	std::printf(" %17.2f\n", best[0] / best.back());
}

// Jittered k × k strata of the same measure, turned by a random angle.
double stratified(const Tracer& tracer, glm::dvec3 origin, glm::dvec3 normal, int side, float radius_m, Random& random)
{
	const glm::dvec3 tangent =
		glm::normalize(glm::cross(normal, std::fabs(normal.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0)));
	const glm::dvec3 bitangent = glm::cross(normal, tangent);
	const auto n = static_cast<std::size_t>(side) * static_cast<std::size_t>(side);
	std::vector<float> x(n);
	std::vector<float> y(n);
	std::vector<float> z(n);
	std::vector<uint8_t> blocked(n);
	for (std::size_t i = 0; i < n; ++i)
	{
		const double area = (static_cast<double>(i / static_cast<std::size_t>(side)) + random.uniform()) / side;
		const SinCos a = sinCosOf(2.0 * kPi * (static_cast<double>(i % static_cast<std::size_t>(side)) + random.uniform()) / side);
		const glm::dvec3 d = std::sqrt(area) * (a.cos * tangent + a.sin * bitangent) + std::sqrt(1.0 - area) * normal;
		x[i] = static_cast<float>(d.x);
		y[i] = static_cast<float>(d.y);
		z[i] = static_cast<float>(d.z);
	}
	tracer.blocked(origin, {x, y, z}, radius_m, blocked);
	return 1.0 - static_cast<double>(std::count(blocked.begin(), blocked.end(), uint8_t{1})) / static_cast<double>(n);
}

void printErrors(const Scene& scene, double radius_m)
{
	ReferenceSettings settings;
	settings.radius_m = radius_m;
	settings.rays = 8192;
	settings.seed = 100;
	const std::vector<ReferenceValue> truth = referenceOfGBuffer(&scene.tracer, scene.gbuffer, settings, scene.run);
	const Projector projector(scene.gbuffer.view.projection, kWidth, kHeight);
	const glm::dmat4 world_from_camera = glm::inverse(scene.gbuffer.view.camera_from_world);
	for (const int side : {4, 8, 16})
	{
		settings.rays = side * side;
		settings.seed = 1;
		const std::vector<ReferenceValue> ours = referenceOfGBuffer(&scene.tracer, scene.gbuffer, settings, scene.run);
		double our_squares = 0.0;
		double stated_squares = 0.0;
		double their_squares = 0.0;
		std::size_t beyond = 0;
		std::size_t points = 0;
		for (std::size_t pixel = 0; pixel < ours.size(); ++pixel)
		{
			if (ours[pixel].rays == 0)
			{
				continue;
			}
			const glm::dvec3 at =
				positionOf(scene.gbuffer, projector, static_cast<int>(pixel) % kWidth, static_cast<int>(pixel) / kWidth);
			const glm::dvec3 normal = glm::dmat3(world_from_camera) * glm::dvec3(scene.gbuffer.normals[pixel]);
			const glm::dvec3 origin = glm::dvec3(world_from_camera * glm::dvec4(at, 1.0)) + 2.0 * scene.tracer.error() * normal;
			Random random(7, pixel);
			const double theirs = stratified(scene.tracer, origin, normal, side, static_cast<float>(radius_m), random);
			const double our_error = ours[pixel].visibility - truth[pixel].visibility;
			our_squares += our_error * our_error;
			stated_squares += ours[pixel].standard_error * ours[pixel].standard_error;
			their_squares += (theirs - truth[pixel].visibility) * (theirs - truth[pixel].visibility);
			beyond += std::fabs(our_error) > 3.0 * ours[pixel].standard_error ? 1U : 0U;
			points += 1;
		}
		const auto n = static_cast<double>(points);
		std::printf("%5d %8.3g %12.5f %12.5f %8.3f %14.5f %18.3f %%\n", side * side, radius_m, std::sqrt(our_squares / n),
					std::sqrt(their_squares / n), std::sqrt(our_squares / their_squares), std::sqrt(stated_squares / n),
					100.0 * static_cast<double>(beyond) / n);
	}
}

} // namespace

int main(int argc, char** argv)
{
	std::vector<std::string> names(argv + 1, argv + argc);
	if (names.empty())
	{
		names = {"builtin:courtyard"};
	}
	try
	{
		for (const std::string& name : names)
		{
			const Scene scene(name);
			const BareEmbree bare(scene.loaded.level);
			std::printf("%s, %zu triangles, %dx%d pixels\n", scene.loaded.level.name.c_str(), scene.loaded.level.triangles.size(),
						kWidth, kHeight);
			std::printf("Millions of rays a second\n%8s %5s %8s", "threads", "rays", "radius");
			for (const Form& form : kForms)
			{
				std::printf(" %17s", form.name);
			}
			std::printf(" %17s %17s\n", "nook reference", "nook / stream");
			for (int threads = 1; threads <= scene.run.threads; threads *= 2)
			{
				for (const int count : {64, 256})
				{
					printRates(scene, bare, threads, count, 1.5F);
				}
				printRates(scene, bare, threads, 256, std::numeric_limits<float>::infinity());
			}
			std::printf("Error of a pixel\n%5s %8s %12s %12s %8s %14s %20s\n", "rays", "radius", "nook", "stratified", "ratio",
						"stated error", "beyond 3 of those");
			printErrors(scene, 1.5);
			printErrors(scene, std::numeric_limits<double>::infinity());
		}
	}
	catch (const std::exception& error)
	{
		std::fprintf(stderr, "nook_bench_rays: %s\n", error.what());
		return 1;
	}
	return 0;
}
