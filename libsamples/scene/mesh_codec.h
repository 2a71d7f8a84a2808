// SPDX-License-Identifier: GPL-3.0-or-later
// Component types, and the protocol between gltf_expand.cpp and the worker that decodes compressed glTF data (level_worker.cpp,
// decode_draco.cpp).
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

// Calls use(T{}) with the type T of a glTF component, 5120 to 5126.
template <class Use> auto withComponent(uint64_t component, const Use& use)
{
	switch (component)
	{
	case 5120: return use(int8_t{});
	case 5121: return use(uint8_t{});
	case 5122: return use(int16_t{});
	case 5123: return use(uint16_t{});
	case 5125: return use(uint32_t{});
	default: return use(float{});
	}
}

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
