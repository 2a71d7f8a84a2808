// SPDX-License-Identifier: GPL-3.0-or-later
// The method table: one row per method with everything the program knows about it. Parser, checks, modules, candidates and reports
// read the rows and name no method. A new method is a row (method_rows.cpp, statvo.cpp or published.cpp), its kernel and a test.
#pragma once

#include "methods/candidate_axes.h"
#include "methods/feature_table.h"
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
	screen,  // a ShadeMethod: uses only depth and normals
	volumes, // draws a level's occlusion volumes
};

// Meaning of a sample's third number.
enum class SampleThird
{
	z,
	half_length, // of a line
	log2_side,   // of an area, in radii
};

// AOV §6: the radius of volumetric methods against that of rays with linear falloff.
inline constexpr double kVolumetricRatio = 1.1;

// Features that several methods may take (feature_table.h), as bits.
inline constexpr unsigned kOfNormals = 1U << 0U;   // with or without the pixel's normal
inline constexpr unsigned kOfVolume = 1U << 1U;    // thickness, two radii, falloff
inline constexpr unsigned kOfPairs = 1U << 2U;     // samples with opposites
inline constexpr unsigned kOfIntensity = 1U << 3U; // Alchemy's factors
inline constexpr unsigned kOfBands = 1U << 4U;     // fewer samples far away

struct MethodRow
{
	MethodKind kind = MethodKind::screen;
	ShadeMethod method{};                                   // kind screen: its position in the table, set by methodTable()
	std::string_view name{};                                // on the command line and in candidates: "vo-line"
	std::string_view what{};                                // short description, used for its entry in a module
	std::string_view page{};                                // docs page: "vo.md"
	bool emitted = false;                                   // available in nook emit and nook tune
	bool needs_normals = false;                             // regardless of its features
	unsigned features = 0;                                  // bits of the features it supports
	std::vector<FeatureRow> options{};                      // options that no other method has
	bool masks = false;                                     // kind volumes: direction bits instead of sums
	double radius_ratio = 1.0;                              // its radius relative to that of equivalent rays with linear falloff
	std::vector<CandidateAxes> (*axes)(GridSize) = nullptr; // kind screen: variants to compare

	// Samples.
	std::optional<Domain> domain{};                              // of the patterns it takes; none: it has its own samples
	std::optional<Domain> tile_domain{};                         // of the tiles that can replace its own samples
	SampleThird third = SampleThird::z;                          // in a pattern's sample
	Pattern (*own_pattern)(int count) = nullptr;                 // replaces nook's default pattern
	int default_count = 9;                                       // number of samples without a given pattern
	ShadeSamples (*own_samples)(const ShadeSettings&) = nullptr; // for methods without a domain
	void (*set_count)(ShadeSettings&, int) = nullptr;           // samples, layers or directions; null: the pattern's count suffices
	std::string (*layers_text)(const ShadeSettings&) = nullptr; // replaces the number of samples: "4 adaptive layers, full tables"
	int (*set_best)(ShadeSettings&) = nullptr;                  // sets the best quality and returns the count; null: 256 samples

	// Passes.
	ShadeKernel kernel{};
	ShadeKernel bent_kernel{};                            // bent normals with visibility; without a call: not supported
	ShadeKernel open_kernel{};                            // writes their input for a filter
	int (*sample_depths)(const ShadeSettings&) = nullptr; // upper bound of the kernel's depth reads per sample; null: 1
	int tile_binding = 0;                                 // of its tile in modules for OpenGL 4.3 and Vulkan
	bool moments = false;                                 // reads the moments of depth
	int (*levels)(const ShadeSettings&) = nullptr;        // number of coarser depth levels that it reads; null: none
	void (*add_passes)(ShadePlan&, ShadePass& method, const ShadeBlock&, const ShadeSettings&, bool compute) = nullptr;
	std::string (*passes_text)(const ShadeSettings&) = nullptr; // describes add_passes, one line per pass, for users of a module
	void (*fill)(ShadeBlock&, const ShadeSettings&) = nullptr;  // fills its part of the block

	// Debug views; without a call: not applicable to the method.
	ShadeKernel samples_view{};
	ShadeKernel lod_view{}; // if it reads levels or moments
	ShadeKernel layers_view{};
	int noise_variants = 0; // 0: those of the window
};

// Screen-space methods in the order of ShadeMethod, then volume methods.
std::span<const MethodRow> methodTable();

const MethodRow& rowOf(ShadeMethod method);
const MethodRow& volumeRow(bool masks);

// Null if no method has that name.
const MethodRow* methodNamed(std::string_view name);

// Names of the matching rows in order: "vo-line, vo-area".
std::string methodNames(const std::function<bool(const MethodRow&)>& fits, const std::string& between = ", ");

// True if it takes samples, whose noise a filter can remove.
bool hasNoise(const MethodRow& row);

// The view of samples for methods that take all of them everywhere.
ShadeKernel allSamples();

// Depths that the kernel reads for each sample, at most.
int sampleDepths(const MethodRow& row, const ShadeSettings& settings);

// True if it needs additional passes with these settings.
bool hasPasses(const MethodRow& row, const ShadeSettings& settings);

// Rows of methodTable(), by file.
std::vector<MethodRow> volumetricRows();
std::vector<MethodRow> alchemyRows();
std::vector<MethodRow> statVoRows();
std::vector<MethodRow> sliceRows();
std::vector<MethodRow> publishedRows();
std::vector<MethodRow> volumeRows();

// The tables of methods and features in the docs, as Markdown.

// A line per method.
std::string methodsText();

// A line per feature that the method takes in `nook shade`: option, unit, range, default, what it does.
std::string optionsText(const MethodRow& method);

std::string rangeText(const FeatureRow& feature);
std::string defaultText(const FeatureRow& feature);

} // namespace nook
