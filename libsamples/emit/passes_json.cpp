// SPDX-License-Identifier: GPL-3.0-or-later
// The passes, pictures and uniform block of one picture as JSON, for programs that draw emitted modules.
#include "core/base64.h"
#include "core/json_text.h"
#include "core/lists.h"
#include "emit/module.h"
#include "methods/block.h"
#include "methods/method_table.h"
#include "methods/passes.h"

#include <nlohmann/json.hpp>

#include <cstring>

namespace nook
{
namespace
{

using PassesJson = nlohmann::ordered_json;

constexpr std::array kPictureFormats{"scalar", "quad", "counts"};
constexpr std::array kSlotNames{"nook_cells", "nook_packed", "nook_levels", "nook_tables", "nook_range"};

std::string base64OfBytes(const void* values, std::size_t size)
{
	std::vector<uint8_t> bytes(size);
	std::memcpy(bytes.data(), values, size);
	return base64Of(bytes);
}

// Column = variant, row = sample, as modules read their tiles.
PassesJson tileJson(const ShadeSamples& samples)
{
	const auto count = static_cast<std::size_t>(samples.count);
	const std::size_t variants = samples.samples.size() / count;
	const std::vector<glm::vec4> texels =
		listOf(samples.samples.size(), [&](std::size_t i) { return samples.samples[i % variants * count + i / variants]; });
	return {{"width", variants}, {"height", count}, {"texels", base64OfBytes(texels.data(), texels.size() * sizeof(glm::vec4))}};
}

PassesJson passJson(const ShadePass& pass)
{
	PassesJson reads = PassesJson::array();
	for (const ShadeRead& read : pass.reads)
	{
		reads.push_back({kSlotNames[static_cast<std::size_t>(read.slot)], read.picture});
	}
	const glm::ivec4 numbers = modulePassOf(pass.block, pass.kernel.call);
	return {{"name", pass.kernel.name},
			{"call", moduleCallOf(pass)},
			{"picture", pass.picture},
			{"level", pass.level},
			{"layer", pass.layer},
			{"reads", std::move(reads)},
			{"numbers", {numbers.x, numbers.y, numbers.z, numbers.w}}};
}

} // namespace

std::string passesJson(const ShadeFrame& frame, const ShadeSamples& samples, const ShadeSettings& settings,
					   std::string_view version)
{
	const ShadePlan plan = planOf(frame, samples, settings, false);
	PassesJson members = PassesJson::object();
	std::size_t end = 0;
	for (const BlockMember& member : blockMembers())
	{
		members[member.name] = member.offset;
		end = placeOf(member, end).end;
	}
	std::vector<uint8_t> bytes((end + 15) / 16 * 16);
	const ShadeBlock block = blockOf(frame, samples, settings);
	std::memcpy(bytes.data(), &block, end);
	PassesJson pictures = PassesJson::array();
	for (const PictureShape& shape : plan.pictures)
	{
		pictures.push_back({{"format", kPictureFormats[static_cast<std::size_t>(shape.format)]},
							{"width", shape.width},
							{"height", shape.height},
							{"levels", shape.levels},
							{"layers", shape.layers}});
	}
	PassesJson passes = PassesJson::array();
	for (const ShadePass& pass : plan.passes)
	{
		passes.push_back(passJson(pass));
	}
	PassesJson json{{"schema", "nook.passes/1"}, {"version", version}, {"members", std::move(members)}, {"block", base64Of(bytes)}};
	if (rowOf(settings.method).domain)
	{
		json["tile"] = tileJson(samples);
	}
	json["pictures"] = std::move(pictures);
	json["passes"] = std::move(passes);
	return jsonLine(json) + "\n";
}

} // namespace nook
