// SPDX-License-Identifier: GPL-3.0-or-later
// A device of Embree. It chooses code by the processor; no byte of what nook makes depends on which.
#pragma once

#include <embree3/rtcore.h>

namespace nook
{

// For rtcReleaseDevice(). The environment variable NOOK_TEST_ISA (sse2, sse4.2, avx, avx2, avx512) takes the code of those
// instructions, so that a test can hold that they all come to the same. Throws Error: usage for another name, runtime where there
// is no such processor.
RTCDevice newEmbreeDevice();

} // namespace nook
