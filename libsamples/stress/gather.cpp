// SPDX-License-Identifier: GPL-3.0-or-later
// Methods that gather samples of the depth buffer: volumetric obscurance by lines, areas and points, Alchemy, and those to compare
// with. The twin is their own text in wide numbers, which knows where 32 bits may decide otherwise.
#include "stress/case.h"
#include "stress/pictures.h"
#include "stress/wide_kernels.h"

#include <algorithm>
#include <array>

namespace nook::stress
{
namespace
{

using Narrow = shade_kernels::Kernels;
using WideOnes = wide_kernels::Kernels;

constexpr int kCoarser = 3; // levels of the small picture

// Levels as passes make them: coarser depths, or their moments.
void makeLevels(HardPicture& picture, bool moments)
{
	Narrow& kernels = picture.kernels;
	picture.levels.assign(kCoarser, {});
	for (int level = 0; level < kCoarser; ++level)
	{
		PicturePlane& plane = picture.levels[static_cast<std::size_t>(level)];
		plane.width = levelSide(kPictureWidth / 2, level);
		plane.height = levelSide(kPictureHeight / 2, level);
		plane.channels = moments ? 4 : 1;
		plane.values.resize(plane.index(0, plane.height));
		kernels.levels = picture.levels;
		kernels.nook.level = level;
		for (int y = 0; y < plane.height; ++y)
		{
			for (int x = 0; x < plane.width; ++x)
			{
				const std::size_t at = plane.index(x, y);
				if (moments)
				{
					const glm::vec4 value = kernels.nookMoments({x, y});
					std::copy_n(&value.x, 4, plane.values.begin() + static_cast<std::ptrdiff_t>(at));
				}
				else
				{
					plane.values[at] = kernels.nookCoarser({x, y});
				}
			}
		}
	}
	kernels.nook.level = 0;
	kernels.nook.levels = kCoarser;
}

// One picture a thread and kind, made again when a case belongs to another one.
template <SampleKind kind, bool moments, int coarser> const HardPicture& pictureOf(const Case& one)
{
	thread_local HardPicture picture;
	thread_local std::optional<uint64_t> made;
	const uint64_t key = one.sharedKey(kPictureCases);
	if (made != key)
	{
		makePicture(picture, key, kind);
		if (moments || (coarser > 0 && mixed(key, 5) % 2 == 0))
		{
			makeLevels(picture, moments);
		}
		made = key;
	}
	return picture;
}

template <SampleKind kind, bool moments, int coarser>
void runMethod(Case& one, float (Narrow::*kernel)(glm::ivec2), Wide (WideOnes::*twin)(glm::ivec2))
{
	const HardPicture& picture = pictureOf<kind, moments, coarser>(one);
	const glm::ivec2 pixel = pixelOf(one);
	notePicture(one, picture, pixel);
	Narrow kernels = picture.kernels;
	const auto found = static_cast<double>((kernels.*kernel)(pixel));
	one.result("visibility", found, 0.0, 1.0);
	if (one.hasTwin())
	{
		WideOnes wide(picture.kernels);
		compareWide(one, "visibility", found, [&] { return (wide.*twin)(pixel); });
	}
}

template <float (Narrow::*kernel)(glm::ivec2), Wide (WideOnes::*twin)(glm::ivec2), SampleKind kind, bool moments = false,
		  int coarser = 0>
void runOf(Case& one)
{
	runMethod<kind, moments, coarser>(one, kernel, twin);
}

constexpr std::string_view kGatherText = "its own text in 80 bits";
constexpr std::string_view kShare = "visibility";

constexpr std::array kGatherKernels{
	StressKernel{"vo-line", "gather", kGatherText, kShare, 2e-5, 200, 16,
				 runOf<&Narrow::nookVoLine, &WideOnes::nookVoLine, SampleKind::line>},
	StressKernel{"vo-point", "gather", kGatherText, kShare, 3e-5, 200, 16,
				 runOf<&Narrow::nookVoPoint, &WideOnes::nookVoPoint, SampleKind::ball>},
	StressKernel{"vo-area", "gather", kGatherText, kShare, 2.5e-4, 200, 16,
				 runOf<&Narrow::nookVoArea, &WideOnes::nookVoArea, SampleKind::area, true>},
	StressKernel{"alchemy", "gather", kGatherText, kShare, kMostBound, 200, 16,
				 runOf<&Narrow::nookAlchemy, &WideOnes::nookAlchemy, SampleKind::disk, false, kCoarser>},
	StressKernel{"slices", "gather", kGatherText, kShare, kMostBound, 100, 16,
				 runOf<&Narrow::nookSlices, &WideOnes::nookSlices, SampleKind::line>},
	StressKernel{"crytek", "gather", kGatherText, kShare, 1e-6, 200, 16,
				 runOf<&Narrow::nookCrytek, &WideOnes::nookCrytek, SampleKind::ball>},
	StressKernel{"volumetric-ao", "gather", kGatherText, kShare, kMostBound, 200, 16,
				 runOf<&Narrow::nookVolumetric, &WideOnes::nookVolumetric, SampleKind::line>},
	StressKernel{"hbao", "gather", kGatherText, kShare, 2e-5, 100, 16,
				 runOf<&Narrow::nookHbao, &WideOnes::nookHbao, SampleKind::direction>},
	StressKernel{"sao", "gather", kGatherText, kShare, kMostBound, 200, 16,
				 runOf<&Narrow::nookSao, &WideOnes::nookSao, SampleKind::spiral, false, kCoarser>},
	StressKernel{"gtao", "gather", kGatherText, kShare, 3e-4, 100, 16,
				 runOf<&Narrow::nookGtao, &WideOnes::nookGtao, SampleKind::slice>},
	StressKernel{"bitmask", "gather", kGatherText, kShare, 2e-5, 100, 16,
				 runOf<&Narrow::nookBitmask, &WideOnes::nookBitmask, SampleKind::slice>},
};

} // namespace

std::span<const StressKernel> gatherKernels()
{
	return kGatherKernels;
}

} // namespace nook::stress
