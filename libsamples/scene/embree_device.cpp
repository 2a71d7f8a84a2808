// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/tracer_tree.h"

#include "core/error.h"
#include "core/text.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <string>
#include <string_view>

namespace nook
{

RTCDevice newEmbreeDevice()
{
	const char* const isa = std::getenv("NOOK_TEST_ISA");
	if (isa == nullptr)
	{
		RTCDevice device = rtcNewDevice("");
		if (device == nullptr)
		{
			throw Error(ExitCode::runtime, "Embree: found no device, expected a processor with SSE2");
		}
		return device;
	}
	// Embree itself ignores unknown names.
	constexpr std::array<std::string_view, 5> kSets{"sse2", "sse4.2", "avx", "avx2", "avx512"};
	const std::string what = "NOOK_TEST_ISA: found '" + oneLine(isa) + "', expected ";
	if (std::find(kSets.begin(), kSets.end(), isa) == kSets.end())
	{
		throw Error(ExitCode::usage, what + "sse2, sse4.2, avx, avx2 or avx512");
	}
	RTCDevice device = rtcNewDevice((std::string("isa=") + isa).c_str());
	if (device == nullptr)
	{
		throw Error(ExitCode::runtime, what + "instructions that Embree and this processor have");
	}
	return device;
}

} // namespace nook
