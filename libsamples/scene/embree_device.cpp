// SPDX-License-Identifier: GPL-3.0-or-later
#include "scene/embree_device.h"

#include "core/error.h"

#include <cstdlib>
#include <string>

namespace nook
{

RTCDevice newEmbreeDevice()
{
	const char* const isa = std::getenv("NOOK_TEST_ISA");
	const std::string config = isa == nullptr ? "" : std::string("isa=") + isa;
	RTCDevice device = rtcNewDevice(config.c_str());
	if (device == nullptr)
	{
		throw Error(ExitCode::runtime, isa == nullptr ? "Embree: found no device, expected a processor with SSE2"
													  : "NOOK_TEST_ISA: found '" + std::string(isa) + "', expected instructions that Embree and this processor have");
	}
	return device;
}

} // namespace nook
