// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gltf_file.h"
#include "scene/load_parts.h"

namespace nook
{
namespace
{

uint64_t indexAt(std::string_view bytes, std::size_t at, std::size_t size)
{
	uint64_t index = 0;
	for (std::size_t i = 0; i < size; ++i)
	{
		index |= uint64_t{static_cast<unsigned char>(bytes[at + i])} << (8U * i);
	}
	return index;
}

// Triangles of a primitive's list of indices that name a vertex beyond `vertices`; for strips and fans, such indices.
void countPrimitive(GltfFile& file, const GltfItem& primitive, Tally& tally)
{
	const GltfItem attributes = primitive.objectNeeded("attributes");
	if (!primitive.has("indices") || !attributes.has("POSITION"))
	{
		return;
	}
	const GltfItem root = file.root();
	const auto item_of = [&](const GltfItem& item, std::string_view field)
	{
		return root.item("accessors", item.indexNeeded(field, root.count("accessors")));
	};
	const GltfItem indices = item_of(primitive, "indices");
	if (!indices.has("bufferView") || indices.has("sparse"))
	{
		return; // zeros, or too rare to unfold: what is wrong there Assimp leaves out
	}
	const uint64_t vertices = item_of(attributes, "POSITION").wholeNeeded("count", UINT32_MAX);
	const uint64_t component = indices.wholeNeeded("componentType", UINT16_MAX);
	const std::size_t size = component == 5121 ? 1 : component == 5123 ? 2 : 4;
	const std::size_t per_face = primitive.whole("mode", 6).value_or(4) == 4 ? 3 : 1;
	const auto view = static_cast<std::size_t>(indices.wholeNeeded("bufferView", UINT32_MAX));
	const auto stride = static_cast<std::size_t>(root.item("bufferViews", view).whole("byteStride", 252).value_or(size));
	const auto offset = static_cast<std::size_t>(indices.whole("byteOffset", UINT32_MAX).value_or(0));
	const auto count = static_cast<std::size_t>(indices.wholeNeeded("count", UINT32_MAX));
	const std::string_view bytes = viewBytes(file, view);
	for (std::size_t face = 0; face + per_face <= count; face += per_face)
	{
		bool inside = true;
		for (std::size_t i = face; i < face + per_face; ++i)
		{
			inside = inside && indexAt(bytes, offset + i * stride, size) < vertices;
		}
		if (!inside)
		{
			tally.add(primitive.where() + (per_face == 3 ? ", triangle " : ", index ") + std::to_string(face / per_face));
		}
	}
}

} // namespace

Tally badIndices(GltfFile& file)
{
	Tally tally;
	for (const GltfItem& mesh : file.root().objects("meshes"))
	{
		for (const GltfItem& primitive : mesh.objects("primitives"))
		{
			countPrimitive(file, primitive, tally);
		}
	}
	return tally;
}

} // namespace nook
