// SPDX-License-Identifier: GPL-3.0-or-later
// An image, a G-buffer or visibility → the lines that `nook info` prints, and the same facts as JSON.
#pragma once

#include "summary.h"

#include "core/image.h"

#include <string>

namespace nook
{

// By its ending: .exr .png .jpg .jpeg .tif .tiff .hdr .tga .bmp, in any case.
bool isImageName(const std::string& path);

std::string describeImage(const Image& image, Summary& summary);

} // namespace nook
