// SPDX-License-Identifier: GPL-3.0-or-later
// The channel of a picture that says how opaque it is → where a texel holds it, and its value. Shared by the workers of images.
#pragma once

#include "core/image.h"

#include <cstdint>

namespace nook
{

// Channels [first, first + count) of a texel: one, or the three that a luminance is made of; none where all of it is opaque.
struct ChannelPlace
{
	int first = 0;
	int count = 0;
};

// `colours`: channels before the alpha channel; `alpha`: that one's index, or -1.
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

// `at`: the first of the channels, 8 bits each. ITU-R BT.709 item 3.2.
inline uint8_t maskValue(const uint8_t* at, ChannelPlace place)
{
	return place.count < 3 ? at[0] : static_cast<uint8_t>((2126U * at[0] + 7152U * at[1] + 722U * at[2] + 5000U) / 10000U);
}

} // namespace nook
