// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF file whose buffers and views are checked → the same without compression: KHR_draco_mesh_compression and
// EXT_meshopt_compression, where the file has nothing else beside them.
#pragma once

#include "scene/gltf_file.h"

namespace nook
{

// Whether a buffer is only there to be decoded into: EXT_meshopt_compression, "fallback". It holds nothing.
bool isFallbackBuffer(const JsonValue& buffer);

// Decodes in a worker (core/isolate.h), and gives views, accessors and primitives of `file` what was decoded, in buffers behind
// its own. True where anything was. Throws Error: invalid_input where it does not decode, or claims more than it can hold;
// unsupported for Draco in a build without it.
bool expandGltf(GltfFile& file);

} // namespace nook
