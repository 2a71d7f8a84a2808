// SPDX-License-Identifier: GPL-3.0-or-later
// Summed-area tables of pictures up to 8192 pixels long, and the statistics over them.
#include "shade/table_scan.h"
#include "stress/case.h"
#include "stress/pass_pictures.h"
#include "stress/pictures.h"
#include "stress/wide_kernels.h"

#include <algorithm>
#include <array>
#include <optional>

namespace nook::stress
{
namespace
{

using Narrow = shade_kernels::Kernels;
using WideOnes = wide_kernels::Kernels;
using Long = long double;

constexpr uint64_t kTableCases = 16384; // that share a small picture
constexpr uint64_t kStripCases = uint64_t{1} << 16U;
constexpr int kStripLength = 8192;
constexpr int kStripWidth = 48;

// A picture with its tables and all that nookStatVo reads.
struct TablePicture
{
	GBuffer gbuffer;
	ShadeSettings settings;
	std::vector<Planes> pictures;
	std::vector<float> depths;
	Narrow kernels;
};

// What a depth buffer may hold: planes at any slope, noise from none to all of the range (σ → 0, μ ≫ σ), steps, sky.
void fillPicture(TablePicture& picture, Random& random, int width, int height)
{
	const HardCamera camera = hardCamera(random, 10.0, {width, height});
	GBuffer& gbuffer = picture.gbuffer;
	gbuffer.width_px = width;
	gbuffer.height_px = height;
	gbuffer.view.projection = camera.projection;
	const double middle = hardDepth(random, camera);
	const double other = hardDepth(random, camera);
	const double noise = random.below(3) == 0 ? 0.0 : octaves(random, -24.0, 0.0);
	const double slope_x = signOf(random) * octaves(random, -16.0, 1.0);
	const double slope_y = signOf(random) * octaves(random, -16.0, 1.0);
	const bool steps = random.below(3) == 0;
	const bool holes = random.below(3) == 0;
	const auto pixels = static_cast<std::size_t>(width) * static_cast<std::size_t>(height);
	gbuffer.depth.resize(pixels);
	gbuffer.normals.resize(pixels);
	glm::dvec3 n = hardDirection(random);
	const bool one_normal = random.below(2) == 0;
	for (std::size_t i = 0; i < pixels; ++i)
	{
		const double x = static_cast<double>(i % static_cast<std::size_t>(width)) / width - 0.5;
		const double y = static_cast<double>(i / static_cast<std::size_t>(width)) / height - 0.5;
		const double rise = 1.0 + slope_x * x + slope_y * y;
		double depth =
			(camera.parallel ? middle * rise : middle / std::max(rise, 1e-9)) * (1.0 + noise * between(random, -1.0, 1.0));
		depth = steps && random.below(2) == 0 ? other : depth;
		gbuffer.depth[i] =
			holes && random.below(6) == 0 ? HUGE_VALF : static_cast<float>(std::clamp(depth, camera.near_m, camera.far_m));
		n = one_normal ? n : hardDirection(random);
		n.z = std::fabs(n.z);
		gbuffer.normals[i] = glm::vec3(n);
	}
}

void fillSettings(TablePicture& picture, Random& random, bool simple)
{
	ShadeSettings& settings = picture.settings;
	settings = {};
	settings.method = ShadeMethod::statvo;
	StatVoSettings& statvo = settings.statvo;
	statvo.layering = random.below(2) == 0 ? StatVoLayering::adaptive : StatVoLayering::uniform;
	statvo.layers = simple                                        ? 1
					: statvo.layering == StatVoLayering::adaptive ? 1 << random.below(3)
																  : 1 + static_cast<int>(random.below(12));
	statvo.quadrants = !simple && random.below(2) == 0;
	statvo.cell_px = simple ? 1 : 1 << random.below(3);
	statvo.slope = octaves(random, -3.0, 3.0);
	statvo.height = random.below(2) == 0 ? 1.0 : octaves(random, -4.0, 6.0);
	statvo.largest_px = random.below(2) == 0 ? 127 : 1 + static_cast<int>(random.below(255));
	statvo.skip = random.below(2) == 0;
	settings.use_normal = random.below(3) != 0;
	const std::vector<float>& depths = picture.gbuffer.depth;
	const float some = depths[random.below(static_cast<uint32_t>(depths.size()))];
	settings.radius_m = 1.0;
	Narrow kernels;
	kernels.nook = nook::blockOf(frameOf(picture.gbuffer), ownSamples(settings), settings);
	const glm::vec2 scale = kernels.nookScale(std::isfinite(some) ? some : 1.0F);
	const double pixels = static_cast<double>(std::max(std::fabs(scale.x), std::fabs(scale.y)));
	settings.radius_m = std::clamp(octaves(random, -1.0, 8.0) / pixels, 1e-8, 1e8);
}

// All passes but the last one.
void runPasses(TablePicture& picture)
{
	const ShadeSamples samples = ownSamples(picture.settings);
	const ShadePlan plan = planOf(frameOf(picture.gbuffer), samples, picture.settings, true);
	const ShadePass& last = plan.passes.back();
	picture.pictures = picturesOf(picture.gbuffer, picture.settings, last.kernel.name);
	picture.depths = finiteDepths(picture.gbuffer);
	Narrow& kernels = picture.kernels;
	kernels = {};
	kernels.depths = picture.depths;
	kernels.normals = picture.gbuffer.normals;
	kernels.nook = last.block;
	for (const ShadeRead& read : last.reads)
	{
		const Planes& planes = picture.pictures[read.picture];
		switch (read.slot)
		{
		case ShadeSlot::cells: kernels.cells = planes.data(); break;
		case ShadeSlot::packed: kernels.packed = planes.data(); break;
		case ShadeSlot::levels: kernels.levels = planes; break;
		case ShadeSlot::tables: kernels.tables = planes; break;
		case ShadeSlot::range: kernels.range = planes.data(); break;
		}
	}
}

enum class Shape
{
	small,  // with every setting
	simple, // one layer, no quadrants, cells of a pixel
	strip,  // the same, 8192 pixels wide or high
};

template <Shape shape> const TablePicture& pictureOf(const Case& one)
{
	thread_local TablePicture picture;
	thread_local std::optional<uint64_t> made;
	const uint64_t key = one.sharedKey(shape == Shape::strip ? kStripCases : kTableCases);
	if (made != key)
	{
		Random random(key, 23);
		const bool wide = random.below(2) == 0;
		const int length = shape == Shape::strip ? kStripLength : 64;
		const int width = shape == Shape::strip ? kStripWidth : 48;
		fillPicture(picture, random, wide ? length : width, wide ? width : length);
		fillSettings(picture, random, shape != Shape::small);
		runPasses(picture);
		made = key;
	}
	return picture;
}

// Anywhere, often at the far corner.
glm::ivec2 hardPixel(Case& one, const GBuffer& gbuffer)
{
	const auto coordinate = [&one](int size)
	{
		return one.random.below(2) == 0 ? static_cast<int>(one.random.below(static_cast<uint32_t>(size)))
										: size - 1 - static_cast<int>(one.random.below(static_cast<uint32_t>(std::min(size, 16))));
	};
	const int x = coordinate(gbuffer.width_px);
	return {x, coordinate(gbuffer.height_px)};
}

void noteTables(Case& one, const TablePicture& picture, glm::ivec2 pixel)
{
	if (one.shown())
	{
		const ShadeBlock& block = picture.kernels.nook;
		one.note("pixels", glm::ivec2(picture.gbuffer.width_px, picture.gbuffer.height_px));
		one.note("pixel", pixel);
		one.note("depth", static_cast<double>(picture.kernels.nookDepth(pixel)));
		one.note("normal", picture.kernels.nookNormal(pixel));
		noteBlock(one, block);
		one.note("range 0", picture.kernels.nookRange(0));
		one.note("range 1", picture.kernels.nookRange(1));
	}
}

// Sums over rectangles at the far corner of tables that have wrapped around many times, against 64 bits.
struct Sums
{
	PicturePlane table;
	std::vector<uint64_t> exact; // four an entry
};

const Sums& sums()
{
	static const Sums made = []
	{
		Sums result;
		PicturePlane cells;
		cells.width = kStripLength + 1;
		cells.height = kStripWidth + 1;
		cells.channels = 4;
		const std::size_t row = cells.index(0, 1);
		cells.counts.resize(cells.index(0, cells.height));
		result.exact.resize(cells.counts.size());
		Random random(5);
		for (std::size_t i = 0; i < cells.counts.size(); ++i)
		{
			const bool edge = i < row || i % row < 4;
			cells.counts[i] = edge ? 0U : i % 4 == 3 ? 1U : 4194304U - random.below(1U << (1U + random.below(20)));
			const uint64_t left = i % row < 4 ? 0U : result.exact[i - 4];
			const uint64_t above = i < row ? 0U : result.exact[i - row];
			const uint64_t both = edge ? 0U : result.exact[i - row - 4];
			result.exact[i] = cells.counts[i] + left + above - both;
		}
		PicturePlane rows = cells;
		scanOnCpu(cells, 0, rows, {1, {}});
		result.table = rows;
		scanOnCpu(rows, 1, result.table, {1, {}});
		return result;
	}();
	return made;
}

void runTableBox(Case& one)
{
	const Sums& all = sums();
	const int width = 1 + static_cast<int>(one.random.below(kStripWidth));
	const int height = std::min(kStripWidth, 1 + static_cast<int>(one.random.below(static_cast<uint32_t>(1023 / width))));
	const int x = one.random.below(2) == 0 ? kStripLength - width
										   : static_cast<int>(one.random.below(static_cast<uint32_t>(kStripLength - width + 1)));
	const int y = one.random.below(2) == 0 ? kStripWidth - height
										   : static_cast<int>(one.random.below(static_cast<uint32_t>(kStripWidth - height + 1)));
	const glm::ivec4 box(x, y, x + width, y + height);
	one.note("box", box);
	Narrow kernels;
	kernels.tables = {&all.table, 1};
	const glm::uvec4 found = kernels.nookTableBox(box, 0);
	for (int i = 0; i < 4; ++i)
	{
		const auto at = [&](int px, int py)
		{
			return all.exact[all.table.index(px, py) + static_cast<std::size_t>(i)];
		};
		const uint64_t expected = at(box.z, box.w) - at(box.x, box.w) - at(box.z, box.y) + at(box.x, box.y);
		one.compare("sum", found[i], static_cast<long double>(expected));
	}
}

// StatVO of one layer by its definition: the mean position of all pixels of the rectangle that are in the tables. The rectangle,
// what is in the tables and positions are its own, from the picture and its projection in 80 bits.
class StatTwin
{
public:
	explicit StatTwin(const TablePicture& picture) : m_picture(picture) {}

	// None where rounding decides which pixels count.
	std::optional<Long> visibility(glm::ivec2 pixel)
	{
		m_unsure = false;
		const float depth = depthAt(pixel);
		const Box box = boxOf(depth);
		const Long value = isKept(depth) ? 1.0L - filled(pixel, box) * fadeOf(box) : 1.0L;
		return m_unsure ? std::nullopt : std::optional(value);
	}

	// Of the box over a pixel, metres.
	Long height(glm::ivec2 pixel) const
	{
		return boxOf(depthAt(pixel)).height_m;
	}

private:
	struct Box
	{
		std::array<Long, 2> half_px{};
		Long height_m = 0.0L;
	};

	float depthAt(glm::ivec2 pixel) const
	{
		return m_picture.gbuffer.depth[indexOf(pixel)];
	}
	std::size_t indexOf(glm::ivec2 pixel) const
	{
		return static_cast<std::size_t>(pixel.y) * static_cast<std::size_t>(m_picture.gbuffer.width_px) +
			   static_cast<std::size_t>(pixel.x);
	}
	std::array<Long, 3> placeOf(glm::ivec2 pixel, float depth) const
	{
		const GBuffer& gbuffer = m_picture.gbuffer;
		return sightOf(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px, pixel).point(static_cast<Long>(depth));
	}

	// No radius is more than the picture is high, or than the largest half side.
	Box boxOf(float depth) const
	{
		const GBuffer& gbuffer = m_picture.gbuffer;
		const StatVoSettings& settings = m_picture.settings.statvo;
		const auto [across, down] =
			pixelsPerMetre(gbuffer.view.projection, gbuffer.width_px, gbuffer.height_px, static_cast<Long>(depth));
		const Long most = std::min<Long>(gbuffer.height_px, settings.largest_px) / std::max(across, down);
		const Long radius = std::min<Long>(static_cast<Long>(m_picture.settings.radius_m), most);
		return {{across * radius, down * radius}, static_cast<Long>(settings.height) * radius};
	}

	Long shareOfLeast(const Box& box) const
	{
		return std::max(box.half_px[0], box.half_px[1]) / static_cast<Long>(m_picture.kernels.nook.least_box_px);
	}
	Long fadeOf(const Box& box) const
	{
		return std::clamp(shareOfLeast(box) - 1.0L, 0.0L, 1.0L);
	}
	bool isKept(float depth)
	{
		if (!std::isfinite(depth))
		{
			return false;
		}
		const Long share = shareOfLeast(boxOf(depth));
		m_unsure = m_unsure || std::fabs(share - 1.0L) < kClose;
		return share >= 1.0L;
	}
	int roundedSide(Long half_px)
	{
		const Long whole = std::floor(half_px + 0.5L);
		m_unsure = m_unsure || std::fabs(half_px + 0.5L - std::round(half_px + 0.5L)) < kClose * half_px;
		return static_cast<int>(whole);
	}

	Long filled(glm::ivec2 pixel, const Box& box)
	{
		const GBuffer& gbuffer = m_picture.gbuffer;
		const int x = roundedSide(box.half_px[0]);
		const int y = roundedSide(box.half_px[1]);
		const int left = std::max(pixel.x - x, 0);
		const int right = std::min(pixel.x + x, gbuffer.width_px - 1);
		const int upper = std::max(pixel.y - y, 0);
		const int lower = std::min(pixel.y + y, gbuffer.height_px - 1);
		const std::array<Long, 3> place = placeOf(pixel, depthAt(pixel));
		std::array<Long, 3> sum{};
		Long count = 0.0L;
		for (int py = upper; py <= lower; ++py)
		{
			for (int px = left; px <= right; ++px)
			{
				const float there = depthAt({px, py});
				if (isKept(there))
				{
					const std::array<Long, 3> p = placeOf({px, py}, there);
					for (std::size_t i = 0; i < 3; ++i)
					{
						sum[i] += p[i] - place[i];
					}
					count += 1.0L;
				}
			}
		}
		const bool with_normal = m_picture.settings.use_normal;
		const glm::dvec3 n = with_normal ? glm::dvec3(gbuffer.normals[indexOf(pixel)]) : glm::dvec3(0.0, 0.0, 0.5);
		const Long along = sum[0] * static_cast<Long>(n.x) + sum[1] * static_cast<Long>(n.y) + sum[2] * static_cast<Long>(n.z);
		const Long t = along / (std::max(count, 1.0L) * box.height_m) + (with_normal ? 0.0L : 0.5L);
		const Long over = std::max(t - 1.0L, 0.0L) * static_cast<Long>(m_picture.settings.statvo.slope);
		const Long full = std::clamp(t, 0.0L, 1.0L) * std::max(1.0L - over, 0.0L);
		const Long area = static_cast<Long>(right - left + 1) * static_cast<Long>(lower - upper + 1);
		return count * full / std::max(area - count * std::clamp(over - 1.0L, 0.0L, 1.0L), 1e-3L);
	}

	static constexpr Long kClose = 2e-6L; // shares of what some roundings of 32-bit floats may decide

	const TablePicture& m_picture;
	bool m_unsure = false;
};

template <Shape shape> void runMean(Case& one)
{
	const TablePicture& picture = pictureOf<shape>(one);
	const glm::ivec2 pixel = hardPixel(one, picture.gbuffer);
	noteTables(one, picture, pixel);
	Narrow kernels = picture.kernels;
	const auto found = static_cast<double>(kernels.nookStatVo(pixel));
	one.result("visibility", found, 0.0, 1.0);
	if (one.hasTwin())
	{
		StatTwin twin(picture);
		const std::optional<Long> expected = twin.visibility(pixel);
		// In a parallel projection boxes are as large far away as near by: of a range of depths many thousand times as deep as a
		// box is high, the tables' steps are too coarse.
		const Long step = static_cast<Long>(kernels.nookRange(1).z);
		if (!expected || (picture.gbuffer.view.projection[2][3] == 0.0 && step * 255.0L > twin.height(pixel)))
		{
			one.leaveOpen();
			return;
		}
		one.compare("visibility", found, *expected);
	}
}

void runLayers(Case& one)
{
	const TablePicture& picture = pictureOf<Shape::small>(one);
	const glm::ivec2 pixel = hardPixel(one, picture.gbuffer);
	noteTables(one, picture, pixel);
	Narrow kernels = picture.kernels;
	const auto found = static_cast<double>(kernels.nookStatVo(pixel));
	one.result("visibility", found, 0.0, 1.0);
	if (one.hasTwin())
	{
		WideOnes wide(picture.kernels);
		compareWide(one, "visibility", found, [&] { return wide.nookStatVo(pixel); });
	}
}

constexpr std::array kTablesKernels{
	StressKernel{"table-box", "tables", "64-bit sums, far corner of 8192 cells", "counts", 0.0, 300, 1, runTableBox},
	StressKernel{"statvo-mean", "tables", "the mean of all pixels' positions in 80 bits", "visibility", 1.0 / 255.0, 100, 16,
				 runMean<Shape::simple>},
	StressKernel{"statvo-far", "tables", "the same, pictures 8192 pixels long", "visibility", 1.0 / 255.0, 100, 16,
				 runMean<Shape::strip>},
	StressKernel{"statvo-layers", "tables", "its own text in 80 bits, from the same tables", "visibility", kMostBound, 100, 16,
				 runLayers},
};

} // namespace

std::span<const StressKernel> tableKernels()
{
	return kTablesKernels;
}

} // namespace nook::stress
