// SPDX-License-Identifier: GPL-3.0-or-later
// Protocol between core/image.cpp and the workers: core/picture_worker.cpp (libpng, libjpeg; OpenEXR in core/picture_exr.cpp) and
// core/image_worker.cpp (OpenImageIO). OpenImageIO brings some 250 libraries, which take thirty times as long to load as the rest
// of nook and may be missing, so its worker starts only for a picture that the other one declines, and is then kept.
#pragma once

#include "core/file.h"
#include "core/image.h"
#include "core/value_stream.h"
#include "core/words.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace nook
{

inline constexpr const char* kImageWorker = "nook_image_worker";
inline constexpr const char* kPictureWorker = "nook_picture_worker";
inline constexpr const char* kEncode =
	"encode"; // an Image, "compression" among its notes → OpenEXR file with 32-bit floats; kPictureWorker only
inline constexpr const char* kDecode = "decode"; // a name and file bytes → Decoded<Image>
// A limit of texels and EncodedAlphas → Decoded<AlphaImage> for each. kImageWorker declines no picture.
inline constexpr const char* kDecodeAlphas = "decode alphas";

inline constexpr std::size_t kMostNames = 10000; // OpenImageIO takes quadratic time in their number

// A picture, or why the worker declines it: the defect of a broken file, or nothing for a kind of file that it does not read.
template <class T> struct Decoded
{
	std::optional<T> image;
	std::string defect;
};

inline void visit(Archive& archive, Note& note)
{
	archive(note.key, note.value);
}
inline void visit(Archive& archive, ImageMatrix& matrix)
{
	archive(matrix.key, matrix.values, matrix.wide);
}
inline void visit(Archive& archive, Image& image)
{
	archive(image.width_px, image.height_px, image.cropped, image.channels, image.halves, image.values, image.notes,
			image.matrices);
}
inline void visit(Archive& archive, EncodedAlpha& mask)
{
	archive(mask.name, mask.path, mask.bytes, mask.channel);
}
inline void visit(Archive& archive, AlphaImage& image)
{
	archive(image.width_px, image.height_px, image.alpha);
}
template <class T> void visit(Archive& archive, Decoded<T>& decoded)
{
	archive(decoded.image, decoded.defect);
}

// Answers kDecode and kDecodeAlphas in a worker that decodes one picture with `decode`.
void answerImage(ValueReader& from, ValueWriter& answer,
				 Decoded<Image> (*decode)(const std::string& bytes, const std::string& name));
void answerAlphas(ValueReader& from, ValueWriter& answer,
				  Decoded<AlphaImage> (*decode)(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels));

// The number of texels. Throws Error (invalid_input) if it is 0, above `most` (set by `option`), or there are too many values.
std::size_t checkedTexels(int width_px, int height_px, int channels, std::size_t most, const std::string& name,
						  const char* option = " (max-texels)");

// A value in 0…1 as 8 bits, rounded as OpenImageIO does.
inline uint8_t byteOf(float value)
{
	return value > 0.0F ? static_cast<uint8_t>(std::min(value * 255.0F + 0.5F, 255.0F)) : uint8_t{0};
}

// OpenEXR's part of kPictureWorker.
void encodeExr(ValueReader& request, ValueWriter& answer);
Decoded<Image> decodeExr(const std::string& bytes, const std::string& name);
Decoded<AlphaImage> alphaOfExr(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels);

// Reads opacity from uncompressed KTX2 files, such as `ktx transcode --target rgba8` makes from Basis Universal.

// True if the bytes begin like a KTX2 file.
bool isKtx2(std::string_view bytes);

// Reads the largest level of a 2D texture with 8 bits per channel. Throws Error: unsupported for compressed texels, naming the
// command that decompresses them; invalid_input if the file is truncated or has more than `max_texels`.
Decoded<AlphaImage> alphaOfKtx2(std::string_view bytes, const EncodedAlpha& picture, std::size_t max_texels);

// Locates the opacity channel of a picture in a texel and reads it.

// Channels [first, first + count) of a texel: one, or three for luminance; none if fully opaque.
struct ChannelPlace
{
	int first = 0;
	int count = 0;
};

struct PictureSize
{
	int width_px = 0;
	int height_px = 0;
	int channels = 0;
	int alpha = -1; // index of the channel of opacity
};

// The opacities of a picture. `read` gets the next row's values of that place, 8 bits each; where it returns false, there is
// nothing. It is not called for an opaque picture. Throws as checkedTexels().
using ReadRow = std::function<bool(ChannelPlace place, std::vector<uint8_t>& values)>;
std::optional<AlphaImage> readAlpha(const PictureSize& size, const EncodedAlpha& picture, std::size_t max_texels,
									const ReadRow& read);

} // namespace nook
