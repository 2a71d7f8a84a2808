// SPDX-License-Identifier: GPL-3.0-or-later
// A level, or an image → the facts that `nook info` prints.
#pragma once

#include "core/facts.h"
#include "core/image.h"
#include "scene/load.h"

#include <string>

namespace nook
{

// With its diagnosis, and the asset that suits it.
void describeLevel(const LoadedLevel& loaded, int threads, Facts& facts);

// Whether a name ends as an image does: .exr .png .jpg .jpeg .tif .tiff .hdr .tga .bmp, in any case.
bool isImageName(const std::string& path);

// A G-buffer, visibility or any other picture.
void describeImage(const Image& image, Facts& facts);

} // namespace nook
