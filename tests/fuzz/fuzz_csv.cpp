// SPDX-License-Identifier: GPL-3.0-or-later
// Patterns as CSV, of any domain.
#include "fuzz.h"

#include "format/tile_json.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string path = nook::fuzz::fileOf(data, size, ".csv");
	for (const nook::Domain domain : {nook::Domain::disk, nook::Domain::ball, nook::Domain::hemisphere})
	{
		nook::fuzz::tryTo([&] { nook::readInput(path, domain); });
	}
	return 0;
}
