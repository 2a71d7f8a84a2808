// SPDX-License-Identifier: GPL-3.0-or-later
// Protocol between gltf_expand.cpp and the worker that decodes compressed glTF data (decode_meshopt.cpp, decode_draco.cpp).
#pragma once

#include "core/value_stream.h"

#include <cstdint>

namespace nook
{

// Decodes buffer views of EXT_meshopt_compression. Request: a name for errors, the number of views, and for each this struct and
// its bytes. Answer: for each its count × stride bytes.
struct MeshoptView
{
	enum class Mode : uint32_t
	{
		attributes,
		triangles,
		indices,
	};
	enum class Filter : uint32_t
	{
		none,
		octahedral,
		quaternion,
		exponential,
	};
	uint64_t index = 0; // index in the file, for errors
	uint64_t count = 0;
	uint64_t stride = 0;
	Mode mode = Mode::attributes;
	Filter filter = Filter::none;
};
inline constexpr const char* kDecodeMeshopt = "decode meshopt";
void decodeMeshopt(ValueReader& request, ValueWriter& answer);

// Decodes meshes of KHR_draco_mesh_compression. Request: a name for errors, the number of meshes, and for each its bytes and its
// attributes as below. Answer: for each its number of vertices, three 32-bit indices per triangle, and the values of each attribute
// in the requested type.
struct DracoAttribute
{
	uint32_t id = 0;
	uint32_t component = 0;  // 5120 … 5126
	uint32_t components = 0; // per vertex
};
inline constexpr const char* kDecodeDraco = "decode draco";
void decodeDraco(ValueReader& request, ValueWriter& answer);

} // namespace nook
