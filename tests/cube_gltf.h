// SPDX-License-Identifier: GPL-3.0-or-later
// A glTF of one cube, for tests to modify.
#pragma once

#include "level_files.h"
#include "testing.h"

namespace nook
{

// The cube's JSON and buffer.
struct Cube
{
	nlohmann::json json = cubeGltf();
	std::string buffer = cubeBuffer();

	nlohmann::json& primitive()
	{
		return json["meshes"][0]["primitives"][0];
	}

	// Adds a view of new bytes; returns its index.
	std::size_t view(const std::string& bytes, std::size_t stride = 0)
	{
		json["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", buffer.size()}, {"byteLength", bytes.size()}});
		if (stride > 0)
		{
			json["bufferViews"].back()["byteStride"] = stride;
		}
		buffer += bytes;
		buffer.resize((buffer.size() + 3) / 4 * 4, '\0');
		return json["bufferViews"].size() - 1;
	}

	std::size_t accessor(std::size_t view, int component, std::size_t count, const std::string& type)
	{
		json["accessors"].push_back({{"bufferView", view}, {"componentType", component}, {"count", count}, {"type", type}});
		return json["accessors"].size() - 1;
	}

	LoadedLevel load() const
	{
		const TemporaryFolder folder;
		return loadText(folder / "a.gltf", gltfText(json, buffer));
	}

	std::string refusal() const
	{
		try
		{
			load();
		}
		catch (const Error& error)
		{
			const std::string text = error.what();
			return std::to_string(static_cast<int>(error.code())) + text.substr(text.find("a.gltf") + 6);
		}
		return "none";
	}
};

template <class T> std::string packed(const std::vector<T>& values)
{
	std::string bytes;
	for (const T value : values)
	{
		append(bytes, value);
	}
	return bytes;
}

} // namespace nook
