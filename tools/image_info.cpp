// SPDX-License-Identifier: GPL-3.0-or-later
#include "image_info.h"

#include "core/text.h"
#include "scene/gbuffer_channels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <limits>

namespace nook
{
namespace
{

// What a channel holds, over all pixels.
struct ChannelFacts
{
	double least = std::numeric_limits<double>::infinity(); // of the finite values
	double most = -std::numeric_limits<double>::infinity();
	double sum = 0.0;
	std::size_t finite = 0;
	std::size_t infinite = 0;
	std::size_t nan = 0;
};

ChannelFacts factsOf(const Image& image, int channel)
{
	ChannelFacts facts;
	for (std::size_t i = 0; i < image.values.size() / image.channels.size(); ++i)
	{
		const auto value = static_cast<double>(image.at(i, channel));
		if (!std::isfinite(value))
		{
			(std::isnan(value) ? facts.nan : facts.infinite) += 1;
			continue;
		}
		facts.least = std::min(facts.least, value);
		facts.most = std::max(facts.most, value);
		facts.sum += value;
		facts.finite += 1;
	}
	return facts;
}

std::string percent(std::size_t part, std::size_t whole)
{
	return roundedText(100.0 * static_cast<double>(part) / static_cast<double>(whole), 3) + " %";
}

std::string channelLines(const Image& image, Summary& summary)
{
	std::size_t width = 0;
	for (const std::string& channel : image.channels)
	{
		width = std::max(width, channel.size());
	}
	std::string lines = "channels:\n";
	std::vector<Summary> items;
	const std::size_t pixels = image.values.size() / image.channels.size();
	for (std::size_t c = 0; c < image.channels.size(); ++c)
	{
		const std::string& name = image.channels[c];
		const ChannelFacts facts = factsOf(image, static_cast<int>(c));
		const double mean =
			facts.finite > 0 ? facts.sum / static_cast<double>(facts.finite) : std::numeric_limits<double>::quiet_NaN();
		lines += "  " + oneLine(name) + std::string(width - name.size() + 2, ' ');
		lines += facts.finite > 0
					 ? roundedText(facts.least, 6) + " to " + roundedText(facts.most, 6) + ", mean " + roundedText(mean, 6)
					 : "no finite value";
		lines += facts.infinite > 0 ? ", infinite in " + percent(facts.infinite, pixels) : "";
		lines += facts.nan > 0 ? ", NaN in " + std::to_string(facts.nan) + (facts.nan == 1 ? " pixel" : " pixels") : "";
		lines += "\n";
		Summary& item = items.emplace_back();
		item.text("name", name);
		item.number("least", facts.least);
		item.number("most", facts.most);
		item.number("mean", mean);
		item.whole("infinite", facts.infinite);
		item.whole("nan", facts.nan);
	}
	summary.items("channels", items);
	return lines;
}

// Row by row, as matrices are written on paper.
std::string matrixLines(const Image& image, Summary& summary)
{
	std::string lines;
	std::vector<Summary> items;
	for (const ImageMatrix& matrix : image.matrices)
	{
		lines += oneLine(matrix.key) + " (" + (matrix.wide ? "64" : "32") + " bits):\n";
		for (std::size_t row = 0; row < 4; ++row)
		{
			std::string line;
			for (std::size_t column = 0; column < 4; ++column)
			{
				const double value = matrix.values[4 * column + row] + 0.0; // no -0
				const std::string text = matrix.wide ? roundedText(value, 12) : roundedText(value, 7);
				const std::size_t wide = matrix.wide ? 20 : 14;
				line += std::string(text.size() < wide ? wide - text.size() : 1, ' ') + text;
			}
			lines += line + "\n";
		}
		Summary& item = items.emplace_back();
		item.text("name", matrix.key);
		item.whole("bits", matrix.wide ? 64 : 32);
		item.numbers("values", {matrix.values.begin(), matrix.values.end()});
	}
	summary.items("matrices", items);
	return lines;
}

std::string noteLines(const Image& image, Summary& summary)
{
	std::string lines;
	std::vector<Summary> items;
	for (const Note& note : image.notes)
	{
		// The library's own remarks about how the file was stored say nothing about the picture.
		if (note.value.empty() || note.key.find("oiio:") == 0)
		{
			continue;
		}
		lines += oneLine(note.key) + ": " + oneLine(note.value) + "\n";
		Summary& item = items.emplace_back();
		item.text("name", note.key);
		item.text("value", note.value);
	}
	summary.items("notes", items);
	return lines;
}

} // namespace

bool isImageName(const std::string& path)
{
	constexpr std::array<std::string_view, 9> kEndings{".exr", ".png", ".jpg", ".jpeg", ".tif", ".tiff", ".hdr", ".tga", ".bmp"};
	std::string ending = std::filesystem::path(path).extension().string();
	std::transform(ending.begin(), ending.end(), ending.begin(),
				   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c; });
	return std::find(kEndings.begin(), kEndings.end(), ending) != kEndings.end();
}

std::string describeImage(const Image& image, Summary& summary)
{
	const std::string kind = looksLikeGBuffer(image) ? "G-buffer" : image.channel("visibility") >= 0 ? "visibility" : "image";
	summary.text("kind", kind);
	summary.whole("width", static_cast<std::size_t>(image.width_px));
	summary.whole("height", static_cast<std::size_t>(image.height_px));
	std::string lines = kind + ": " + std::to_string(image.width_px) + " x " + std::to_string(image.height_px) + " pixels" +
						(image.cropped ? ", only a part of the picture, or more" : "") + "\n";
	lines += channelLines(image, summary);
	lines += matrixLines(image, summary);
	lines += noteLines(image, summary);
	return lines;
}

} // namespace nook
