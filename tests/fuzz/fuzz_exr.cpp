// SPDX-License-Identifier: GPL-3.0-or-later
// OpenEXR files as G-buffers: whatever OpenImageIO and OpenEXR decode in their worker becomes a G-buffer or a one-line error. Their
// code has no coverage here, so the mutator knows their headers instead; the checks of decoded pictures have their own target
// (fuzz_gbuffer.cpp).
#include "fuzz.h"
#include "mutate_exr.h"

#include "scene/gbuffer.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string path = nook::fuzz::fileOf(data, size, ".exr");
	nook::fuzz::tryTo(
		[&]
		{
			const nook::GBuffer gbuffer = nook::readGBuffer(path, {});
			if (gbuffer.depth.size() != gbuffer.normals.size())
			{
				std::abort();
			}
		});
	return 0;
}

NOOK_MUTATED_BY(nook::fuzz::mutatedExr)
