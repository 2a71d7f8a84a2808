// SPDX-License-Identifier: GPL-3.0-or-later
// Filters: bilateral passes, the window of variants, half resolution to full, the cross of a gather, sparse cells; and the moments
// of depth. A mean of visibilities lies between the least and the greatest of them.
#include "stress/case.h"
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

// What a filter may return: a mean of cells, which rounding of its weights may carry a little beyond them.
constexpr double kMean = 1e-6;

// What passes before the filter, or before upsampling, write of each cell.
void pack(HardPicture& picture, bool links)
{
	PicturePlane& packed = picture.packed;
	packed.width = picture.visibility.width;
	packed.height = picture.visibility.height;
	packed.channels = 4;
	packed.values.clear();
	for (int y = 0; y < packed.height; ++y)
	{
		for (int x = 0; x < packed.width; ++x)
		{
			const float visibility = picture.visibility.values[picture.visibility.index(x, y)];
			const glm::vec4 one =
				links ? picture.kernels.nookLinked({x, y}, visibility) : picture.kernels.nookOfSurface({x, y}, visibility);
			packed.values.insert(packed.values.end(), {one.x, one.y, one.z, one.w});
		}
	}
	picture.kernels.packed = &packed;
}

// cell: side of a cell of visibility in pixels.
template <int cell> const HardPicture& pictureOf(const Case& one)
{
	thread_local HardPicture picture;
	thread_local std::optional<uint64_t> made;
	const uint64_t key = one.sharedKey(kPictureCases);
	if (made != key)
	{
		makePicture(picture, key, SampleKind::disk);
		picture.kernels.nook.cell = cell;
		picture.kernels.nook.window = 1 + static_cast<int>(key % 5);
		if (cell > 2)
		{
			for (float& value : picture.visibility.values)
			{
				value = 0.5F + 0.2F * (value - 0.5F); // cells that differ more are left to be drawn
			}
		}
		if (cell > 1)
		{
			picture.visibility.width = kPictureWidth / cell;
			picture.visibility.height = kPictureHeight / cell;
		}
		pack(picture, cell == 1);
		made = key;
	}
	return picture;
}

// leaves: −1 stands for a pixel that is left to be drawn.
template <class Call, class WideCall>
void runFilter(Case& one, const HardPicture& picture, glm::ivec2 at, bool leaves, const Call& call, const WideCall& wide_call)
{
	notePicture(one, picture, at);
	const auto found = static_cast<double>(call(picture.kernels));
	one.result("visibility", found, leaves && found == -1.0 ? -1.0 : 0.0, 1.0 + kMean);
	if (one.hasTwin())
	{
		WideOnes wide(picture.kernels);
		compareWide(one, "visibility", found, [&] { return wide_call(wide); });
	}
}

// How alike a cell and the next one along x are.
void runLinks(Case& one)
{
	const HardPicture& picture = pictureOf<1>(one);
	const glm::ivec2 at = pixelOf(one);
	runFilter(
		one, picture, at, false, [&](Narrow kernels) { return kernels.nookLinked(at, 1.0F).y; },
		[&](WideOnes& wide) { return wide.nookLinked(at, 1.0F).y; });
}

void runBilateral(Case& one)
{
	const HardPicture& picture = pictureOf<1>(one);
	const glm::ivec2 at = pixelOf(one);
	runFilter(
		one, picture, at, false, [&](Narrow kernels) { return kernels.nookBilateralY(at); },
		[&](WideOnes& wide) { return wide.nookBilateralY(at); });
}

void runWindow(Case& one)
{
	const HardPicture& picture = pictureOf<1>(one);
	const glm::ivec2 at = pixelOf(one);
	runFilter(
		one, picture, at, false, [&](Narrow kernels) { return kernels.nookWindow(at); },
		[&](WideOnes& wide) { return wide.nookWindow(at); });
}

void runUpsample(Case& one)
{
	const HardPicture& picture = pictureOf<2>(one);
	const glm::ivec2 at = pixelOf(one);
	runFilter(
		one, picture, at, true, [&](Narrow kernels) { return kernels.nookUpsample(at); },
		[&](WideOnes& wide) { return wide.nookUpsample(at); });
}

void runSparse(Case& one)
{
	const HardPicture& picture = pictureOf<4>(one);
	const glm::ivec2 at = pixelOf(one);
	runFilter(
		one, picture, at, true, [&](Narrow kernels) { return kernels.nookSparse(at); },
		[&](WideOnes& wide) { return wide.nookSparse(at); });
}

// Of a sample that lies anywhere within the pixel, on its surface or off it.
void runCross(Case& one)
{
	const HardPicture& picture = pictureOf<1>(one);
	const glm::ivec2 at = pixelOf(one);
	Narrow kernels = picture.kernels;
	const float depth = std::min(kernels.nookDepth(at), picture.largest) * static_cast<float>(between(one.random, 0.5, 2.0));
	const glm::vec3 position = kernels.nookPosition(at, depth);
	const glm::vec3 n = kernels.nookNormal(at);
	one.note("position", position);
	runFilter(
		one, picture, at, false, [&](Narrow own) { return own.nookGather(at, position, n); },
		[&](WideOnes& wide) { return wide.nookGather(at, WideVec3(position), WideVec3(n)); });
}

// Mean and variance of 16 pixels' nookEven, by two levels of texels.
void runMoments(Case& one)
{
	const HardPicture& picture = pictureOf<1>(one);
	const glm::ivec2 texel(static_cast<int>(one.index()) % (kPictureWidth / 4),
						   static_cast<int>(one.index()) / 4 % (kPictureHeight / 4));
	notePicture(one, picture, texel * 4);
	Narrow kernels = picture.kernels;
	glm::vec4 joined(0.0F);
	long double sum = 0.0L;
	std::array<long double, 16> even{};
	std::size_t count = 0;
	for (int i = 0; i < 4; ++i)
	{
		const glm::ivec2 part(2 * texel.x + i % 2, 2 * texel.y + i / 2);
		joined = kernels.nookJoined(joined, kernels.nookMoments(part));
		for (int k = 0; k < 4; ++k)
		{
			const auto depth = static_cast<long double>(kernels.nookDepth(part * 2 + glm::ivec2(k % 2, k / 2)));
			if (depth < static_cast<long double>(NOOK_SKY))
			{
				even[count] = picture.camera.parallel ? depth : -1.0L / depth;
				sum += even[count];
				count += 1;
			}
		}
	}
	one.require("pixels with a surface are counted",
				static_cast<double>(joined.z) == static_cast<double>(count) && joined.w == 16.0F);
	if (count == 0)
	{
		return;
	}
	const long double mean = sum / static_cast<long double>(count);
	long double variance = 0.0L;
	long double size = 0.0L;
	for (std::size_t i = 0; i < count; ++i)
	{
		variance += (even[i] - mean) * (even[i] - mean) / static_cast<long double>(count);
		size = std::max(size, std::fabs(even[i]));
	}
	one.result("mean", static_cast<double>(joined.x), -1e30, 1e30);
	one.result("variance", static_cast<double>(joined.y), 0.0, 1e30);
	one.compare("mean", static_cast<double>(joined.x), mean, static_cast<double>(size));
	// The deviation's own size and what rounding of depths leaves: no digits are lost to the mean.
	const long double deviation = std::sqrt(variance);
	one.compare("deviation", static_cast<double>(std::sqrt(joined.y)), deviation, static_cast<double>(size));
}

constexpr std::string_view kText = "its own text in 80 bits";

constexpr std::array kFiltersKernels{
	StressKernel{"filter-links", "filter", kText, "likeness", kMostBound, 200, 16, runLinks},
	StressKernel{"filter-bilateral", "filter", kText, "visibility", kMostBound, 200, 16, runBilateral},
	StressKernel{"filter-window", "filter", kText, "visibility", 8e-4, 200, 16, runWindow},
	StressKernel{"filter-upsample", "filter", kText, "visibility", 2e-4, 200, 16, runUpsample},
	StressKernel{"filter-sparse", "filter", kText, "visibility", 1.5e-4, 200, 16, runSparse},
	StressKernel{"gather-cross", "filter", kText, "visibility", kMostBound, 200, 16, runCross},
	StressKernel{"moments", "filter", "mean and deviation of 16 depths in 80 bits", "share of the greatest of them", 1e-6, 200, 1,
				 runMoments},
};

} // namespace

std::span<const StressKernel> filterKernels()
{
	return kFiltersKernels;
}

} // namespace nook::stress
