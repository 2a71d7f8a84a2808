// SPDX-License-Identifier: MIT
// OpenGL helpers shared by both halves of the program.
#pragma once

#include <epoxy/gl.h>

#include <string>

// Throws Failure (4) with the driver's first error line.
unsigned programOf(const std::string& vertex_source, const std::string& fragment_source);

// A program drawn over the whole picture: glDrawArrays(GL_TRIANGLES, 0, 3).
unsigned screenProgram(const std::string& fragment_source);

// Read by texelFetch; `values` may be null.
unsigned screenTexture(int format, int width, int height, const float* values = nullptr);

// Throws Failure (4) if it is incomplete.
unsigned frameOf(unsigned color, unsigned depth = 0, int color_level = 0);

// Binds to a sampler of the current program.
void bindTexture(unsigned program, const char* sampler, int unit, unsigned texture);
