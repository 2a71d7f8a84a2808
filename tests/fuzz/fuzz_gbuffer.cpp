// SPDX-License-Identifier: GPL-3.0-or-later
// G-buffers: the checks of an OpenEXR file's channels, matrices and values after decoding (which a worker does).
#include "fuzz.h"

#include "scene/gbuffer.h"

#include <array>
#include <cmath>
#include <limits>

namespace
{

using nook::fuzz::Bytes;

// Often a special value, otherwise any bits.
float hardFloat(Bytes& bytes)
{
	constexpr std::array<float, 11> kSome{0.0F,
										  -0.0F,
										  1.0F,
										  -1.0F,
										  0.5F,
										  1e-38F,
										  1e38F,
										  1e-45F,
										  1e10F,
										  std::numeric_limits<float>::infinity(),
										  std::numeric_limits<float>::quiet_NaN()};
	const auto which = bytes.number<std::uint8_t>() % 16U;
	return which < kSome.size() ? kSome[which] : bytes.number<float>();
}

nook::Image imageOf(Bytes& bytes)
{
	static const std::array<const char*, 10> kNames{"Z",           "N.X",      "N.Y",    "N.Z", "depth",
													"depth_error", "normal.x", "View.Z", "R",   "A"};
	static const std::array<const char*, 5> kMatrices{"projection", "projection64", "worldToCamera", "worldToCamera64",
													  "worldToNDC"};
	nook::Image image;
	image.width_px = 1 + bytes.number<std::uint8_t>() % 6;
	image.height_px = 1 + bytes.number<std::uint8_t>() % 6;
	const int channels = 1 + bytes.number<std::uint8_t>() % 8;
	for (int i = 0; i < channels; ++i)
	{
		const auto which = bytes.number<std::uint8_t>() % (kNames.size() + 1);
		image.channels.push_back(which < kNames.size() ? kNames[which] : bytes.text(12));
		image.halves.push_back(bytes.number<std::uint8_t>() % 2);
	}
	const int matrices = bytes.number<std::uint8_t>() % 6;
	for (int i = 0; i < matrices; ++i)
	{
		nook::ImageMatrix matrix{
			kMatrices[bytes.number<std::uint8_t>() % kMatrices.size()], {}, bytes.number<std::uint8_t>() % 2 == 0};
		const bool identity = bytes.number<std::uint8_t>() % 4 != 0;
		for (std::size_t k = 0; k < 16; ++k)
		{
			matrix.values[k] = identity ? (k % 5 == 0 ? 1.0 : 0.0) : static_cast<double>(hardFloat(bytes));
		}
		if (identity && bytes.number<std::uint8_t>() % 2 == 0)
		{
			matrix.values[10] = -1.0;
			matrix.values[11] = -1.0;
			matrix.values[14] = static_cast<double>(hardFloat(bytes));
			matrix.values[15] = 0.0;
		}
		image.matrices.push_back(matrix);
	}
	const auto values =
		static_cast<std::size_t>(image.width_px) * static_cast<std::size_t>(image.height_px) * image.channels.size();
	for (std::size_t i = 0; i < values; ++i)
	{
		image.values.push_back(hardFloat(bytes));
	}
	return image;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	Bytes bytes(data, size);
	nook::GBufferImport import;
	import.depth = static_cast<nook::DepthKind>(bytes.number<std::uint8_t>() % 3);
	import.clip = static_cast<nook::ClipRange>(bytes.number<std::uint8_t>() % 2);
	import.normals_from_depth = bytes.number<std::uint8_t>() % 2 == 0;
	import.normal_space = static_cast<nook::NormalSpace>(bytes.number<std::uint8_t>() % 2);
	import.normal_range = static_cast<nook::NormalRange>(bytes.number<std::uint8_t>() % 2);
	if (bytes.number<std::uint8_t>() % 4 == 0)
	{
		import.viewport = {bytes.number<std::int8_t>(), bytes.number<std::int8_t>(), bytes.number<std::int8_t>(),
						   bytes.number<std::int32_t>()};
	}
	const nook::Image image = imageOf(bytes);
	nook::fuzz::tryTo(
		[&]
		{
			const nook::GBuffer gbuffer = nook::gbufferFrom(image, "file", import);
			for (std::size_t i = 0; i < gbuffer.depth.size(); ++i)
			{
				const bool sky = std::isinf(gbuffer.depth[i]);
				const glm::vec3& n = gbuffer.normals[i];
				if (!(gbuffer.depth[i] > 0.0F) || (!sky && !std::isfinite(n.x + n.y + n.z)))
				{
					std::abort();
				}
			}
		});
	return 0;
}
