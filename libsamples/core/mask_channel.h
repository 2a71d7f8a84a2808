// SPDX-License-Identifier: GPL-3.0-or-later
// Locates the opacity channel of a picture in a texel and reads it. Shared by the image workers.
#pragma once

#include "core/image.h"

#include <cstdint>

namespace nook
{

// Channels [first, first + count) of a texel: one, or three for luminance; none if fully opaque.
struct ChannelPlace
{
	int first = 0;
	int count = 0;
};

// `colours` is the number of channels before alpha; `alpha` is its index, or -1.
inline ChannelPlace placeOf(MaskChannel channel, int colours, int alpha)
{
	const int colour = static_cast<int>(channel) - static_cast<int>(MaskChannel::red);
	switch (channel)
	{
	case MaskChannel::alpha: return {alpha, alpha >= 0 ? 1 : 0};
	case MaskChannel::alpha_or_first: return {alpha >= 0 ? alpha : 0, 1};
	case MaskChannel::luminance: return {0, colours >= 3 ? 3 : 1};
	case MaskChannel::red:
	case MaskChannel::green:
	case MaskChannel::blue: break;
	}
	return {colour < colours ? colour : 0, 1};
}

// `at` points to the first of these channels, 8 bits each. ITU-R BT.709 item 3.2.
inline uint8_t maskValue(const uint8_t* at, ChannelPlace place)
{
	return place.count < 3 ? at[0] : static_cast<uint8_t>((2126U * at[0] + 7152U * at[1] + 722U * at[2] + 5000U) / 10000U);
}

} // namespace nook
