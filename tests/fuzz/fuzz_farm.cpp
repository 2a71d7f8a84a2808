// SPDX-License-Identifier: GPL-3.0-or-later
// What a farm hands on: parts of commands, with the sum of their bytes as it should be, plans, and lists of levels.
#include "fuzz.h"
#include "mutate_json.h"

#include "core/content_hash.h"
#include "core/part_file.h"
#include "farm/batch.h"
#include "farm/engines.h"

namespace
{

// A part whose bytes are these.
std::string partOf(const std::string& body)
{
	nook::ContentHash sum;
	sum.add(body);
	return "nook.part/1 " + sum.text() + " " + std::to_string(body.size()) + "\n" + body;
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	const std::string text(reinterpret_cast<const char*>(data), size);
	nook::fuzz::tryTo(
		[&]
		{
			const std::string file = partOf(text);
			const nook::PartFile part = nook::partFrom(file, "file");
			if (nook::partBytes(nook::partFrom(nook::partBytes(part), "written")) != nook::partBytes(part))
			{
				std::abort();
			}
		});
	nook::fuzz::tryTo(
		[&]
		{
			const nook::Plan plan = nook::readPlan(text, "file");
			const std::string written = nook::planJson(plan);
			if (nook::planJson(nook::readPlan(written, "written")) != written || nook::planFiles(plan).empty())
			{
				std::abort();
			}
		});
	nook::fuzz::tryTo([&] { nook::readBatch(text, "file", "."); });
	return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed)
{
	nook::fuzz::Chance chance(seed);
	return nook::fuzz::written(nook::fuzz::mutatedJsonText(std::string(reinterpret_cast<const char*>(data), size), most, chance),
							   data, most);
}
