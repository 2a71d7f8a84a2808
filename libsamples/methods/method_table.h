// SPDX-License-Identifier: GPL-3.0-or-later
// The table of methods: a row a method, with everything by which the program knows it. Parser, checks, modules, candidates and
// reports read rows and name no method. A new method is a row here and its kernel.
#pragma once

#include "methods/candidate_axes.h"
#include "methods/passes.h"

#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

enum class MethodKind
{
	screen,  // of ShadeMethod: from depth and normals alone
	volumes, // draws the occlusion volumes of a level
};

// What the third number of a sample is.
enum class SampleThird
{
	z,
	half_length, // of a line
	log2_side,   // of an area, in radii
};

// Which features a method takes (feature_table.h), as bits.
inline constexpr unsigned kOfNormals = 1U << 0U;   // with or without the pixel's normal
inline constexpr unsigned kOfVolume = 1U << 1U;    // thickness, two radii, falloff
inline constexpr unsigned kOfPairs = 1U << 2U;     // samples with opposites
inline constexpr unsigned kOfIntensity = 1U << 3U; // Alchemy's factors
inline constexpr unsigned kOfBands = 1U << 4U;     // fewer samples far away
inline constexpr unsigned kOfLayers = 1U << 5U;    // layers of depth and their tables
inline constexpr unsigned kOfRange = 1U << 6U;     // Crytek's
inline constexpr unsigned kOfHorizon = 1U << 7U;   // directions and steps
inline constexpr unsigned kOfSpiral = 1U << 8U;
inline constexpr unsigned kOfSlices = 1U << 9U;   // slices, steps and their thickness
inline constexpr unsigned kOfGtao = 1U << 10U;    // the same of GTAO
inline constexpr unsigned kOfBitmask = 1U << 11U; // the same of bit masks as published

struct MethodRow
{
	MethodKind kind = MethodKind::screen;
	ShadeMethod method{};       // of kind screen
	std::string_view name{};    // on the command line and in candidates: "vo-line"
	std::string_view what{};    // a few words, of its entry in a module
	std::string_view page{};    // of the docs: "vo.md"
	bool emitted = false;       // nook emit and nook tune have it
	bool needs_normals = false; // whatever its features
	unsigned features = 0;      // bits of those that it takes
	bool masks = false;         // of kind volumes: bits of directions in place of sums
	double radius_ratio = 1.0;  // of its radius to that of rays with linear falloff that read the same
	bool swept = false;         // papers speak of its time over the radius
	int swept_count = 0;        // of the recipe that is drawn at several radii; 0: of its first
	int shown_paper = 0;        // place among the pictures of papers' recipes, from 1; 0: only where it holds the front
	int shown_ours = 0;         // the same of nook's forms
	std::vector<CandidateAxes> (*axes)(GridSize) = nullptr; // of kind screen: what is tried of it

	// Samples.
	std::optional<Domain> domain{};                              // of the patterns that it takes; none: samples are its own
	std::optional<Domain> tile_domain{};                         // of the tiles that it takes in place of samples of its own
	SampleThird third = SampleThird::z;                          // of a pattern's sample
	Pattern (*own_pattern)(int count) = nullptr;                 // instead of nook's, where none is given
	int default_count = 9;                                       // of samples where no pattern is given
	ShadeSamples (*own_samples)(const ShadeSettings&) = nullptr; // without a domain
	void (*set_count)(ShadeSettings&, int) = nullptr;            // samples, layers or directions; null: the pattern's count is all
	std::string (*layers_text)(const ShadeSettings&) = nullptr; // in place of a number of samples: "4 adaptive layers, full tables"
	int (*set_best)(ShadeSettings&) = nullptr;                  // the best it can do, returns that count; null: 256 samples

	// Passes.
	ShadeKernel kernel{};
	ShadeKernel bent_kernel{};                                       // bent normals beside visibility; without a call: it has none
	ShadeKernel open_kernel{};                                       // what a filter makes them of
	int (*depth_reads)(const ShadeSettings&, int samples) = nullptr; // of the kernel, at most; of methods in modules
	int tile_binding = 0;                                            // of its tile in modules for OpenGL 4.3 and Vulkan
	bool moments = false;                                            // reads the moments of depth
	int (*levels)(const ShadeSettings&) = nullptr;                   // coarser depths that it reads; null: none
	void (*add_passes)(ShadePlan&, ShadePass& method, const ShadeBlock&, const ShadeSettings&, bool compute) = nullptr;
	std::string (*passes_text)(const ShadeSettings&) = nullptr; // of add_passes, a line each, for whoever draws a module
	void (*fill)(ShadeBlock&, const ShadeSettings&) = nullptr;  // its own part of the block

	// Debug views; without a call: says nothing of the method.
	ShadeKernel samples_view{};
	ShadeKernel lod_view{}; // where levels or moments are read
	ShadeKernel layers_view{};
	std::string_view levels_option{}; // that turns levels on; empty: they are on without
	int noise_variants = 0;           // 0: those of the window
};

// Screen-space methods in the order of ShadeMethod, then those of volumes.
std::span<const MethodRow> methodTable();

const MethodRow& rowOf(ShadeMethod method);
const MethodRow& volumeRow(bool masks);

// Null where no method has that name.
const MethodRow* methodNamed(std::string_view name);

// Of rows that fit, in order: "vo-line, vo-area".
std::string methodNames(const std::function<bool(const MethodRow&)>& fits, const std::string& between = ", ");

// It takes samples, so that a filter has something to take out.
bool hasNoise(const MethodRow& row);

// Passes of its own before it, with these settings.
bool hasPasses(const MethodRow& row, const ShadeSettings& settings);

} // namespace nook
