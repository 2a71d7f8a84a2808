// SPDX-License-Identifier: GPL-3.0-or-later
// Plans, and lists of levels.
#include "fuzz.h"
#include "mutate_json.h"

#include "farm/plan.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::fuzz::tryTo([&] { nook::readPlan(text, "file"); });
	nook::fuzz::tryTo([&] { nook::readLevelList(text, "file", "."); });
	return 0;
}

NOOK_MUTATED_BY(nook::fuzz::mutatedJsonText)
