// SPDX-License-Identifier: GPL-3.0-or-later
// Small pictures that are hard to shade: what a depth buffer may hold, with normals, samples and settings.
#pragma once

#include "methods/kernels.h"
#include "stress/cameras.h"
#include "stress/case.h"
#include "stress/wide.h"

#include <functional>
#include <vector>

namespace nook::stress
{

inline constexpr int kPictureWidth = 16;
inline constexpr int kPictureHeight = 8;
inline constexpr uint64_t kPictureCases = kPictureWidth * kPictureHeight; // that share a picture: one a pixel

// What the fourth number of a sample means is the method's affair.
enum class SampleKind
{
	line,      // x, y, half length, weight
	area,      // x, y, log2 of a side, weight
	ball,      // x, y, z, weight
	disk,      // x, y, -, weight
	direction, // cosine, sine, share of a step, weight
	slice,     // the same, of GTAO and bit masks
	spiral,    // x, y, distance, weight
};

// Moves only while nothing refers to it: `kernels` looks into the rest.
struct HardPicture
{
	HardCamera camera;
	std::vector<float> depths;
	std::vector<glm::vec3> normals;
	std::vector<glm::vec4> samples;
	PicturePlane visibility;          // of pixels, in [0, 1]
	PicturePlane packed;              // empty until a filter fills it
	std::vector<PicturePlane> levels; // empty until a method fills them
	shade_kernels::Kernels kernels;
	float largest = 0.0F; // depth that is none of the sky
};

// Depths (planes at any slope, steps, noise, near and far plane, sky), normals (the plane's own, any), a radius of 10⁻⁸ to 10⁸
// metres or of 2⁻⁴ to 2⁷ pixels, and every feature that settings have.
void makePicture(HardPicture& picture, uint64_t key, SampleKind kind);

// The pixel that a case looks at.
inline glm::ivec2 pixelOf(const Case& one)
{
	const auto i = static_cast<int>(one.index() % kPictureCases);
	return {i % kPictureWidth, i / kPictureWidth};
}

// Against a kernel in wide numbers. Where these cannot tell what 32 bits decide, or by more than kMostBound what they come to, the
// case is left open.
inline constexpr double kMostBound = 1e-3;
void compareWide(Case& one, std::string_view name, double found, const std::function<Wide()>& twin);

void noteBlock(Case& one, const ShadeBlock& block);
void notePicture(Case& one, const HardPicture& picture, glm::ivec2 pixel);

} // namespace nook::stress
