// SPDX-License-Identifier: GPL-3.0-or-later
// Worker of core/image_codec.h, and the only file that uses OpenImageIO.
#include "core/image_codec.h"

#include "core/error.h"
#include "core/isolate.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

namespace nook
{
namespace
{

[[noreturn]] void refuse(const std::string& name, const std::string& reason)
{
	std::string line = reason;
	std::replace(line.begin(), line.end(), '\n', ' ');
	throw Error(ExitCode::invalid_input,
				name + ": found " + (line.empty() ? "no image" : line) + ", expected an image that can be read");
}

void takeAttributes(Image& image, const OIIO::ImageSpec& spec)
{
	for (const OIIO::ParamValue& attribute : spec.extra_attribs)
	{
		const OIIO::TypeDesc type = attribute.type();
		if (type == OIIO::TypeDesc::STRING)
		{
			image.notes.push_back({attribute.name().string(), attribute.get_string()});
		}
		else if (type.aggregate == OIIO::TypeDesc::MATRIX44 && type.arraylen == 0)
		{
			ImageMatrix matrix{attribute.name().string(), {}, type.basetype == OIIO::TypeDesc::DOUBLE};
			for (std::size_t i = 0; i < 16; ++i)
			{
				matrix.values[i] = matrix.wide ? static_cast<const double*>(attribute.data())[i]
											   : static_cast<double>(static_cast<const float*>(attribute.data())[i]);
			}
			image.matrices.push_back(matrix);
		}
	}
}

void checkFlat(const OIIO::ImageSpec& spec, const std::string& name)
{
	if (spec.deep || spec.depth > 1)
	{
		refuse(name, spec.deep ? "a deep image" : "a volume");
	}
}

Image taken(OIIO::ImageInput& input, const std::string& name)
{
	const OIIO::ImageSpec& spec = input.spec();
	checkFlat(spec, name);
	const std::size_t texels = checkedTexels(spec.width, spec.height, spec.nchannels, kMaxTexels, name, "");
	Image image;
	image.width_px = spec.width;
	image.height_px = spec.height;
	image.channels = spec.channelnames;
	image.cropped =
		spec.x != spec.full_x || spec.y != spec.full_y || spec.width != spec.full_width || spec.height != spec.full_height;
	for (int channel = 0; channel < spec.nchannels; ++channel)
	{
		image.halves.push_back(spec.channelformat(channel) == OIIO::TypeDesc::HALF ? 1 : 0);
	}
	image.values.resize(texels * static_cast<std::size_t>(spec.nchannels));
	takeAttributes(image, spec);
	if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
	{
		refuse(name, input.geterror());
	}
	return image;
}

// Opens bytes as a picture. The name's extension picks the format tried first, then the content.
void withDecoder(std::string_view bytes, const std::string& name, const std::function<void(OIIO::ImageInput&)>& use)
{
	OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size()); // NOLINT: it is only read
	OIIO::ImageSpec config;
	config.attribute("oiio:UnassociatedAlpha", 1);
	// OpenImageIO 2.4 ignores open()'s own proxy argument if there is a configuration.
	OIIO::Filesystem::IOProxy* proxy = &memory;
	config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
	for (const std::string& as : {name, std::string("image.png"), std::string("image.jpg")})
	{
		memory.seek(0);
		const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(as, &config, &memory);
		if (input != nullptr)
		{
			input->threads(1); // otherwise the pool would be used
			use(*input);
			return;
		}
		OIIO::geterror();
	}
	refuse(name, "an unknown format");
}

Decoded<Image> decodedImage(const std::string& bytes, const std::string& name)
{
	Decoded<Image> answer;
	withDecoder(bytes, name, [&](OIIO::ImageInput& input) { answer.image = taken(input, name); });
	return answer;
}

std::optional<AlphaImage> alphaOf(OIIO::ImageInput& input, const EncodedAlpha& picture, std::size_t max_texels)
{
	const OIIO::ImageSpec& spec = input.spec();
	checkFlat(spec, picture.name);
	std::vector<uint8_t> all;
	auto next = all.begin();
	const auto readRow = [&](ChannelPlace place, std::vector<uint8_t>& values)
	{
		if (all.empty())
		{
			all.assign(values.size() * static_cast<std::size_t>(spec.height), 255); // GIF leaves opacity as it is
			next = all.begin();
			if (!input.read_image(0, 0, place.first, place.first + place.count, OIIO::TypeDesc::UINT8, all.data()))
			{
				refuse(picture.name, input.geterror());
			}
		}
		std::copy_n(next, values.size(), values.begin());
		next += static_cast<std::ptrdiff_t>(values.size());
		return true;
	};
	return readAlpha({spec.width, spec.height, spec.nchannels, spec.alpha_channel}, picture, max_texels, readRow);
}

Decoded<AlphaImage> decodedAlpha(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels)
{
	Decoded<AlphaImage> answer;
	withDecoder(bytes, picture.name, [&](OIIO::ImageInput& input) { answer.image = alphaOf(input, picture, max_texels); });
	return answer;
}

} // namespace
} // namespace nook

int main(int argc, char** argv)
{
	using namespace nook;
	static constexpr WorkerFunction kFunctions[]{{kDecode,
												  [](ValueReader& from, ValueWriter& answer)
												  {
													  answerImage(from, answer, decodedImage);
												  }},
												 {kDecodeAlphas, [](ValueReader& from, ValueWriter& answer)
												  {
													  answerAlphas(from, answer, decodedAlpha);
												  }}};
	// Pictures are decoded one at a time, and a thread pool would count against the memory limit. OpenImageIO starts its own pool
	// at the first call, whatever the settings.
	const auto keepToOneThread = []
	{
		OIIO::attribute("threads", 1);
		OIIO::attribute("exr_threads", -1);
	};
	return serveRequests(argc, argv, kFunctions, keepToOneThread);
}
