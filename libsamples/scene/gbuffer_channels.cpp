// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/gbuffer_channels.h"

#include "core/error.h"
#include "scene/gbuffer.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>

namespace nook
{
namespace
{

std::string lower(std::string_view text)
{
	std::string result(text);
	std::transform(result.begin(), result.end(), result.begin(),
				   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
	return result;
}

// "ViewLayer.Depth.Z": layer "ViewLayer.Depth", last part "z"; the layer's own last part is "depth". Both in lower case.
struct Name
{
	std::string layer; // as written
	std::string last;
	std::string before;
};

Name partsOf(const std::string& channel)
{
	const std::size_t dot = channel.rfind('.');
	if (dot == std::string::npos)
	{
		return {"", lower(channel), ""};
	}
	const std::string layer = channel.substr(0, dot);
	const std::size_t earlier = layer.rfind('.');
	return {layer, lower(std::string_view(channel).substr(dot + 1)),
			lower(earlier == std::string::npos ? layer : layer.substr(earlier + 1))};
}

std::string listed(const Image& image)
{
	std::string names;
	for (const std::string& channel : image.channels)
	{
		names += (names.empty() ? "" : ", ") + channel;
	}
	return names;
}

[[noreturn]] void refuse(const Image& image, const std::string& path, const std::string& expected)
{
	throw Error(ExitCode::invalid_input, path + ": channels: found " + listed(image) + ", expected " + expected);
}

int indexIn(const Image& image, const std::string& layer, std::string_view last)
{
	for (std::size_t i = 0; i < image.channels.size(); ++i)
	{
		const Name name = partsOf(image.channels[i]);
		if (name.layer == layer && name.last == last)
		{
			return static_cast<int>(i);
		}
	}
	return -1;
}

std::optional<NormalChannels> vectorOf(const Image& image, const std::string& layer)
{
	for (const std::array<std::string_view, 3>& axes : {std::array<std::string_view, 3>{"x", "y", "z"}, {"r", "g", "b"}})
	{
		const NormalChannels found{layer, indexIn(image, layer, axes[0]), indexIn(image, layer, axes[1]),
								   indexIn(image, layer, axes[2])};
		if (found.x >= 0 && found.y >= 0 && found.z >= 0)
		{
			return found;
		}
	}
	return std::nullopt;
}

// 1: depth by name; 2: a Z that is not part of a vector; 0: anything else.
int depthRank(const Image& image, const std::string& channel)
{
	const Name name = partsOf(channel);
	const bool scalar = name.last == "z" || name.last == "v" || name.last == "y" || name.last == "r";
	if (name.last == "depth" || (name.before == "depth" && scalar))
	{
		return 1;
	}
	return name.last == "z" && !vectorOf(image, name.layer) ? 2 : 0;
}

// The index of the only channel with that rank; −1: none, −2: several.
int onlyOfRank(const Image& image, int rank)
{
	int found = -1;
	for (std::size_t i = 0; i < image.channels.size(); ++i)
	{
		if (depthRank(image, image.channels[i]) == rank)
		{
			found = found == -1 ? static_cast<int>(i) : -2;
		}
	}
	return found;
}

// −1: none, −2: several.
int depthByName(const Image& image)
{
	if (const int index = image.channel("Z"); index >= 0)
	{
		return index;
	}
	if (const int index = onlyOfRank(image, 1); index != -1)
	{
		return index;
	}
	return onlyOfRank(image, 2);
}

// Every layer that may hold normals, without duplicates.
std::vector<NormalChannels> normalLayers(const Image& image)
{
	std::vector<NormalChannels> layers;
	for (const std::string& channel : image.channels)
	{
		const Name name = partsOf(channel);
		const bool called = name.before == "n" || name.before == "normal" || name.before == "normals";
		const bool first = name.last == "x" || name.last == "r";
		if (called && first)
		{
			if (const std::optional<NormalChannels> found = vectorOf(image, name.layer))
			{
				layers.push_back(*found);
			}
		}
	}
	return layers;
}

} // namespace

int depthChannel(const Image& image, const std::string& path, const std::string& wanted)
{
	if (!wanted.empty())
	{
		const int index = image.channel(wanted);
		if (index < 0)
		{
			refuse(image, path, wanted + " among them");
		}
		return index;
	}
	const int index = depthByName(image);
	if (index >= 0)
	{
		return index;
	}
	if (index == -1 && image.channels.size() == 1)
	{
		return 0;
	}
	refuse(image, path,
		   std::string(index == -2 ? "one alone" : "one") + " that is depth by its name, such as Z (depth-channel picks one)");
}

NormalChannels normalChannels(const Image& image, const std::string& path, const std::string& wanted)
{
	if (!wanted.empty())
	{
		const std::optional<NormalChannels> found = vectorOf(image, wanted);
		if (!found)
		{
			refuse(image, path, wanted + ".X, " + wanted + ".Y and " + wanted + ".Z among them");
		}
		return *found;
	}
	if (const std::optional<NormalChannels> found = vectorOf(image, "N"))
	{
		return *found;
	}
	const std::vector<NormalChannels> layers = normalLayers(image);
	if (layers.size() != 1)
	{
		refuse(image, path,
			   layers.empty() ? "normals N.X, N.Y, N.Z (normal-channels names others), or from depth (normals from-depth)"
							  : "one layer of normals alone (normal-channels picks one)");
	}
	return layers.front();
}

bool looksLikeGBuffer(const Image& image)
{
	return depthByName(image) >= 0;
}

} // namespace nook
