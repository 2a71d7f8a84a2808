// SPDX-License-Identifier: GPL-3.0-or-later
// Settings → the passes that make the picture, one after the other, for the CPU and for OpenGL.
#pragma once

#include "shade/kernels.h"
#include "shade/shade.h"

#include <vector>

namespace nook
{

// One kernel in both languages.
struct ShadeKernel
{
	const char* name = ""; // for people
	const char* call = ""; // in GLSL
	float (shade_kernels::Kernels::*function)(glm::ivec2 at) = nullptr;
};

struct ShadePass
{
	ShadeKernel kernel;
	bool of_pixel = false;         // takes the pixel of its cell, not the cell
	bool reads_visibility = false; // the picture of the pass before it
	bool fills = false;            // only where that picture is negative, and keeps the rest
	int width = 0;                 // of its own picture: cells or pixels
	int height = 0;
	ShadeBlock block;
};

// Never empty. Throws as blockOf.
std::vector<ShadePass> passesOf(const GBuffer& gbuffer, const ShadeSamples& samples, const ShadeSettings& settings);

} // namespace nook
