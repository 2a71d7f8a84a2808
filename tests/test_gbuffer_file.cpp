// SPDX-License-Identifier: GPL-3.0-or-later
#include "small_gbuffers.h"
#include "testing.h"

#include "methods/block.h"
#include "scene/gbuffer.h"
#include "shade/shade.h"

#include <glm/mat3x3.hpp>

namespace
{

constexpr float kSky = std::numeric_limits<float>::infinity();

// A temporary file for one test.
struct ScratchFile
{
	TemporaryFolder folder;
	std::string path = folder / "g.exr";

	explicit ScratchFile(std::string_view bytes)
	{
		writeFile(path, bytes);
	}
	explicit ScratchFile(const Image& image) : ScratchFile(exrBytes(image)) {}
};

// A G-buffer of 8 × 6 pixels with sky, depth and normals.
GBuffer small()
{
	const glm::dvec3 normal = glm::normalize(glm::dvec3(0.2, 0.5, 1.0));
	GBuffer gbuffer = made(8, 6, projectionOf(Lens(), 8.0 / 6.0), plane(normal, -4.0));
	gbuffer.depth[5] = kSky;
	normalsFromDepth(gbuffer);
	return gbuffer;
}

ImageMatrix matrixNamed(const std::string& key, const glm::dmat4& m)
{
	ImageMatrix matrix{key, {}, false};
	for (int i = 0; i < 16; ++i)
	{
		matrix.values[static_cast<std::size_t>(i)] = m[i / 4][i % 4];
	}
	return matrix;
}

// A file as from an engine: channels with given names, matrices under the usual names.
Image foreign(int width, int height, std::vector<std::string> channels, std::vector<float> values)
{
	Image image{width, height, std::move(channels), std::move(values), {}, {}, false};
	image.matrices = {matrixNamed("worldToCamera", someView()),
					  matrixNamed("projection", projectionOf(Lens(), static_cast<double>(width) / height))};
	return image;
}

GBuffer readBack(const Image& image, const GBufferImport& import)
{
	return readGBuffer(ScratchFile(image).path, import);
}

GBufferImport fromDepth()
{
	GBufferImport import;
	import.normals_from_depth = true;
	return import;
}

// Greatest distance of a normal from `normal` among the pixels with a neighbour on each axis.
double worstError(const GBuffer& gbuffer, const glm::dvec3& normal)
{
	const auto there = [&](int x, int y)
	{
		return x >= 0 && y >= 0 && x < gbuffer.width_px && y < gbuffer.height_px &&
			   std::isfinite(gbuffer.depth[static_cast<std::size_t>(y * gbuffer.width_px + x)]);
	};
	double worst = -1.0; // fails for a picture without such pixels
	for (int y = 0; y < gbuffer.height_px; ++y)
	{
		for (int x = 0; x < gbuffer.width_px; ++x)
		{
			const bool across = there(x - 1, y) || there(x + 1, y) || gbuffer.width_px == 1;
			const bool along = there(x, y - 1) || there(x, y + 1) || gbuffer.height_px == 1;
			if (there(x, y) && across && along)
			{
				const glm::dvec3 found(gbuffer.normals[static_cast<std::size_t>(y * gbuffer.width_px + x)]);
				worst = std::max(worst, glm::length(found - normal));
			}
		}
	}
	return worst;
}

} // namespace

TEST_CASE("scene: a G-buffer file reads back bit for bit", "[gbuffer]")
{
	GBuffer gbuffer = small();
	gbuffer.view.camera_from_world[3] = {148376.123456789, 1234.567890123, -223423.987654321, 1.0};
	const std::string bytes = gbufferBytes(gbuffer, {{"command", "nook gbuffer"}});
	CHECK(bytes == gbufferBytes(gbuffer, {{"command", "nook gbuffer"}}));
	const GBuffer back = readGBuffer(ScratchFile(bytes).path, {});
	CHECK(back.width_px == 8);
	CHECK(back.height_px == 6);
	CHECK(back.depth == gbuffer.depth);
	CHECK(back.view.camera_from_world == gbuffer.view.camera_from_world);
	CHECK(back.view.projection == gbuffer.view.projection);
	CHECK(back.view_error_m == 0.0);
	for (std::size_t i = 0; i < back.normals.size(); ++i)
	{
		CHECK(glm::length(back.normals[i] - gbuffer.normals[i]) < 1e-6F);
	}
	CHECK(back.normals[5] == glm::vec3(0.0F));
	const Image image = decodeImage(bytes, "g.exr");
	CHECK(image.channel("Z") >= 0);
	CHECK(image.matrix("worldToCamera") != nullptr);
	CHECK(image.matrix("worldToNDC") != nullptr);
	CHECK_FALSE(image.matrix("projection")->wide);
	CHECK(image.matrix("projection64")->wide);
}

TEST_CASE("scene: matrices of 32 bits say by how much they are off", "[gbuffer]")
{
	GBuffer gbuffer = small();
	gbuffer.view.camera_from_world[3] = {148376.123456789, 1234.567890123, -223423.987654321, 1.0};
	Image image = decodeImage(gbufferBytes(gbuffer, {}), "g.exr");
	std::erase_if(image.matrices, [](const ImageMatrix& m) { return m.wide; });
	const GBuffer back = readBack(image, {});
	CHECK(back.view_error_m > 0.01);
	CHECK(back.view_error_m < 0.1);
	const glm::dvec4 seen(1.0, 2.0, -5.0, 1.0);
	const double moved = glm::length(glm::dvec3(glm::inverse(back.view.camera_from_world) * seen) -
									 glm::dvec3(glm::inverse(gbuffer.view.camera_from_world) * seen));
	CHECK(moved > 0.0);
	CHECK(moved <= back.view_error_m);
	// Command line values are not rounded.
	GBufferImport import;
	import.camera_from_world = gbuffer.view.camera_from_world;
	CHECK(readBack(image, import).view_error_m == 0.0);
}

TEST_CASE("scene: depth is found under the names that programs give it", "[gbuffer]")
{
	const auto found = [](std::vector<std::string> channels, const std::string& wanted = "")
	{
		Image image;
		image.channels = std::move(channels);
		return image.channels[static_cast<std::size_t>(depthChannel(image, "a.exr", wanted))];
	};
	CHECK(found({"B", "G", "R", "Z"}) == "Z");
	CHECK(found({"Depth.Z", "Z"}) == "Z");
	CHECK(found({"ViewLayer.Combined.R", "ViewLayer.Depth.Z", "ViewLayer.Normal.X", "ViewLayer.Normal.Y", "ViewLayer.Normal.Z"}) ==
		  "ViewLayer.Depth.Z");
	CHECK(found({"ViewLayer.Depth.Z", "ViewLayer.Mist.Z"}) == "ViewLayer.Depth.Z");
	CHECK(found({"R", "G", "B", "depth"}) == "depth");
	CHECK(found({"N.X", "N.Y", "N.Z", "beauty.Z"}) == "beauty.Z");
	CHECK(found({"Depth.V"}) == "Depth.V");
	CHECK(found({"Depth.B", "Depth.G", "Depth.R"}) == "Depth.R");
	CHECK(found({"Y"}) == "Y");
	CHECK(found({"a", "b"}, "b") == "b");
	CHECK_THROWS_WITH(found({"a", "b"}), Catch::Contains("a.exr: channels: found a, b, expected one that is depth"));
	CHECK_THROWS_WITH(found({"a", "b"}, "c"), Catch::Contains("found a, b, expected c among them"));
	CHECK_THROWS_WITH(found({"L.depth", "M.depth"}), Catch::Contains("expected one alone"));
	CHECK_THROWS_WITH(found({"N.X", "N.Y", "N.Z"}), Catch::Contains("expected one that is depth"));
}

TEST_CASE("scene: device depth of any projection becomes metres", "[gbuffer]")
{
	const NamedProjection projection = GENERATE(from_range(projections(4.0 / 3.0)));
	INFO(projection.name);
	const GBuffer truth = made(8, 6, projection.matrix, plane(glm::normalize(glm::dvec3(0.1, 0.4, 1.0)), -4.0));
	const Projector projector(projection.matrix, 8, 6);
	std::vector<float> device;
	for (std::size_t i = 0; i < truth.depth.size(); ++i)
	{
		const ViewLine line = projector.lineOf({static_cast<double>(i % 8) + 0.5, static_cast<double>(i / 8) + 0.5});
		const glm::dvec4 clip = projection.matrix * glm::dvec4(line.at + static_cast<double>(truth.depth[i]) * line.along, 1.0);
		const double z = clip.z / clip.w;
		device.push_back(static_cast<float>(projection.clip == ClipRange::zero_to_one ? z : 0.5 * z + 0.5));
	}
	const bool reversed = std::string(projection.name).find("reversed") == 0;
	device[3] = reversed ? 0.0F : 1.0F; // clear value
	GBufferImport import = fromDepth();
	import.depth = DepthKind::device;
	import.clip = projection.clip;
	import.projection = projection.matrix;
	const GBuffer read = readBack(foreign(8, 6, {"Z"}, device), import);
	CHECK(read.depth[3] == kSky);
	for (std::size_t i = 0; i < read.depth.size(); ++i)
	{
		if (i != 3)
		{
			// 32 bits of device depth near 1 are 0.1 mm at 4 m with a near plane at 0.1 m.
			CHECK(read.depth[i] == Approx(truth.depth[i]).epsilon(1e-4));
		}
	}
}

TEST_CASE("scene: depth says by how much its numbers may be off", "[gbuffer]")
{
	const std::vector<float> metres(4, 5.0F);
	CHECK(readBack(foreign(2, 2, {"Z"}, metres), fromDepth()).depth_error_m.empty());
	// A depth_error channel in the file is used, and copied to the converted file.
	Image image = foreign(2, 2, {"Z", "depth_error"}, {5.0F, 0.1F, 5.0F, 0.2F, 5.0F, 0.0F, kSky, 7.0F});
	const GBuffer with_error = readBack(image, fromDepth());
	CHECK(with_error.depth_error_m == std::vector<float>{0.1F, 0.2F, 0.0F, 0.0F});
	CHECK(with_error.view_error_m > 0.0);
	const GBuffer again = readGBuffer(ScratchFile(gbufferBytes(with_error, {})).path, {});
	CHECK(again.depth_error_m == with_error.depth_error_m);
	CHECK(again.view_error_m == with_error.view_error_m);
	image.values[1] = -0.1F;
	CHECK_THROWS_WITH(readBack(image, fromDepth()), Catch::Contains("channel depth_error, pixel 0,0: found -0.1"));
	// Half floats: 11 binary digits.
	image = foreign(2, 2, {"Z"}, metres);
	image.halves = {1};
	CHECK(gbufferFrom(image, "half", fromDepth()).depth_error_m == std::vector<float>(4, 5.0F / 2048.0F));
	// A depth buffer with its near plane at 0.1 m: depth² / near × half a step, twice that for floats near 1.
	const auto deviceError = [&](double steps)
	{
		GBufferImport import = fromDepth();
		import.depth = DepthKind::device;
		std::vector<float> device(4, static_cast<float>(steps > 0.0 ? std::floor(0.98 * steps) / steps : 0.0123456));
		const GBuffer read = readBack(foreign(2, 2, {"Z"}, device), import);
		return std::pair(static_cast<double>(read.depth_error_m[0]), static_cast<double>(read.depth[0]));
	};
	const auto [coarse, coarse_depth] = deviceError(65535.0);
	CHECK(coarse == Approx(0.5 / 65535.0 * coarse_depth * coarse_depth / 0.1).epsilon(0.02));
	const auto [fine, fine_depth] = deviceError(16777215.0);
	CHECK(fine == Approx(2.5 * 0x1p-24 * fine_depth * fine_depth / 0.1).epsilon(0.05));
	const auto [floats, floats_depth] = deviceError(0.0);
	const double exact = 0.0123456 * 0x1p-23 * floats_depth * floats_depth / 0.1;
	CHECK(floats >= exact);
	CHECK(floats <= exact + floats_depth * 0x1p-23);
}

TEST_CASE("scene: linear depth, distances, and what is sky", "[gbuffer]")
{
	const float inf = std::numeric_limits<float>::infinity();
	const std::vector<float> values{2.0F, 3.0F, 4.0F, 5.0F, inf, 1e10F, 1e30F, 65504.0F, 7.0F};
	GBufferImport import = fromDepth();
	GBuffer read = readBack(foreign(3, 3, {"Z"}, values), import);
	CHECK(read.depth == std::vector<float>{2.0F, 3.0F, 4.0F, 5.0F, inf, inf, inf, 65504.0F, 7.0F});
	import.sky_depth_m = 65504.0;
	CHECK(readBack(foreign(3, 3, {"Z"}, values), import).depth[7] == inf);
	import.depth = DepthKind::distance;
	read = readBack(foreign(3, 3, {"Z"}, values), import);
	const Projector projector(read.view.projection, 3, 3);
	for (int i = 0; i < 9; ++i)
	{
		const auto pixel = static_cast<std::size_t>(i);
		if (std::isfinite(read.depth[pixel]))
		{
			const ViewLine line = projector.lineOf({i % 3 + 0.5, i / 3 + 0.5}); // NOLINT: whole numbers of pixels
			CHECK(glm::length(static_cast<double>(read.depth[pixel]) * line.along) == Approx(values[pixel]));
		}
	}

	// Found by fuzzing: the smallest distance has a depth along the view that rounds to 0 in 32 bits.
	Image near = foreign(3, 3, {"Z"}, std::vector<float>(9, std::numeric_limits<float>::denorm_min()));
	Lens wide{.fov_y_rad = 2.6};
	near.matrices[1] = matrixNamed("projection", projectionOf(wide, 1.0));
	CHECK_THROWS_AS(readBack(near, import), Error);
}

TEST_CASE("scene: normals of a file become unit and view space", "[gbuffer]")
{
	const glm::dvec3 normal = glm::normalize(glm::dvec3(0.3, -0.2, 0.9));
	const glm::dvec3 world = glm::transpose(glm::dmat3(someView())) * normal;
	const auto image = [](const glm::dvec3& n, const std::string& layer, const char* axes)
	{
		std::vector<std::string> channels{"Z"};
		for (int i = 0; i < 3; ++i)
		{
			channels.push_back(layer + "." + axes[i]);
		}
		return foreign(1, 1, channels, {4.0F, static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)});
	};
	const auto close = [&](const GBuffer& gbuffer)
	{
		return glm::length(glm::dvec3(gbuffer.normals[0]) - normal) < 1e-6;
	};
	GBufferImport import;
	CHECK(close(readBack(image(normal, "N", "XYZ"), import)));
	CHECK(close(readBack(image(0.9 * normal, "ViewLayer.Normal", "XYZ"), import)));
	CHECK(close(readBack(image(1.1 * normal, "normals", "rgb"), import)));
	import.normal_range = NormalRange::zero_to_one;
	CHECK(close(readBack(image(0.5 * normal + glm::dvec3(0.5), "N", "XYZ"), import)));
	import = {};
	import.normal_space = NormalSpace::world;
	import.normal_channels = "geo.normal";
	CHECK(close(readBack(image(world, "geo.normal", "XYZ"), import)));
}

TEST_CASE("scene: files that are no G-buffer are refused by their place", "[gbuffer]")
{
	const float nan = std::numeric_limits<float>::quiet_NaN();
	const auto refused = [](const Image& image, const GBufferImport& import, const std::string& text)
	{
		CHECK_THROWS_WITH(readBack(image, import), Catch::Contains(text));
	};
	const auto withDepth = [](float value)
	{
		return foreign(2, 2, {"Z"}, {1.0F, 1.0F, 1.0F, value});
	};
	refused(withDepth(nan), fromDepth(), "channel Z, pixel 1,1: found NaN, expected metres");
	refused(withDepth(0.0F), fromDepth(), "pixel 1,1: found 0, expected metres");
	refused(withDepth(-2.5F), fromDepth(), "pixel 1,1: found -2.5, expected metres");
	GBufferImport device = fromDepth();
	device.depth = DepthKind::device;
	refused(withDepth(1.5F), device, "pixel 1,1: found 1.5, expected device depth from 0 to 1");
	refused(withDepth(nan), device, "pixel 1,1: found NaN, expected device depth");
	// A reversed depth buffer read as OpenGL's: its far half would lie behind the camera.
	glm::dmat4 reversed = projectionOf(Lens(), 1.0);
	reversed[2][2] = 0.0;
	reversed[3][2] = 0.1;
	device.projection = reversed;
	refused(withDepth(0.25F), device, "behind the camera");

	Image image = withDepth(1.0F);
	image.matrices.clear();
	refused(image, fromDepth(), "projection: found none, expected");
	image.matrices = {matrixNamed("projection", projectionOf(Lens(), 1.0))};
	refused(image, fromDepth(), "worldToCamera: found none, expected");
	image.matrices.push_back(matrixNamed("worldToCamera", glm::dmat4(0.01)));
	refused(image, fromDepth(), "worldToCamera: found one that is not a rotation");
	glm::dmat4 mirrored(1.0);
	mirrored[2][2] = -1.0;
	image.matrices.back() = matrixNamed("worldToCamera", mirrored);
	refused(image, fromDepth(), "worldToCamera: found a mirrored matrix");
	image.matrices = {matrixNamed("projection", glm::dmat4(0.0)), matrixNamed("worldToCamera", glm::dmat4(1.0))};
	refused(image, fromDepth(), ".exr: projection: found a singular matrix");

	refused(withDepth(1.0F), {},
			"expected normals N.X, N.Y, N.Z (normal-channels names others), or from depth (normals from-depth)");
	const auto withNormal = [](float x, float y, float z)
	{
		return foreign(1, 2, {"Z", "N.X", "N.Y", "N.Z"}, {1.0F, 0.0F, 0.0F, 1.0F, 1.0F, x, y, z});
	};
	refused(withNormal(0.0F, 0.0F, 0.0F), {}, "normals N, pixel 0,1: found a length of 0, expected 1");
	refused(withNormal(nan, 0.0F, 0.0F), {}, "normals N, pixel 0,1: found a length of NaN");
	refused(withNormal(0.0F, 0.0F, 20.0F), {}, "normals N, pixel 0,1: found a length of 20");
	refused(foreign(1, 1, {"Z", "N.X", "N.Y", "N.Z"}, {1.0F, 0.0F, 0.0F, -1.0F}), {}, "100 % of them turned away from the camera");
}

TEST_CASE("scene: every truncation of a G-buffer file is refused", "[gbuffer]")
{
	const std::string bytes = gbufferBytes(small(), {});
	const auto refused = [](const std::string& name, const std::function<void()>& read)
	{
		return refusalBy(read).starts_with(name);
	};
	std::size_t accepted = 0;
	// The whole header, and then at intervals, since deflate is slow.
	const std::size_t step = std::max<std::size_t>(1, (bytes.size() - 200) / 40);
	for (std::size_t length = 0; length < bytes.size(); length += length < 200 ? 1 : step)
	{
		const std::string_view part = std::string_view(bytes).substr(0, length);
		accepted += refused("g.exr", [&] { decodeImage(part, "g.exr"); }) ? 0U : 1U;
	}
	CHECK(accepted == 0);
	for (std::size_t length = 0; length < bytes.size(); length += bytes.size() / 8) // each in its own process
	{
		const ScratchFile file(std::string_view(bytes).substr(0, length));
		INFO(length);
		CHECK(refused(file.path, [&] { readGBuffer(file.path, {}); }));
	}
}

TEST_CASE("scene: surfaces of a G-buffer as a mask", "[gbuffer]")
{
	const float inf = std::numeric_limits<float>::infinity();
	Image image{2, 2, {"Z"}, {1.0F, inf, 1e10F, 3.0F}, {}, {}, false};
	const SurfaceMask mask = readSurfaceMask(ScratchFile(image).path);
	CHECK(mask.width_px == 2);
	CHECK(mask.surface == std::vector<uint8_t>{1, 0, 0, 1});
	image.values[3] = -1.0F;
	CHECK_THROWS_WITH(readSurfaceMask(ScratchFile(image).path), Catch::Contains("channel Z, pixel 1,1: found -1"));
}

TEST_CASE("scene: normals from the depth of a plane are the plane's", "[gbuffer]")
{
	const NamedProjection projection = GENERATE(from_range(projections(1.5)));
	const double tilt_deg = GENERATE(0.0, 30.0, 60.0, 80.0);
	const double turn_deg = GENERATE(0.0, 50.0, 170.0, 290.0);
	INFO(projection.name << ", " << tilt_deg << ", " << turn_deg);
	const double tilt = tilt_deg * 0.0174532925199433;
	const double turn = turn_deg * 0.0174532925199433;
	const glm::dvec3 normal(std::sin(tilt) * std::cos(turn), std::sin(tilt) * std::sin(turn), std::cos(tilt));
	// At 5 m on the axis; further away for parallel rays, which would otherwise meet a plane of 80° behind the camera.
	const double offset = -5.0 * normal.z * (projection.matrix[3][3] == 1.0 ? 10.0 : 1.0);
	GBuffer gbuffer = made(48, 32, projection.matrix, plane(normal, offset));
	normalsFromDepth(gbuffer);
	const double worst = worstError(gbuffer, normal);
	CHECK(worst >= 0.0);
	CHECK(worst < 5e-4);
}

TEST_CASE("scene: normals from depth are right on both sides of an edge", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf({false, 1.0, 1.0, 0.1, 100.0}, 1.5);
	const glm::dvec3 near_normal = glm::normalize(glm::dvec3(0.5, 0.2, 1.0));
	const glm::dvec3 far_normal = glm::normalize(glm::dvec3(-0.3, 0.6, 1.0));
	const DepthOf near_plane = plane(near_normal, -2.0);
	const DepthOf far_plane = plane(far_normal, -6.0);
	// A slanted silhouette, and sky above the far plane's upper edge.
	const auto isNear = [](int x, int y)
	{
		return 2 * x + y < 60;
	};
	GBuffer gbuffer = made(48, 32, projection,
						   [&](int x, int y, const ViewLine& line)
						   {
							   if (y < 4) // gives each plane's uppermost pixels a neighbour below in the same plane
							   {
								   return std::numeric_limits<double>::infinity();
							   }
							   return isNear(x, y) ? near_plane(x, y, line) : far_plane(x, y, line);
						   });
	normalsFromDepth(gbuffer);
	int wrong = 0;
	for (int y = 4; y < 32; ++y)
	{
		for (int x = 0; x < 48; ++x)
		{
			const glm::dvec3 found(gbuffer.normals[static_cast<std::size_t>(48 * y + x)]);
			wrong += glm::length(found - (isNear(x, y) ? near_normal : far_normal)) > 1e-4 ? 1 : 0;
		}
	}
	CHECK(wrong == 0);
	CHECK(gbuffer.normals[0] == glm::vec3(0.0F));

	// Likewise where the surface is two pixels wide, with a step on either side.
	const DepthOf behind = plane({0.0, 0.0, 1.0}, -20.0);
	GBuffer strip = made(12, 12, projection,
						 [&](int x, int y, const ViewLine& line) {
							 return x == 5 || x == 6 ? near_plane(x, y, line) : x < 5 ? far_plane(x, y, line) : behind(x, y, line);
						 });
	normalsFromDepth(strip);
	for (int y = 0; y < 12; ++y)
	{
		for (const int x : {5, 6})
		{
			CHECK(glm::length(glm::dvec3(strip.normals[static_cast<std::size_t>(12 * y + x)]) - near_normal) < 1e-4);
		}
	}
}

TEST_CASE("scene: normals from depth where there is little to go by", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf(Lens(), 1.0);
	// An isolated pixel faces the camera.
	GBuffer alone =
		made(5, 5, projection,
			 [](int x, int y, const ViewLine&) { return x == 1 && y == 3 ? 2.0 : std::numeric_limits<double>::infinity(); });
	normalsFromDepth(alone);
	const Projector projector(projection, 5, 5);
	CHECK(glm::length(glm::dvec3(alone.normals[16]) + glm::normalize(projector.lineOf({1.5, 3.5}).along)) < 1e-6);
	CHECK(alone.normals[15] == glm::vec3(0.0F));

	// A single column knows only its vertical slope, and faces the camera otherwise.
	const glm::dvec3 normal = glm::normalize(glm::dvec3(0.0, 1.0, 1.0));
	GBuffer column = made(1, 9, projection, plane(normal, -3.0));
	normalsFromDepth(column);
	const double worst_of_column = worstError(column, normal);
	CHECK(worst_of_column >= 0.0);
	CHECK(worst_of_column < 1e-4);

	GBuffer single = made(1, 1, projection, plane(normal, -3.0));
	normalsFromDepth(single);
	CHECK(glm::length(single.normals[0] - glm::vec3(0.0F, 0.0F, 1.0F)) < 1e-6F);

	GBuffer sky = made(4, 4, projection, [](int, int, const ViewLine&) { return std::numeric_limits<double>::infinity(); });
	normalsFromDepth(sky);
	CHECK(sky.normals == std::vector<glm::vec3>(16, glm::vec3(0.0F)));
}

TEST_CASE("scene: normals from depth are the same on any number of threads, and face the camera", "[gbuffer]")
{
	const glm::dmat4 projection = projectionOf({false, 1.4, 1.0, 0.1, 100.0}, 1.5);
	GBuffer one =
		made(48, 32, projection,
			 [](int x, int y, const ViewLine&) { return 3.0 + std::sin(0.4 * x) * std::cos(0.3 * y) + (x % 7 == 0 ? 2.0 : 0.0); });
	GBuffer many = one;
	normalsFromDepth(one);
	RunSettings run;
	run.threads = 5;
	normalsFromDepth(many, run);
	CHECK(one.normals == many.normals);
	const Projector projector(projection, 48, 32);
	for (int i = 0; i < 48 * 32; ++i)
	{
		const glm::dvec3 normal(one.normals[static_cast<std::size_t>(i)]);
		const ViewLine line = projector.lineOf({i % 48 + 0.5, i / 48 + 0.5}); // NOLINT: whole numbers of pixels
		CHECK(glm::dot(normal, line.along) <= 0.0);
		CHECK(glm::length(normal) == Approx(1.0));
	}
}

TEST_CASE("scene: the kernel's normals from depth are those of the file's", "[gbuffer]")
{
	const NamedProjection projection = GENERATE(from_range(projections(1.5)));
	INFO(projection.name);
	GBuffer gbuffer = made(48, 32, projection.matrix,
						   [](int x, int y, const ViewLine&)
						   {
							   return x > 40
										  ? std::numeric_limits<double>::infinity()
										  : 3.0 + std::sin(0.4 * x) * std::cos(0.3 * y) + (x % 7 == 0 ? 2.0 : 0.0) + 0.01 * x * y;
						   });
	normalsFromDepth(gbuffer);
	const std::vector<float> depths = finiteDepths(gbuffer);
	shade_kernels::Kernels kernels;
	fillCamera(kernels.nook, gbuffer.view.projection, 48, 32);
	kernels.depths = depths;
	int off = 0;
	for (int i = 0; i < 48 * 32; ++i)
	{
		const auto at = static_cast<std::size_t>(i);
		if (std::isfinite(gbuffer.depth[at]))
		{
			off += glm::length(kernels.nookNormalFromDepth({i % 48, i / 48}) - gbuffer.normals[at]) > 1e-3F ? 1 : 0;
		}
	}
	CHECK(off <= 2); // both sides continue equally badly
}
