// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/part_file.h"

#include "core/byte_text.h"
#include "core/content_hash.h"
#include "core/error.h"

#include <algorithm>
#include <cstddef>
#include <span>

namespace nook
{
namespace
{

constexpr std::string_view kMagic = "nook.part/1 ";

// Its first line: what it is, a sum over all that follows, and how many bytes those are.
std::string firstLine(std::string_view body)
{
	ContentHash sum;
	sum.add(body);
	return std::string(kMagic) + sum.text() + " " + std::to_string(body.size()) + "\n";
}

std::string bodyOf(const PartFile& part)
{
	ByteWriter out;
	out.text(part.version);
	out.whole(part.command.size());
	for (const std::string& word : part.command)
	{
		out.text(word);
	}
	out.small(static_cast<uint32_t>(part.part.number));
	out.small(static_cast<uint32_t>(part.part.of));
	out.whole(part.inputs.size());
	for (const PartInput& input : part.inputs)
	{
		out.text(input.path);
		out.text(input.hash);
	}
	out.whole(part.stages.size());
	for (const auto& [name, units] : part.stages)
	{
		out.text(name);
		out.whole(units.size());
		for (const auto& [index, result] : units)
		{
			out.whole(index);
			out.text(result);
		}
	}
	return out.take();
}

void readStages(ByteReader& in, PartFile& part)
{
	const std::size_t stages = in.count(16);
	for (std::size_t i = 0; i < stages && in.isWell(); ++i)
	{
		UnitResults& units = part.stages[in.text()];
		const std::size_t count = in.count(16);
		for (std::size_t k = 0; k < count && in.isWell(); ++k)
		{
			const uint64_t index = in.whole();
			units[index] = in.text();
		}
	}
}

std::string placeOf(const PartFile& part)
{
	return "part " + std::to_string(part.part.number) + "/" + std::to_string(part.part.of);
}

[[noreturn]] void refuse(const PartFile& part, const std::string& what)
{
	throw Error(ExitCode::invalid_input, part.path + ": " + what);
}

std::string commandText(const PartFile& part)
{
	std::string text = "nook";
	for (const std::string& word : part.command)
	{
		text += " " + word;
	}
	return text;
}

void checkInputs(const PartFile& part, const PartFile& first)
{
	if (part.inputs == first.inputs)
	{
		return;
	}
	for (const PartInput& input : part.inputs)
	{
		const auto same = std::find_if(first.inputs.begin(), first.inputs.end(),
									   [&](const PartInput& other) { return other.path == input.path; });
		if (same != first.inputs.end() && same->hash != input.hash)
		{
			refuse(part, "found it made from other bytes of " + input.path + " than " + first.path + ", expected the same");
		}
	}
	refuse(part, "found it made from other files than " + first.path + ", expected the same");
}

// "2, 5 and 9", the first few of many.
std::string listOf(const std::vector<int>& numbers)
{
	constexpr std::size_t kShown = 8;
	std::string text;
	for (std::size_t i = 0; i < std::min(numbers.size(), kShown); ++i)
	{
		text += (i == 0 ? "" : ", ") + std::to_string(numbers[i]);
	}
	return numbers.size() > kShown ? text + " and " + std::to_string(numbers.size() - kShown) + " more" : text;
}

} // namespace

std::string partBytes(const PartFile& part)
{
	const std::string body = bodyOf(part);
	return firstLine(body) + body;
}

PartFile partFrom(std::string_view bytes, const std::string& path)
{
	PartFile part;
	part.path = path;
	if (!bytes.starts_with(kMagic))
	{
		refuse(part, "found no part of a command, expected a part of one (nook.part/1)");
	}
	const std::size_t end = bytes.find('\n');
	const std::string_view body = end == std::string_view::npos ? std::string_view() : bytes.substr(end + 1);
	if (end == std::string_view::npos || bytes.substr(0, end + 1) != firstLine(body))
	{
		refuse(part, "found a part that was cut short or changed (its sum differs), expected it as it was written");
	}
	ByteReader in(body);
	part.version = in.text();
	const std::size_t words = in.count(8);
	for (std::size_t i = 0; i < words && in.isWell(); ++i)
	{
		part.command.push_back(in.text());
	}
	const uint32_t number = in.small();
	const uint32_t of = in.small();
	const std::size_t inputs = in.count(16);
	for (std::size_t i = 0; i < inputs && in.isWell(); ++i)
	{
		std::string name = in.text();
		part.inputs.push_back({std::move(name), in.text()});
	}
	readStages(in, part);
	const bool in_range = of >= 1 && of <= static_cast<uint32_t>(kMostParts) && number >= 1 && number <= of;
	if (in_range)
	{
		part.part = {static_cast<int>(number), static_cast<int>(of)};
	}
	// Written again it is the same: nothing stands twice, out of order, or after the end.
	if (!in.isAtEnd() || !in_range || part.command.empty() || bodyOf(part) != body)
	{
		refuse(part, "found lengths or numbers that contradict each other, expected them as they were written");
	}
	return part;
}

void checkParts(std::vector<PartFile>& parts, std::string_view version)
{
	for (const PartFile& part : parts)
	{
		if (part.version != version)
		{
			refuse(part, "found a part that nook " + part.version + " has made, expected nook " + std::string(version));
		}
	}
	const PartFile& first = parts.front();
	for (const PartFile& part : parts)
	{
		if (part.command != first.command)
		{
			refuse(part, "found a part of '" + commandText(part) + "', expected '" + commandText(first) + "' as " + first.path);
		}
		if (part.part.of != first.part.of)
		{
			refuse(part, "found " + placeOf(part) + ", expected one of " + std::to_string(first.part.of) + " as " + first.path);
		}
		checkInputs(part, first);
	}
	const int of = first.part.of;
	std::stable_sort(parts.begin(), parts.end(),
					 [](const PartFile& a, const PartFile& b) { return a.part.number < b.part.number; });
	std::vector<int> missing;
	int next = 1;
	for (std::size_t i = 0; i < parts.size(); ++i)
	{
		if (i > 0 && parts[i].part.number == parts[i - 1].part.number)
		{
			refuse(parts[i], "found " + placeOf(parts[i]) + " again, which " + parts[i - 1].path + " is, expected it once");
		}
		for (; next < parts[i].part.number; ++next)
		{
			missing.push_back(next);
		}
		next += 1;
	}
	for (; next <= of; ++next)
	{
		missing.push_back(next);
	}
	if (!missing.empty())
	{
		throw Error(ExitCode::invalid_input, "merge: found " + std::to_string(parts.size()) + " of " + std::to_string(of) +
												 " parts, expected all; missing: " + listOf(missing));
	}
}

} // namespace nook
