// SPDX-License-Identifier: GPL-3.0-or-later
// A KTX2 file of plain texels → how opaque each is: what `ktx transcode --target rgba8` makes of Basis Universal.
#pragma once

#include "core/image.h"

#include <string>
#include <string_view>

namespace nook
{

// True for bytes that begin as a KTX2 file does.
bool isKtx2(std::string_view bytes);

// The largest level of a texture with two dimensions, of eight bits a channel. `name` is that of errors. Throws Error: unsupported
// for compressed texels, with the command that makes them plain; invalid_input where the file is not whole or has more than
// `max_texels`.
AlphaImage alphaOfKtx2(std::string_view bytes, const std::string& name, MaskChannel channel, std::size_t max_texels);

} // namespace nook
