// SPDX-License-Identifier: GPL-3.0-or-later
// Between gltf_expand.cpp and the worker that decodes what a glTF's extensions compress (decode_meshopt.cpp, decode_draco.cpp).
#pragma once

#include "core/value_stream.h"

#include <cstddef>
#include <cstdint>

namespace nook
{

// One buffer view of EXT_meshopt_compression, its bytes behind it → bytes. The request: a name for errors, the number of views, and
// of each this and its bytes. The answer: of each its count × stride bytes.
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
	uint64_t index = 0; // in the file, for errors
	uint64_t count = 0;
	uint64_t stride = 0;
	Mode mode = Mode::attributes;
	Filter filter = Filter::none;
};
inline constexpr const char* kDecodeMeshopt = "decode meshopt";
void decodeMeshopt(ValueReader& request, ValueWriter& answer);

// One mesh of KHR_draco_mesh_compression. The request: a name for errors, the number of meshes, and of each its bytes and its
// attributes as below. The answer: of each the number of its vertices, three indices of 32 bits a triangle, and of each attribute
// all of its numbers, of the type that was asked for.
struct DracoAttribute
{
	uint32_t id = 0;
	uint32_t component = 0;  // 5120 … 5126
	uint32_t components = 0; // of a vertex
};
inline constexpr const char* kDecodeDraco = "decode draco";
void decodeDraco(ValueReader& request, ValueWriter& answer);

} // namespace nook
