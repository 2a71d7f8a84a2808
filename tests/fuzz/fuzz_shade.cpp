// SPDX-License-Identifier: GPL-3.0-or-later
// Shading on the CPU: arbitrary G-buffers and settings, with every method, filter and view.
#include "fuzz.h"

#include "../hostile_views.h"

namespace
{

struct ByteSource
{
	nook::fuzz::Bytes bytes;

	std::uint32_t below(std::size_t n)
	{
		return bytes.number<std::uint8_t>() % static_cast<std::uint32_t>(n);
	}
	float number()
	{
		return bytes.number<float>();
	}
};

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	ByteSource source{nook::fuzz::Bytes(data, size)};
	const nook::test::HostileView view = nook::test::hostileView(source);
	nook::fuzz::tryTo(
		[&]
		{
			for (const float value : nook::shadeOnCpu(view.gbuffer, view.samples, view.settings, {1, {}}).visibility)
			{
				if (!(value >= 0.0F && value <= 1.0F))
				{
					std::abort();
				}
			}
		});
	return 0;
}
