// SPDX-License-Identifier: GPL-3.0-or-later
// A pass → the fragment shader that draws it in OpenGL 3.3.
#pragma once

#include "methods/passes.h"

#include <string>

namespace nook
{

// Of the kernels what the pass reaches, with the whole numbers of its block as constants, as in an emitted module: loops unroll,
// and what is not asked for costs nothing.
std::string glSourceOf(const ShadePass& pass, PictureFormat format);

} // namespace nook
