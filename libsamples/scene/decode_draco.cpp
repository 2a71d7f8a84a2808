// SPDX-License-Identifier: GPL-3.0-or-later
// Part of the level worker: decodes meshes of KHR_draco_mesh_compression with Draco.
#include "scene/mesh_codec.h"

#include "core/file.h"
#include "core/words.h"

#include <draco/compression/decode.h>

#include <string>
#include <vector>

namespace nook
{
namespace
{

void refuseMeshIf(bool condition, const std::string& name, const std::string& found, const std::string& expected)
{
	refuseInputIf(condition, name + ": KHR_draco_mesh_compression", found, expected);
}

std::unique_ptr<draco::Mesh> meshOf(const std::string& name, const std::vector<char>& coded)
{
	draco::DecoderBuffer buffer;
	buffer.Init(coded.data(), coded.size());
	draco::StatusOr<std::unique_ptr<draco::Mesh>> mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
	refuseMeshIf(!mesh.ok(), name, "\"" + mesh.status().error_msg_string().substr(0, 200) + "\"", "a mesh that Draco decodes");
	return std::move(mesh).value();
}

template <class T>
bool convert(const draco::PointAttribute& attribute, uint32_t points, std::size_t components, std::vector<char>& bytes)
{
	std::vector<T> values(points * components);
	bool good = true;
	for (uint32_t i = 0; i < points && good; ++i)
	{
		good = attribute.ConvertValue<T>(attribute.mapped_index(draco::PointIndex(i)), static_cast<int8_t>(components),
										 values.data() + i * components);
	}
	bytes.assign(reinterpret_cast<const char*>(values.data()), reinterpret_cast<const char*>(values.data() + values.size()));
	return good;
}

bool convert(const draco::PointAttribute& attribute, uint32_t points, const DracoAttribute& as, std::vector<char>& bytes)
{
	return withComponent(as.component, [&](auto zero) { return convert<decltype(zero)>(attribute, points, as.components, bytes); });
}

void send(const std::string& name, const draco::Mesh& mesh, const std::vector<DracoAttribute>& attributes, ValueWriter& answer)
{
	answer.value(uint64_t{mesh.num_points()});
	std::vector<uint32_t> indices;
	indices.reserve(std::size_t{3} * mesh.num_faces());
	for (uint32_t i = 0; i < mesh.num_faces(); ++i)
	{
		for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(i)))
		{
			indices.push_back(corner.value());
		}
	}
	answer.values(indices);
	std::vector<char> bytes;
	for (const DracoAttribute& as : attributes)
	{
		const draco::PointAttribute* const attribute = mesh.GetAttributeByUniqueId(as.id);
		refuseMeshIf(attribute == nullptr, name, "no attribute " + std::to_string(as.id), "those that the primitive names");
		refuseMeshIf(static_cast<uint32_t>(attribute->num_components()) != as.components ||
						 !convert(*attribute, mesh.num_points(), as, bytes),
					 name, std::to_string(attribute->num_components()) + " components of attribute " + std::to_string(as.id),
					 std::to_string(as.components));
		answer.values(bytes);
	}
}

} // namespace

void decodeDraco(ValueReader& request, ValueWriter& answer)
{
	std::vector<std::string> names;
	std::vector<std::vector<char>> coded;
	std::vector<std::vector<DracoAttribute>> attributes;
	for (auto left = request.value<uint64_t>(); left > 0; --left)
	{
		names.push_back(request.text());
		request.values(coded.emplace_back(), kMaxFileBytes);
		request.values(attributes.emplace_back(), 16);
	}
	for (std::size_t i = 0; i < names.size(); ++i)
	{
		send(names[i], *meshOf(names[i], coded[i]), attributes[i], answer);
		std::vector<char>().swap(coded[i]);
	}
}

} // namespace nook
