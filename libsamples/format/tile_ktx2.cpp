// SPDX-License-Identifier: GPL-3.0-or-later
#include "format/tile_json.h"

#include "core/round.h"
#include "format/ktx2.h"
#include "format/tile_texture.h"

namespace nook
{

std::string tileKtx2(const PatternTile& tile, const TileQuality& quality, const EmitContext& context)
{
	const TileTexture texture = textureOf(tile, true);
	const int layers = texture.height_px / texture.layer_height_px;
	Ktx2Texture made;
	made.width = static_cast<uint32_t>(texture.width_px);
	made.height = static_cast<uint32_t>(texture.layer_height_px);
	made.layers = static_cast<uint32_t>(layers > 1 ? layers : 0);
	made.notes = notesOf(context, measuresOf(quality));
	made.notes.push_back({"Layout", texture.layout});
	made.notes.push_back({"KTXorientation", "rd"}); // rows from the top
	made.notes.push_back({"KTXwriter", "nook " + context.version});
	made.bytes.reserve(4 * texture.rgba.size());
	for (const float value : texture.rgba)
	{
		const auto bits = bitsAs<uint32_t>(value);
		for (int i = 0; i < 4; ++i)
		{
			made.bytes += static_cast<char>((bits >> (8 * i)) & 0xFFU);
		}
	}
	return ktx2Bytes(made);
}

} // namespace nook
