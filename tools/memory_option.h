// SPDX-License-Identifier: GPL-3.0-or-later
// Options that are a number of bytes; --memory: how much a verb's work may take.
#pragma once

#include "options.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace nook
{

// "512MiB", "2GiB" or a number of bytes, above 0.
inline CLI::Option* addBytes(CLI::App& app, const std::string& name, uint64_t& bytes, const std::string& help)
{
	const auto take = [&bytes, name](const std::string& text)
	{
		constexpr std::array<std::string_view, 4> kUnits{"", "KiB", "MiB", "GiB"};
		constexpr std::array<uint64_t, 4> kBytes{1, uint64_t{1} << 10U, uint64_t{1} << 20U, uint64_t{1} << 30U};
		uint64_t number = 0;
		const std::from_chars_result result = std::from_chars(text.data(), text.data() + text.size(), number);
		const std::string_view unit(result.ptr, static_cast<std::size_t>(text.data() + text.size() - result.ptr));
		const auto* const found = std::find(kUnits.begin(), kUnits.end(), unit);
		const auto at = static_cast<std::size_t>(found - kUnits.begin());
		if (result.ec != std::errc{} || found == kUnits.end() || number == 0 || number > (uint64_t{1} << 50U) / kBytes[at])
		{
			refuseValue(name, text, "a number of bytes, KiB, MiB or GiB: 2GiB");
		}
		bytes = number * kBytes[at];
	};
	return app.add_option_function<std::string>(name, take, help)->type_name("SIZE");
}

inline CLI::Option* addMemory(CLI::App& app, uint64_t& bytes, const std::string& help)
{
	return addBytes(app, "--memory", bytes, help);
}

} // namespace nook
