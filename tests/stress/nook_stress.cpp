// SPDX-License-Identifier: GPL-3.0-or-later
// nook_stress [--cases N] [--seed S] [--kernel NAME]... [--case K]
// Runs the kernels on inputs that are hard for 32 bits and compares them with twins of 80 bits. Prints the worst error of each.
// With --case it prints one case of one kernel instead. Exit code 7: a result is NaN, out of range or beyond its threshold.
#include "stress/hard_inputs.h"
#include "stress/wide.h"

#include "core/parallel.h"
#include "core/text.h"
#include "methods/volume_kernels.h"
#include "volume/evaluate.h"

#include <CLI/CLI.hpp>

#include <cstdio>
#include <optional>
#include <string>
#include <type_traits>

namespace nook::stress
{
namespace
{

using Long = long double;
using Narrow = shade_kernels::Kernels;
using WideOnes = wide_kernels::Kernels;

constexpr double kMostBound = 1e-3; // cases that rounding may change by more than this are unsure

// One case: its random numbers and its verdict.
class Case
{
public:
	Case(uint64_t key, uint64_t at, bool twin, bool shown)
		: random(mixed(key, at), mixed(at, key)), index(at), has_twin(twin), m_key(key), m_shown(shown)
	{
	}

	Random random;
	const uint64_t index;
	const bool has_twin; // compares with the twin, too

	bool broken = false;  // NaN or infinite
	bool outside = false; // out of range, or beyond its own error bound
	bool compared = false;
	bool unsure = false; // rounding decides between two results that are both right
	double error = 0.0;

	// The key of the picture that this case shares with others.
	uint64_t pictureKey() const
	{
		return mixed(m_key ^ 0x5bd1e995U, index / kPictureCases);
	}
	template <class Value> void note(const char* name, const Value& value) const
	{
		if constexpr (std::is_arithmetic_v<Value>)
		{
			if (m_shown)
			{
				std::printf("%s: %.21Lg\n", name, static_cast<Long>(value));
			}
		}
		else
		{
			for (int i = 0; m_shown && i < value.length(); ++i)
			{
				note(name, value[i]);
			}
		}
	}
	void result(const char* name, double found, double least, double most)
	{
		note(name, found);
		broken = broken || !std::isfinite(found);
		outside = outside || (std::isfinite(found) && !(found >= least && found <= most));
	}
	// The error counts in multiples of `unit`.
	void compare(double found, Long expected, double unit = 1.0)
	{
		compared = true;
		note("expected", expected);
		if (!std::isfinite(found) || !std::isfinite(expected))
		{
			broken = true;
			return;
		}
		error = std::fmax(error, static_cast<double>(std::fabs(static_cast<Long>(found) - expected)) / unit);
	}

private:
	uint64_t m_key;
	bool m_shown;
};

template <class Twin> void compareWide(Case& one, double found, const Twin& twin)
{
	wide_unsure = false;
	wide_broken = false;
	const Wide expected = twin();
	one.note("error bound", expected.error);
	one.broken = one.broken || wide_broken;
	one.compared = true;
	one.unsure = wide_unsure || !(expected.error <= kMostBound);
	if (!one.unsure)
	{
		one.compare(found, expected.value);
		one.outside = one.outside || one.error > expected.error;
	}
}

// Shares of the reach along the normal (k/128) and beyond the edges (m/8 of that), as files hold them.
glm::vec2 hardShare(Random& random)
{
	const bool whole = random.below(2) == 0;
	const float height = whole ? 1.0F : static_cast<float>(1U + random.below(128)) / 128.0F;
	return {height, whole ? 1.0F : height * static_cast<float>(1U + random.below(8)) / 8.0F};
}

// Volumes of polygons. Only ranges are checked: these corners need not make a polygon. Any size, zeros, denormals, duplicates.
void runWildVolume(Case& one)
{
	std::vector<glm::vec3> corners(3 + one.random.below(14));
	const double size = anySize(one.random);
	for (glm::vec3& corner : corners)
	{
		for (int i = 0; i < 3; ++i)
		{
			corner[i] = hardFloat(one.random, size);
		}
		if (one.random.below(6) == 0)
		{
			corner = corners[one.random.below(static_cast<uint32_t>(corners.size()))];
		}
	}
	const glm::vec3 normal(hardDirection(one.random));
	const glm::vec3 front(hardDirection(one.random));
	const auto alpha = static_cast<float>(between(one.random, 0.0, 1.0));
	const auto reach = static_cast<float>(anySize(one.random));
	const glm::vec2 share = hardShare(one.random);
	const float two_sided = one.random.below(2) == 0 ? 0.0F : 1.0F;
	for (const glm::vec3& corner : corners)
	{
		one.note("corner", corner);
	}
	one.note("normal", normal);
	one.note("front", front);
	one.note("reach", reach);
	volume_kernels::Kernels kernels;
	kernels.corners = corners;
	const auto count = static_cast<int>(corners.size());
	const float bias = static_cast<float>(kVolumeBias) * reach;
	const float height = kernels.nookHeight(front);
	one.result("volume",
			   static_cast<double>(kernels.nookVolume(count, normal, front, alpha, two_sided, height, reach, share, bias)), 0.0,
			   static_cast<double>(alpha));
	one.result("form factor", static_cast<double>(kernels.nookFormFactor(count, normal, -1.0F)), 0.0, 1.0);
	const float lift = kernels.nookLift(height, two_sided, bias, glm::dot(normal, front));
	one.result("lift", static_cast<double>(lift), -2.02 * static_cast<double>(bias), 2.02 * static_cast<double>(bias));
}

// The tangent frame of masks: right angles and lengths of 1, also close to the one normal without a frame.
void runTangent(Case& one)
{
	const glm::dvec3 pole = glm::normalize(glm::dvec3(0.23, 0.94, 0.252));
	glm::vec3 n(hardDirection(one.random));
	if (one.random.below(8) == 0)
	{
		n = glm::vec3(glm::normalize(octaves(one.random, -20.0, -3.0) * glm::dvec3(n) - pole));
	}
	one.note("normal", n);
	volume_kernels::Kernels kernels;
	const std::array frame{glm::tvec3<Long>(kernels.nookTangent(n, 0)), glm::tvec3<Long>(kernels.nookTangent(n, 1)),
						   glm::tvec3<Long>(n)};
	const double unit = 2.0 / std::max(glm::length(glm::dvec3(n) + pole), 1e-6); // the normal's own rounding turns the frame
	for (std::size_t i = 0; i < 2; ++i)
	{
		for (std::size_t k = i; k < 3; ++k)
		{
			const Long product = glm::dot(frame[i], frame[k]);
			one.compare(static_cast<double>(i == k ? std::sqrt(product) : product), i == k ? 1.0L : 0.0L, unit);
		}
	}
}

// --- kernels that read pictures, against their own text in 80 bits

// The pixel that a case looks at.
glm::ivec2 pixelOf(const Case& one)
{
	const auto i = static_cast<int>(one.index % kPictureCases);
	return {i % kPictureWidth, i / kPictureWidth};
}

void notePicture(const Case& one, const HardPicture& picture, glm::ivec2 pixel)
{
	one.note("pixel", pixel);
#define NOOK_NOTE(type, name, meaning) one.note(#name, picture.kernels.nook.name);
	NOOK_MODULE_MEMBERS(NOOK_NOTE)
	NOOK_OWN_MEMBERS(NOOK_NOTE)
#undef NOOK_NOTE
#define NOOK_NOTE(name, value, meaning) one.note(#name, picture.kernels.nook.name);
	NOOK_SHADE_CONSTANTS(NOOK_NOTE)
#undef NOOK_NOTE
	for (const float depth : picture.depths)
	{
		one.note("depth", depth);
	}
	for (const glm::vec4& sample : picture.samples)
	{
		one.note("sample", sample);
	}
}

// One picture per thread and kind, made again when a case belongs to another one.
template <auto make> const HardPicture& pictureOf(const Case& one)
{
	thread_local HardPicture picture;
	thread_local std::optional<uint64_t> made;
	const uint64_t key = one.pictureKey();
	if (made != key)
	{
		make(picture, key);
		made = key;
	}
	return picture;
}

// `call` runs on the kernels and on their twin. left: the result −1 marks a pixel that is left to be drawn.
template <class Call> void runOn(Case& one, const HardPicture& picture, double most, bool left, const Call& call)
{
	const glm::ivec2 pixel = pixelOf(one);
	notePicture(one, picture, pixel);
	Narrow kernels = picture.kernels;
	const auto found = static_cast<double>(call(kernels, pixel));
	one.result("result", found, left && found == -1.0 ? -1.0 : 0.0, most);
	if (one.has_twin)
	{
		WideOnes wide(picture.kernels);
		compareWide(one, found, [&] { return call(wide, pixel); });
	}
}

enum class Levels
{
	none,
	depths, // in every second picture
	moments,
};

// Coarser depths, or their moments, as the passes make them.
void makeLevels(HardPicture& picture, bool moments)
{
	constexpr int kCoarser = 3;
	Narrow& kernels = picture.kernels;
	picture.levels.assign(kCoarser, {});
	for (int level = 0; level < kCoarser; ++level)
	{
		PicturePlane& plane = picture.levels[static_cast<std::size_t>(level)];
		plane.width = levelSide(kPictureWidth / 2, level);
		plane.height = levelSide(kPictureHeight / 2, level);
		plane.channels = moments ? 4 : 1;
		kernels.levels = picture.levels;
		kernels.nook.level = level;
		for (int i = 0; i < plane.width * plane.height; ++i)
		{
			const glm::ivec2 texel(i % plane.width, i / plane.width);
			const glm::vec4 value = moments ? kernels.nookMoments(texel) : glm::vec4(kernels.nookCoarser(texel));
			plane.values.insert(plane.values.end(), &value.x, &value.x + plane.channels);
		}
	}
	kernels.nook.level = 0;
	kernels.nook.levels = kCoarser;
}

template <SampleKind kind, Levels levels> void makeGathered(HardPicture& picture, uint64_t key)
{
	makePicture(picture, key, kind);
	if (levels == Levels::moments || (levels == Levels::depths && mixed(key, 5) % 2 == 0))
	{
		makeLevels(picture, levels == Levels::moments);
	}
}

template <auto call, SampleKind kind, Levels levels = Levels::none> void runGather(Case& one)
{
	runOn(one, pictureOf<makeGathered<kind, levels>>(one), 1.0, false, call);
}

// cell: the side of a cell of visibility in pixels.
template <int cell> void makeFiltered(HardPicture& picture, uint64_t key)
{
	makePicture(picture, key, SampleKind::disk);
	picture.kernels.nook.cell = cell;
	picture.kernels.nook.window = 1 + static_cast<int>(key % 5);
	PicturePlane& cells = picture.visibility;
	if (cell > 2)
	{
		for (float& value : cells.values)
		{
			value = 0.5F + 0.2F * (value - 0.5F); // cells that differ more are left to be drawn
		}
	}
	cells.width = kPictureWidth / cell;
	cells.height = kPictureHeight / cell;
	PicturePlane& packed = picture.packed; // written by the pass before the filter
	packed = {cells.width, cells.height, 4, {}, {}};
	for (int i = 0; i < packed.width * packed.height; ++i)
	{
		const glm::ivec2 at(i % packed.width, i / packed.width);
		const float visibility = cells.values[cells.index(at.x, at.y)];
		const glm::vec4 value =
			cell == 1 ? picture.kernels.nookLinked(at, visibility) : picture.kernels.nookOfSurface(at, visibility);
		packed.values.insert(packed.values.end(), &value.x, &value.x + 4);
	}
	picture.kernels.packed = &packed;
}

constexpr double kMean = 1.0 + 1e-6; // rounding of weights may carry a mean a little beyond its cells

template <auto call, int cell> void runFilter(Case& one)
{
	runOn(one, pictureOf<makeFiltered<cell>>(one), kMean, cell > 1, call);
}

// How alike a cell and the next one along x are.
void runLinks(Case& one)
{
	runOn(one, pictureOf<makeFiltered<1>>(one), kMean, false,
		  [](auto& kernels, glm::ivec2 pixel) { return kernels.nookLinked(pixel, 1.0F).y; });
}

// A sample anywhere within the pixel, on its surface or off it.
void runCross(Case& one)
{
	const HardPicture& picture = pictureOf<makeFiltered<1>>(one);
	Narrow kernels = picture.kernels;
	const glm::ivec2 at = pixelOf(one);
	const float depth = std::min(kernels.nookDepth(at), picture.largest) * static_cast<float>(between(one.random, 0.5, 2.0));
	const glm::vec3 position = kernels.nookPosition(at, depth);
	one.note("position", position);
	runOn(one, picture, kMean, false,
		  [position](auto& own, glm::ivec2 pixel)
		  {
			  using Vec = decltype(own.nookNormal(pixel));
			  return own.nookGather(pixel, Vec(position), own.nookNormal(pixel));
		  });
}

struct Kernel
{
	std::string_view name;
	std::string_view unit; // of errors and threshold
	double most = 0.0;     // threshold
	void (*run)(Case&) = nullptr;
	uint32_t twin_every = 16; // one case in so many is compared with the twin
};

#define NOOK_CALL(name)                                                                                                            \
	[](auto& kernels, glm::ivec2 pixel)                                                                                            \
	{                                                                                                                              \
		return kernels.name(pixel);                                                                                                \
	}

constexpr std::array kKernels{
	Kernel{"volume-wild", "range only", 0.0, runWildVolume, 1},
	Kernel{"mask-frame", "cosine, length; over half the distance to the pole", 2.5e-6, runTangent, 1},
	Kernel{"vo-line", "visibility", 2e-5, runGather<NOOK_CALL(nookVoLine), SampleKind::line>},
	Kernel{"vo-point", "visibility", 3e-5, runGather<NOOK_CALL(nookVoPoint), SampleKind::ball>},
	Kernel{"vo-area", "visibility", 2.5e-4, runGather<NOOK_CALL(nookVoArea), SampleKind::area, Levels::moments>},
	Kernel{"alchemy", "visibility", kMostBound, runGather<NOOK_CALL(nookAlchemy), SampleKind::disk, Levels::depths>},
	Kernel{"slices", "visibility", kMostBound, runGather<NOOK_CALL(nookSlices), SampleKind::line>},
	Kernel{"crytek", "visibility", 4e-6, runGather<NOOK_CALL(nookCrytek), SampleKind::ball>},
	Kernel{"volumetric-ao", "visibility", kMostBound, runGather<NOOK_CALL(nookVolumetric), SampleKind::line>},
	Kernel{"hbao", "visibility", 2e-5, runGather<NOOK_CALL(nookHbao), SampleKind::direction>},
	Kernel{"sao", "visibility", kMostBound, runGather<NOOK_CALL(nookSao), SampleKind::spiral, Levels::depths>},
	Kernel{"gtao", "visibility", 3e-4, runGather<NOOK_CALL(nookGtao), SampleKind::slice>},
	Kernel{"bitmask", "visibility", 2e-5, runGather<NOOK_CALL(nookBitmask), SampleKind::slice>},
	Kernel{"filter-links", "likeness", kMostBound, runLinks},
	Kernel{"filter-bilateral", "visibility", kMostBound, runFilter<NOOK_CALL(nookBilateralY), 1>},
	Kernel{"filter-window", "visibility", 8e-4, runFilter<NOOK_CALL(nookWindow), 1>},
	Kernel{"filter-upsample", "visibility", 2e-4, runFilter<NOOK_CALL(nookUpsample), 2>},
	Kernel{"filter-sparse", "visibility", 1.5e-4, runFilter<NOOK_CALL(nookSparse), 4>},
	Kernel{"gather-cross", "visibility", kMostBound, runCross},
};

struct Result
{
	uint64_t compared = 0;
	uint64_t unsure = 0;
	uint64_t broken = 0;
	uint64_t outside = 0;
	uint64_t fault_at = UINT64_MAX; // the first case that is broken or outside
	uint64_t worst_at = 0;
	double worst = 0.0;

	bool passes(const Kernel& kernel) const
	{
		return broken + outside == 0 && worst <= kernel.most;
	}
	// `later` is of cases that follow.
	void add(const Result& later)
	{
		compared += later.compared;
		unsure += later.unsure;
		broken += later.broken;
		outside += later.outside;
		fault_at = std::min(fault_at, later.fault_at);
		worst_at = later.worst > worst ? later.worst_at : worst_at;
		worst = std::max(worst, later.worst);
	}
};

Result resultOf(const Case& one)
{
	const uint64_t fault_at = one.broken || one.outside ? one.index : UINT64_MAX;
	return {one.compared, one.unsure, one.broken, one.outside, fault_at, one.index, one.unsure ? 0.0 : one.error};
}

// FNV-1a of the name: each kernel's cases are the same whatever other kernels there are.
uint64_t keyOf(const Kernel& kernel, uint32_t seed)
{
	uint64_t hash = 0xcbf29ce484222325ULL;
	for (const char letter : kernel.name)
	{
		hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
	}
	return mixed(hash, seed);
}

Result runKernel(const Kernel& kernel, uint32_t seed, uint64_t cases)
{
	constexpr uint64_t kChunk = 128 * kPictureCases;
	std::vector<Result> chunks((cases + kChunk - 1) / kChunk);
	parallelFor(chunks.size(), availableThreads(),
				[&](std::size_t chunk)
				{
					for (uint64_t i = chunk * kChunk; i < std::min(cases, (chunk + 1) * kChunk); ++i)
					{
						Case one(keyOf(kernel, seed), i, i % kernel.twin_every == 0, false);
						kernel.run(one);
						chunks[chunk].add(resultOf(one));
					}
				});
	Result result;
	for (const Result& chunk : chunks)
	{
		result.add(chunk);
	}
	return result;
}

bool print(const Kernel& kernel, uint32_t seed, const Result& result)
{
	std::printf("%-17s %9llu %8llu %4llu %6llu  %-9s %-9s %-9llu %s\n", std::string(kernel.name).c_str(),
				static_cast<unsigned long long>(result.compared), static_cast<unsigned long long>(result.unsure),
				static_cast<unsigned long long>(result.broken), static_cast<unsigned long long>(result.outside),
				roundedText(result.worst, 3).c_str(), roundedText(kernel.most, 3).c_str(),
				static_cast<unsigned long long>(result.worst_at), std::string(kernel.unit).c_str());
	if (!result.passes(kernel))
	{
		const uint64_t at = result.broken + result.outside > 0 ? result.fault_at : result.worst_at;
		std::printf("FAILED: nook_stress --kernel %s --seed %u --case %llu\n", std::string(kernel.name).c_str(), seed,
					static_cast<unsigned long long>(at));
	}
	std::fflush(stdout);
	return result.passes(kernel);
}

int run(int argc, char** argv)
{
	uint64_t cases = 50'000;
	uint32_t seed = 1;
	std::vector<std::string> names;
	std::optional<uint64_t> shown;
	CLI::App app("Runs kernels on inputs that are hard for 32 bits, and compares them with twins of 80 bits");
	app.add_option("--cases", cases, "Cases per kernel")->check(CLI::Range(uint64_t{1}, uint64_t{1'000'000'000'000}));
	app.add_option("--seed", seed, "Every case's numbers follow from this and its index");
	std::vector<std::string> known;
	for (const Kernel& kernel : kKernels)
	{
		known.emplace_back(kernel.name);
	}
	app.add_option("--kernel", names, "Only this kernel; may be repeated")->check(CLI::IsMember(known))->allow_extra_args(false);
	app.add_option("--case", shown, "Prints one case of one kernel: its input, its result, the twin's");
	try
	{
		app.parse(argc, argv);
		if (shown && names.size() != 1)
		{
			throw CLI::ValidationError("--case", "found " + std::to_string(names.size()) + " times --kernel, expected it once");
		}
	}
	catch (const CLI::ParseError& error)
	{
		return app.exit(error) == 0 ? 0 : 1;
	}
	bool passed = true;
	if (!shown)
	{
		std::printf("%-17s %9s %8s %4s %6s  %-9s %-9s %-9s %s\n", "kernel", "compared", "unsure", "NaN", "range", "worst",
					"threshold", "at case", "unit");
	}
	for (const Kernel& kernel : kKernels)
	{
		if (!names.empty() && std::find(names.begin(), names.end(), kernel.name) == names.end())
		{
			continue;
		}
		if (shown)
		{
			Case one(keyOf(kernel, seed), *shown, true, true);
			kernel.run(one);
			one.note("error", one.error);
			return resultOf(one).passes(kernel) ? 0 : 7;
		}
		passed = print(kernel, seed, runKernel(kernel, seed, cases)) && passed;
	}
	return passed ? 0 : 7;
}

} // namespace
} // namespace nook::stress

int main(int argc, char** argv)
{
	return nook::stress::run(argc, argv);
}
