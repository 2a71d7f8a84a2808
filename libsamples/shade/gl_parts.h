// SPDX-License-Identifier: GPL-3.0-or-later
// What all programs on OpenGL share: compiling, linking, and how long something takes.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace nook
{

// Throws Error (runtime) with the compiler's first line.
unsigned compiledShader(unsigned kind, const std::string& source);

// Deletes the shaders. Throws Error (runtime).
unsigned linkedProgram(const std::vector<unsigned>& shaders);

// Throws Error (runtime) for what OpenGL noted since the last time.
void checkGlErrors();

// Runs it once, alone and to its end; seconds by the driver's timer with `timer`, else by the clock.
double secondsOf(const std::function<void()>& commands, bool timer);

} // namespace nook
