// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

#include "core/words.h"

#include <algorithm>

namespace nook
{
namespace
{

// OpenImageIO versions spell worldToCamera differently.
bool sameKey(std::string_view a, std::string_view b)
{
	return lowered(a) == lowered(b);
}

} // namespace

int Image::channel(std::string_view name) const
{
	const auto found = std::find(channels.begin(), channels.end(), name);
	return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

const ImageMatrix* Image::matrix(std::string_view key) const
{
	const auto found = std::find_if(matrices.begin(), matrices.end(), [key](const ImageMatrix& m) { return sameKey(m.key, key); });
	return found == matrices.end() ? nullptr : &*found;
}

} // namespace nook
