// SPDX-License-Identifier: GPL-3.0-or-later
// Visibility in a texture compared with rays; charts and their edges.
#include "bake_levels.h"
#include "level_files.h"
#include "testing.h"

#include "bake/texture.h"
#include "scene/level_glb.h"

#include <tuple>

namespace
{

// A floor with its chart in the left half of the texture, and the six faces of a box in the right half.
Level floorAndBoxWithCharts()
{
	Level level = emptyLevel();
	addQuad(level, {-1.0, 0.0, 1.0}, {2.0, 0.0, 0.0}, {0.0, 0.0, -2.0});
	addBox(level, {-0.3, 0.0, -0.3}, {0.3, 0.5, 0.3});
	for (std::size_t v = 0; v < level.uvs.size(); ++v)
	{
		const std::size_t quad = v / 4;
		const glm::vec2 corner = quad == 0 ? glm::vec2(0.02F, 0.02F)
										   : glm::vec2(0.52F + 0.24F * static_cast<float>((quad - 1) % 2),
													   0.02F + 0.32F * static_cast<float>((quad - 1) / 2));
		const glm::vec2 size = quad == 0 ? glm::vec2(0.46F, 0.46F) : glm::vec2(0.2F, 0.28F);
		level.uvs[v] = corner + size * level.uvs[v];
	}
	return level;
}

// Gives the material a mask of one texel.
void addMask(Level& level)
{
	level.material_list[0].alpha_mode = AlphaMode::mask;
	level.material_list[0].mask = 0;
	level.masks.push_back({"leaf", 1, 1, Wrap::repeat, Wrap::repeat, {255}});
	measureAlpha(level.material_list[0], level.masks);
}

// A quad at y = 0 and its other side at the same place, of two triangles each; the last one of the back is wound like the front.
// `differ` selects the sets, first and second, in which the back has other coordinates than the front; vertex v has the values v /
// 8 and 1 − v / 8.
std::string sheetGlb(const nlohmann::json& material, std::array<bool, 2> differ, bool second, bool baked)
{
	const std::array<glm::vec3, 4> corners{{{0, 0, 0}, {0, 0, 1}, {1, 0, 1}, {1, 0, 0}}};
	std::string buffer;
	for (std::size_t v = 0; v < 8; ++v)
	{
		append(buffer, corners[v % 4]);
	}
	for (const bool other : differ)
	{
		for (std::size_t v = 0; v < 8; ++v)
		{
			append(buffer, 0.5F * glm::vec2(corners[v % 4].x, corners[v % 4].z) + glm::vec2(other && v >= 4 ? 0.5F : 0.0F));
		}
	}
	for (std::size_t v = 0; v < 8; ++v)
	{
		append(buffer, static_cast<float>(v) / 8.0F);
	}
	for (const unsigned index : {0U, 1U, 2U, 0U, 2U, 3U, 4U, 6U, 5U, 4U, 6U, 7U})
	{
		append(buffer, static_cast<uint16_t>(index));
	}
	nlohmann::json json = parseJson(R"({
		"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], "nodes": [{"mesh": 0}],
		"meshes": [{"name": "sheet", "primitives": [{"attributes": {"POSITION": 0, "TEXCOORD_0": 1}, "indices": 4, "material": 0}]}],
		"accessors": [
			{"bufferView": 0, "componentType": 5126, "count": 8, "type": "VEC3", "min": [0, 0, 0], "max": [1, 0, 1]},
			{"bufferView": 1, "componentType": 5126, "count": 8, "type": "VEC2"},
			{"bufferView": 2, "componentType": 5126, "count": 8, "type": "VEC2"},
			{"bufferView": 3, "componentType": 5126, "count": 8, "type": "SCALAR"},
			{"bufferView": 4, "componentType": 5123, "count": 12, "type": "SCALAR"}],
		"bufferViews": [{"buffer": 0, "byteOffset": 0, "byteLength": 96}, {"buffer": 0, "byteOffset": 96, "byteLength": 64},
			{"buffer": 0, "byteOffset": 160, "byteLength": 64}, {"buffer": 0, "byteOffset": 224, "byteLength": 32},
			{"buffer": 0, "byteOffset": 256, "byteLength": 24}],
		"buffers": [{"byteLength": 280}]})",
									"a.gltf");
	json["materials"] = {material};
	nlohmann::json& attributes = json["meshes"][0]["primitives"][0]["attributes"];
	if (second)
	{
		attributes["TEXCOORD_1"] = 2;
	}
	if (baked)
	{
		attributes["_VISIBILITY"] = 3;
	}
	return glbBytes(json, buffer);
}

} // namespace

TEST_CASE("bake: a texture agrees with rays, and charts do not bleed", "[bake]")
{
	const Level level = floorAndBoxWithCharts();
	const Tracer tracer(level, {});
	const BakeSettings settings = within(0.5);
	const auto bakeWith = [&](int threads)
	{
		std::vector<TextureBake> pages{bakeTexture(tracer, level.uvs, 128, settings, {threads, {}})};
		finishTextures(level, level.uvs, {}, pages, threads);
		return pages.front();
	};
	const TextureBake bake = bakeWith(1);
	CHECK(bake.charts == 7);
	CHECK(bake.missed == 0);
	CHECK(bake.shared == 0);
	CHECK(bake.buried > 0);
	CHECK(bake.covered > 128 * 128 / 4);
	const BakeCheck check = checkTexture(tracer, level.uvs, {&bake, 1}, {}, settings, 1000, {});
	CAPTURE(check.rmse, check.bias);
	CHECK(check.rmse < 0.04);
	CHECK(std::fabs(check.bias) < 0.005);
	CHECK(bakeWith(2).values == bake.values);
	// The floor's corner is open, and so are the texels just outside its chart.
	CHECK(bake.values[0] > 230);
	CHECK(bake.values[128 + 1] > 230);
}

TEST_CASE("bake: both sides of a smooth seam have the same values, and creases stay sharp", "[bake]")
{
	// A floor of two halves with charts of their own, one of them turned by 90 degrees and smaller, and a wall at the end of the
	// other.
	Level level = emptyLevel();
	addQuad(level, {-1.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -2.0});
	addQuad(level, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}, {0.0, 0.0, -2.0});
	addQuad(level, {-1.0, 0.0, -1.0}, {1.0, 0.0, 0.0}, {0.0, 1.0, 0.0});
	const auto place = [&level](std::size_t quad, glm::vec2 corner, glm::vec2 u, glm::vec2 v)
	{
		for (std::size_t i = 4 * quad; i < 4 * quad + 4; ++i)
		{
			level.uvs[i] = corner + level.uvs[i].x * u + level.uvs[i].y * v;
		}
	};
	place(0, {0.05F, 0.05F}, {0.24F, 0.0F}, {0.0F, 0.48F});
	place(1, {0.9F, 0.05F}, {0.0F, 0.2F}, {-0.4F, 0.0F});
	place(2, {0.05F, 0.6F}, {0.6F, 0.0F}, {0.0F, 0.3F});
	const Tracer tracer(level, {});
	BakeSettings settings = within(0.5);
	settings.rays = 16; // noise that differs on both sides
	std::vector<TextureBake> joined{bakeTexture(tracer, level.uvs, 128, settings, {})};
	TextureBake apart = joined.front();
	fillEmpty(apart.texels, 128);
	finishTextures(level, level.uvs, {}, joined, 1);
	const auto valueAt = [](const TextureBake& bake, glm::vec2 uv)
	{
		const glm::vec2 at = 128.0F * uv - 0.5F;
		const glm::vec2 low(std::floor(at.x), std::floor(at.y));
		const auto texel = [&](int x, int y)
		{
			return bake.texels[static_cast<std::size_t>((static_cast<int>(low.y) + y) * 128 + static_cast<int>(low.x) + x)];
		};
		const glm::vec2 f = at - low;
		return (texel(0, 0) * (1.0F - f.x) + texel(1, 0) * f.x) * (1.0F - f.y) +
			   (texel(0, 1) * (1.0F - f.x) + texel(1, 1) * f.x) * f.y;
	};
	// The largest difference along the edge from one vertex to another of each side.
	const auto differenceOf = [&](const TextureBake& bake, std::size_t a, std::size_t b, std::size_t c, std::size_t d)
	{
		float most = 0.0F;
		for (int i = 0; i <= 1000; ++i)
		{
			const float share = static_cast<float>(i) / 1000.0F;
			most = std::max(most, std::fabs(valueAt(bake, level.uvs[a] + share * (level.uvs[b] - level.uvs[a])) -
											valueAt(bake, level.uvs[c] + share * (level.uvs[d] - level.uvs[c]))));
		}
		return most;
	};
	const auto vertexAt = [&](std::size_t quad, glm::dvec3 position)
	{
		std::size_t i = 4 * quad;
		while (level.positions[i] != position)
		{
			++i;
		}
		return i;
	};
	const auto alongFloor = [&](const TextureBake& bake)
	{
		return differenceOf(bake, vertexAt(0, {0.0, 0.0, 1.0}), vertexAt(0, {0.0, 0.0, -1.0}), vertexAt(1, {0.0, 0.0, 1.0}),
							vertexAt(1, {0.0, 0.0, -1.0}));
	};
	CHECK(alongFloor(apart) > 0.1F);
	CHECK(alongFloor(joined.front()) < 0.02F);
	for (std::size_t row = 78; row < 114; ++row) // inside the wall's chart
	{
		const auto first = static_cast<std::ptrdiff_t>(128 * row + 8);
		CHECK(std::equal(apart.texels.begin() + first, apart.texels.begin() + first + 72, joined.front().texels.begin() + first));
	}
}

TEST_CASE("bake: a texture in blocks has the values of the texture, and mipmaps their means", "[bake]")
{
	constexpr int kSize = 18; // no multiple of four
	TextureBake bake;
	bake.size_px = kSize;
	for (int i = 0; i < kSize * kSize; ++i)
	{
		bake.texels.push_back(0.02F * static_cast<float>(i % kSize) + 0.03F * static_cast<float>(i / kSize)); // up to 0.85
	}
	const std::string file = textureFile(bake, ".ktx2", "nook test");
	const auto numberAt = [&file](std::size_t at, std::size_t width)
	{
		uint64_t number = 0;
		for (std::size_t i = width; i-- > 0;)
		{
			number = number << 8U | static_cast<uint8_t>(file.at(at + i));
		}
		return number;
	};
	REQUIRE(numberAt(40, 4) == 5); // levels: 18, 9, 4, 2, 1
	std::size_t end = file.size();
	for (std::size_t level = 0, size = kSize; level < 5; ++level, size /= 2)
	{
		const std::size_t begin = numberAt(80 + 24 * level, 8);
		const std::size_t across = (size + 3) / 4;
		REQUIRE(begin % 8 == 0);
		REQUIRE(numberAt(88 + 24 * level, 8) == 8 * across * across);
		CHECK(begin + 8 * across * across == end); // the largest comes last
		end = begin;
		double worst = 0.0;
		double sum = 0.0;
		for (std::size_t i = 0; i < size * size; ++i)
		{
			const std::size_t x = i % size;
			const std::size_t y = i / size;
			const uint64_t block = numberAt(begin + 8 * (y / 4 * across + x / 4), 8);
			const double first = static_cast<double>(block & 255U);
			const double last = static_cast<double>(block >> 8U & 255U);
			const uint64_t index = block >> (16 + 3 * (y % 4 * 4 + x % 4)) & 7U;
			const double share = index == 0 ? 0.0 : index == 1 ? 1.0 : static_cast<double>(index - 1) / 7.0;
			const double value = (first + share * (last - first)) / 255.0;
			sum += value / static_cast<double>(size * size);
			worst = std::max(worst, level == 0 ? std::fabs(value - static_cast<double>(bake.texels[i])) : 0.0);
		}
		CHECK(worst < 0.5 * 0.15 / 7.0 + 0.003); // half a step of a block's range, and its ends in eight bits
		CHECK(sum == Approx(0.425).margin(0.01));
	}
	CHECK(end > 200);
	CHECK(textureFile(bake, ".exr", "nook test").size() > 4);
}

TEST_CASE("bake: coordinates that cannot carry a texture are refused", "[bake]")
{
	const auto refused = [](const Level& level, const char* words)
	{
		const Tracer tracer(level, {});
		CHECK_THROWS_WITH(bakeTexture(tracer, level.uvs, 32, within(0.5), {}), Catch::Contains(words));
	};
	const Level level = floorAndBoxWithCharts();
	Level none = level;
	none.uvs.assign(none.uvs.size(), glm::vec2(0.0F));
	refused(none, "found none");
	Level outside = level;
	outside.uvs[1].x = 1.5F;
	refused(outside, "all from 0 to 1");
	Level missing = level;
	missing.uvs[1].x = std::numeric_limits<float>::quiet_NaN();
	refused(missing, "none at some vertices");
	Level overlapping = level;
	for (std::size_t v = 4; v < 8; ++v)
	{
		overlapping.uvs[v] -= glm::vec2(0.3F, 0.0F);
	}
	refused(overlapping, "overlap");
}

TEST_CASE("bake: empty texels are filled from their nearest neighbours", "[bake]")
{
	std::vector<float> values(32 * 32, -1.0F);
	values[0] = 0.25F;
	values[32 * 32 - 1] = 0.75F;
	fillEmpty(values, 32);
	CHECK(values[4 * 32 + 4] == 0.25F);
	CHECK(values[27 * 32 + 27] == 0.75F);
	CHECK(std::all_of(values.begin(), values.end(), [](float v) { return v >= 0.25F && v <= 0.75F; }));
	std::vector<float> empty(16 * 16, -1.0F);
	fillEmpty(empty, 16);
	CHECK(std::all_of(empty.begin(), empty.end(), [](float v) { return v == 1.0F; }));
}

TEST_CASE("bake: a second set of coordinates is read where it is asked for, and written beside a mask's", "[bake][emit]")
{
	Level level = floorAndBoxWithCharts();
	addMask(level);
	std::vector<glm::vec2> second = level.uvs;
	for (glm::vec2& uv : second)
	{
		uv *= 0.5F;
	}
	const std::string png = alphaPngBytes(1, 1, std::vector<uint8_t>{255});
	const TemporaryFolder folder;
	writeFile(folder / "a.glb", bakedGlb(level, "nook test", {{}, false, second, png}));
	const Level again = loadLevel(folder / "a.glb", {}, {}).level;
	const std::vector<glm::vec2> found = loadSecondUvs(folder / "a.glb", {}, again, {});
	REQUIRE(found.size() == again.positions.size());
	for (std::size_t v = 0; v < found.size(); ++v)
	{
		CHECK(found[v] == 0.5F * again.uvs[v]);
	}
	// Without a mask there is only one set.
	level.material_list[0] = {};
	writeFile(folder / "a.glb", bakedGlb(level, "nook test", {{}, false, second, png}));
	const Level plain = loadLevel(folder / "a.glb", {}, {}).level;
	CHECK(loadSecondUvs(folder / "a.glb", {}, plain, {}).empty());
	CHECK(plain.uvs[5] == second[5]);
}

TEST_CASE("bake: a second reading has the triangles of the first, whatever its coordinates", "[bake]")
{
	const TemporaryFolder folder;
	const std::string path = folder / "a.glb";
	const char* const mode = GENERATE(as<const char*>{}, "OPAQUE", "MASK", "BLEND");
	for (const auto& [first_differ, second_differ, second] :
		 {std::tuple{false, true, true}, {true, false, true}, {true, true, true}, {false, false, false}, {true, false, false}})
	{
		INFO(mode << first_differ << second_differ << second);
		const std::string bytes = sheetGlb({{"alphaMode", mode}}, {first_differ, second_differ}, second, true);
		writeFile(path, bytes);
		const Level level = loadLevel(path, {}, {}).level;
		// With a mask, the copy with other coordinates is kept.
		const bool stays = std::string(mode) != "OPAQUE" && first_differ;
		CHECK(level.triangles.size() == (stays ? 4 : 3));
		const std::vector<glm::vec2> found = loadSecondUvs(path, {}, level, {});
		const BakedValues baked = loadBakedValues(path, level, {});
		REQUIRE(found.size() == (second ? level.positions.size() : 0));
		REQUIRE(baked.front.size() == level.positions.size());
		CHECK(baked.front.size() == (stays ? 8 : 7));
		for (std::size_t v = 0; v < baked.front.size(); ++v)
		{
			// In order of first use.
			CHECK(baked.front[v] == static_cast<float>(v == 5 ? 6 : v == 6 ? 5 : v) / 8.0F);
			const glm::vec2 place = 0.5F * glm::vec2(level.positions[v].x, level.positions[v].z);
			CHECK((!second || found[v] == place + glm::vec2(second_differ && v >= 4 ? 0.5F : 0.0F)));
		}
	}
}

TEST_CASE("bake: a second set of coordinates is read of sheets whose triangles were turned", "[bake]")
{
	Level level = emptyLevel();
	addFloor(level, {-2.0, 0.0, -2.0}, 4.0, 4);
	std::swap(level.triangles[9].y, level.triangles[9].z);
	for (std::size_t v = 0; v < level.uvs.size(); ++v)
	{
		level.uvs[v] = {0.125F * static_cast<float>(level.positions[v].x + 2.0),
						0.125F * static_cast<float>(level.positions[v].z + 2.0)};
	}
	level.material_list[0].two_sided = true;
	addMask(level);
	std::vector<glm::vec2> second = level.uvs;
	for (glm::vec2& uv : second)
	{
		uv += glm::vec2(0.25F);
	}
	const TemporaryFolder folder;
	writeFile(folder / "a.glb",
			  bakedGlb(level, "nook test", {{}, false, second, alphaPngBytes(1, 1, std::vector<uint8_t>{255}), {}, {}, {}}));
	Level again = loadLevel(folder / "a.glb", {}, {}).level;
	REQUIRE(alignSheets(again, 1) == 1);
	const std::vector<glm::vec2> found = loadSecondUvs(folder / "a.glb", {}, again, {});
	REQUIRE(found.size() == again.uvs.size());
	for (std::size_t v = 0; v < found.size(); ++v)
	{
		CHECK(found[v] == again.uvs[v] + glm::vec2(0.25F));
	}
}
