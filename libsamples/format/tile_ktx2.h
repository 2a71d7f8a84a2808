// SPDX-License-Identifier: GPL-3.0-or-later
// A tile → a KTX2 file of one texture of 32-bit floats, what tile_texture.h says: frames that have tiles of their own are the
// layers of an array, so that a texture is no wider than size² texels.
#pragma once

#include "format/notes.h"

#include <string>

namespace nook
{

std::string tileKtx2(const PatternTile& tile, const TileQuality& quality, const EmitContext& context);

} // namespace nook
