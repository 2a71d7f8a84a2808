// SPDX-License-Identifier: GPL-3.0-or-later
// Embree 3 or 4, with the names of 4.
#pragma once

#if __has_include(<embree4/rtcore.h>)
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
using RTCRayQueryContext = RTCIntersectContext; // Embree 4's names
#define rtcInitRayQueryContext rtcInitIntersectContext
#endif

namespace nook
{

// An Embree device. It selects code by the processor; nook's output does not depend on the choice.

// Release with rtcReleaseDevice(). The environment variable NOOK_TEST_ISA (sse2, sse4.2, avx, avx2, avx512) forces an instruction
// set, so that a test can check that all give the same result. Throws Error: usage for another name, runtime if the processor lacks
// it.
RTCDevice newEmbreeDevice();

} // namespace nook
