// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/image.h"

#include "core/error.h"
#include "core/file.h"
#include "core/isolate.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>
#include <OpenImageIO/strutil.h>

#include <algorithm>
#include <cassert>
#include <functional>

namespace nook
{
namespace
{

// OpenImageIO runs in child processes only, never here: its pool of threads starts with its first call, whatever it is told, and a
// child that is forked while one of them holds a lock waits for it for ever.
void keepToOneThread()
{
	static const bool done = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
	assert(done);
	static_cast<void>(done);
}

constexpr std::size_t kTables = std::size_t{256} << 20U; // what a picture may take beside what its size calls for
constexpr int kTime_s = 300;

[[noreturn]] void fail(const std::string& reason)
{
	throw Error(ExitCode::runtime, "image: " + reason);
}

std::string encoded(const char* ending, OIIO::ImageSpec spec, const void* pixels, const Notes& notes)
{
	for (const Note& note : notes)
	{
		spec.attribute(note.key, note.value);
	}
	const auto work = [&](IsolatedWriter& to)
	{
		keepToOneThread();
		std::vector<unsigned char> bytes;
		OIIO::Filesystem::IOVecOutput memory(bytes);
		const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create(ending, &memory);
		if (output == nullptr)
		{
			fail("found no writer for " + std::string(ending) + " files: " + OIIO::geterror());
		}
		if (!output->open(ending, spec) || !output->write_image(spec.format, pixels) || !output->close())
		{
			fail(output->geterror());
		}
		to.values(bytes);
	};
	std::string bytes;
	const std::size_t most = kTables + 4 * static_cast<std::size_t>(spec.image_bytes());
	isolate("image", {most, kTime_s}, work,
			[&](IsolatedReader& from)
			{
				std::vector<char> values;
				from.values(values, most);
				bytes.assign(values.begin(), values.end());
			});
	return bytes;
}

[[maybe_unused]] std::size_t valuesOf(int width_px, int height_px, int channels)
{
	return static_cast<std::size_t>(width_px) * static_cast<std::size_t>(height_px) * static_cast<std::size_t>(channels);
}

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

// Refuses what is no picture, and one of more values than are taken.
void checkSize(const OIIO::ImageSpec& spec, int channels, const std::string& name)
{
	if (spec.deep || spec.depth > 1)
	{
		refuse(name, spec.deep ? "a deep image" : "a volume");
	}
	if (spec.width < 1 || spec.height < 1 || spec.nchannels < 1 ||
		spec.image_pixels() > kMaxImageValues / static_cast<std::size_t>(std::max(channels, 1)))
	{
		refuse(name, std::to_string(spec.width) + "x" + std::to_string(spec.height) + " pixels of " +
						 std::to_string(spec.nchannels) + " channels");
	}
}

Image taken(OIIO::ImageInput& input, const std::string& name)
{
	const OIIO::ImageSpec& spec = input.spec();
	checkSize(spec, spec.nchannels, name);
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
	image.values.resize(valuesOf(spec.width, spec.height, spec.nchannels));
	takeAttributes(image, spec);
	if (!input.read_image(0, 0, 0, spec.nchannels, OIIO::TypeDesc::FLOAT, image.values.data()))
	{
		refuse(name, input.geterror());
	}
	return image;
}

// Opens bytes as a picture. The name's ending chooses the format; the content decides where that fails.
void withDecoder(std::string_view bytes, const std::string& name, const std::function<void(OIIO::ImageInput&)>& use)
{
	keepToOneThread();
	OIIO::Filesystem::IOMemReader memory(const_cast<char*>(bytes.data()), bytes.size()); // NOLINT: it is only read
	OIIO::ImageSpec config;
	config.attribute("oiio:UnassociatedAlpha", 1);
	// OpenImageIO 2.4 forgets open()'s own argument for memory where there is a configuration.
	OIIO::Filesystem::IOProxy* proxy = &memory;
	config.attribute("oiio:ioproxy", OIIO::TypeDesc::PTR, static_cast<void*>(&proxy));
	for (const std::string& as : {name, std::string("image.png"), std::string("image.jpg")})
	{
		memory.seek(0);
		const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(as, &config, &memory);
		if (input != nullptr)
		{
			input->threads(1); // the pool would be asked otherwise
			use(*input);
			return;
		}
		OIIO::geterror();
	}
	refuse(name, "no format that is known");
}

constexpr std::size_t kMostReadingMemory = std::size_t{6} << 30U; // kMaxImageValues as floats, three times over
constexpr std::size_t kMostNames = 100000;

void send(const Image& image, IsolatedWriter& to)
{
	to.value(image.width_px);
	to.value(image.height_px);
	to.value(image.cropped);
	to.value(image.channels.size());
	for (const std::string& channel : image.channels)
	{
		to.text(channel);
	}
	to.values(image.halves);
	to.values(image.values);
	to.value(image.notes.size());
	for (const Note& note : image.notes)
	{
		to.text(note.key);
		to.text(note.value);
	}
	to.value(image.matrices.size());
	for (const ImageMatrix& matrix : image.matrices)
	{
		to.text(matrix.key);
		to.value(matrix.values);
		to.value(matrix.wide);
	}
}

Image received(IsolatedReader& from)
{
	const auto count = [&from]
	{
		const auto number = from.value<std::size_t>();
		if (number > kMostNames)
		{
			throw IsolatedReader::Ended{};
		}
		return number;
	};
	Image image;
	image.width_px = from.value<int>();
	image.height_px = from.value<int>();
	image.cropped = from.value<bool>();
	image.channels.resize(count());
	for (std::string& channel : image.channels)
	{
		channel = from.text();
	}
	from.values(image.halves, kMostNames);
	from.values(image.values, kMaxImageValues);
	image.notes.resize(count());
	for (Note& note : image.notes)
	{
		note.key = from.text();
		note.value = from.text();
	}
	image.matrices.resize(count());
	for (ImageMatrix& matrix : image.matrices)
	{
		matrix.key = from.text();
		matrix.values = from.value<std::array<double, 16>>();
		matrix.wide = from.value<bool>();
	}
	return image;
}

} // namespace

int Image::channel(std::string_view name) const
{
	const auto found = std::find(channels.begin(), channels.end(), name);
	return found == channels.end() ? -1 : static_cast<int>(found - channels.begin());
}

const ImageMatrix* Image::matrix(std::string_view key) const
{
	// Versions of the library differ in how they spell worldToCamera.
	const auto found = std::find_if(matrices.begin(), matrices.end(),
									[key](const ImageMatrix& m) {
										return OIIO::Strutil::iequals(m.key, {key.data(), key.size()});
									});
	return found == matrices.end() ? nullptr : &*found;
}

Image decodeImage(std::string_view bytes, const std::string& name)
{
	Image image;
	// Deflate makes at most 1032 bytes of one, and a byte becomes a float of four.
	const IsolationLimits limits{std::min(kTables + 4200 * bytes.size(), kMostReadingMemory), kTime_s};
	const auto work = [&](IsolatedWriter& to)
	{
		withDecoder(bytes, name, [&](OIIO::ImageInput& input) { send(taken(input, name), to); });
	};
	isolate(name, limits, work, [&](IsolatedReader& from) { image = received(from); });
	return image;
}

AlphaImage decodeAlpha(std::string_view bytes, const std::string& name, bool else_first)
{
	AlphaImage image;
	withDecoder(bytes, name,
				[&](OIIO::ImageInput& input)
				{
					const OIIO::ImageSpec& spec = input.spec();
					checkSize(spec, 1, name);
					image.width_px = spec.width;
					image.height_px = spec.height;
					image.alpha.resize(valuesOf(spec.width, spec.height, 1), 255);
					const int channel = spec.alpha_channel >= 0 ? spec.alpha_channel : else_first ? 0 : -1;
					if (channel >= 0 && !input.read_image(0, 0, channel, channel + 1, OIIO::TypeDesc::UINT8, image.alpha.data()))
					{
						refuse(name, input.geterror());
					}
				});
	return image;
}

Image readImage(const std::string& path)
{
	return decodeImage(readFile(path), path); // the system's reason where it cannot be opened
}

std::string exrBytes(const Image& image)
{
	assert(image.values.size() == valuesOf(image.width_px, image.height_px, static_cast<int>(image.channels.size())));
	OIIO::ImageSpec spec(image.width_px, image.height_px, static_cast<int>(image.channels.size()), OIIO::TypeDesc::FLOAT);
	spec.channelnames = image.channels;
	spec.z_channel = image.channel("Z");
	spec.attribute("compression", "zip");
	spec.attribute("oiio:ColorSpace", "Linear");
	spec.attribute("DateTime", ""); // else the library writes the time of day
	for (const ImageMatrix& matrix : image.matrices)
	{
		if (matrix.wide)
		{
			spec.attribute(matrix.key, OIIO::TypeDesc(OIIO::TypeDesc::DOUBLE, OIIO::TypeDesc::MATRIX44), matrix.values.data());
			continue;
		}
		std::array<float, 16> narrow{};
		std::transform(matrix.values.begin(), matrix.values.end(), narrow.begin(), [](double v) { return static_cast<float>(v); });
		spec.attribute(matrix.key, OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, OIIO::TypeDesc::MATRIX44), narrow.data());
	}
	return encoded("nook.exr", std::move(spec), image.values.data(), image.notes);
}

std::string pngBytes(int width_px, int height_px, std::span<const uint8_t> rgb, const Notes& notes)
{
	assert(rgb.size() == valuesOf(width_px, height_px, 3));
	OIIO::ImageSpec spec(width_px, height_px, 3, OIIO::TypeDesc::UINT8);
	spec.attribute("oiio:ColorSpace", "sRGB");
	return encoded("nook.png", std::move(spec), rgb.data(), notes);
}

std::string alphaPngBytes(int width_px, int height_px, std::span<const uint8_t> alpha)
{
	assert(alpha.size() == valuesOf(width_px, height_px, 1));
	std::vector<uint8_t> rgba(4 * alpha.size(), 255);
	for (std::size_t i = 0; i < alpha.size(); ++i)
	{
		rgba[4 * i + 3] = alpha[i];
	}
	OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::UINT8);
	spec.attribute("oiio:ColorSpace", "sRGB");
	spec.attribute("oiio:UnassociatedAlpha", 1);
	return encoded("nook.png", std::move(spec), rgba.data(), {});
}

std::string pngBytes(int width_px, int height_px, std::span<const uint16_t> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::UINT16);
	spec.attribute("oiio:ColorSpace", "Linear");
	spec.attribute("oiio:UnassociatedAlpha", 1);
	return encoded("nook.png", std::move(spec), rgba.data(), notes);
}

std::string exrBytes(int width_px, int height_px, std::span<const float> rgba, const Notes& notes)
{
	assert(rgba.size() == valuesOf(width_px, height_px, 4));
	OIIO::ImageSpec spec(width_px, height_px, 4, OIIO::TypeDesc::FLOAT);
	spec.attribute("compression", "none");
	spec.attribute("oiio:ColorSpace", "Linear");
	spec.attribute("DateTime", ""); // else the library writes the time of day
	return encoded("nook.exr", std::move(spec), rgba.data(), notes);
}

} // namespace nook
