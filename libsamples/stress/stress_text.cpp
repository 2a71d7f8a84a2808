// SPDX-License-Identifier: GPL-3.0-or-later
// What a stress run says: for people, as Markdown, as JSON; and the lines of one case.
#include "core/number.h"
#include "core/text.h"
#include "stress/case.h"
#include "stress/stress.h"

#include <array>
#include <cinttypes>
#include <cstdio>

namespace nook
{
namespace
{

std::string shortText(double value)
{
	return roundedText(value, 3);
}

std::string padded(std::string text, std::size_t width)
{
	text.resize(std::max(text.size(), width), ' ');
	return text;
}

std::string numberAt(const StressWorst& worst)
{
	return worst.at ? shortText(worst.value) : "none";
}

std::string jsonOf(const StressWorst& worst, const StressResult& result, uint32_t seed)
{
	if (!worst.at)
	{
		return "null";
	}
	return "{\"value\": " + doubleText(worst.value) + ", \"command\": " + jsonText(commandOfCase(result.name, seed, *worst.at)) +
		   "}";
}

std::string jsonOf(const std::optional<uint64_t>& at, const StressResult& result, uint32_t seed)
{
	return at ? jsonText(commandOfCase(result.name, seed, *at)) : "null";
}

// The commands that show what did not pass.
std::string failures(const StressResult& result, uint32_t seed)
{
	std::string text;
	const auto line = [&](const std::string& what, const std::optional<uint64_t>& at)
	{
		if (at)
		{
			text += "  " + what + ": " + commandOfCase(result.name, seed, *at) + "\n";
		}
	};
	if (result.broken > 0)
	{
		line("not a number", result.first_broken);
	}
	if (result.outside > 0)
	{
		line("out of range", result.first_outside);
	}
	if (result.absolute.value > result.most_absolute)
	{
		line("error " + shortText(result.absolute.value) + ", threshold " + shortText(result.most_absolute), result.absolute.at);
	}
	return text;
}

} // namespace

std::string stressText(const std::vector<StressResult>& results, const StressSettings& settings)
{
	std::string text = padded("kernel", 22) + padded("cases", 11) + padded("compared", 11) + padded("unsure", 9) +
					   padded("NaN", 5) + padded("range", 7) + padded("worst error", 13) + padded("threshold", 11) +
					   padded("relative", 10) + "unit\n";
	std::string wrong;
	for (const StressResult& result : results)
	{
		text += padded(std::string(result.name), 22) + padded(std::to_string(result.cases), 11) +
				padded(std::to_string(result.compared), 11) + padded(std::to_string(result.unsure), 9) +
				padded(std::to_string(result.broken), 5) + padded(std::to_string(result.outside), 7) +
				padded(numberAt(result.absolute), 13) + padded(shortText(result.most_absolute), 11) +
				padded(numberAt(result.relative), 10) + std::string(result.unit) + (result.passed() ? "" : "  FAILED") + "\n";
		wrong += failures(result, settings.seed);
	}
	return text + (wrong.empty() ? "" : "failed:\n" + wrong);
}

std::string stressMarkdown(const std::vector<StressResult>& results, const StressSettings& settings, std::string_view version)
{
	std::string text =
		"| kernel | against | cases | compared | unsure | NaN, range | worst error | threshold | unit | shows it again |\n"
		"| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
	for (const StressResult& result : results)
	{
		text += "| `" + std::string(result.name) + "` | " + std::string(result.what) + " | " + std::to_string(result.cases) +
				" | " + std::to_string(result.compared) + " | " + std::to_string(result.unsure) + " | " +
				std::to_string(result.broken) + ", " + std::to_string(result.outside) + " | " + numberAt(result.absolute) + " | " +
				shortText(result.most_absolute) + " | " + std::string(result.unit) + " | " +
				(result.absolute.at ? "`--case " + std::to_string(*result.absolute.at) + "`" : "") + " |\n";
	}
	return text + "\nnook " + std::string(version) + ", `nook stress --cases " + std::to_string(settings.cases) + " --seed " +
		   std::to_string(settings.seed) + "`.\n";
}

std::string stressJson(const std::vector<StressResult>& results, const StressSettings& settings, std::string_view version)
{
	std::string text = "{\n\"schema\": \"nook.stress/1\",\n\"version\": " + jsonText(version) +
					   ",\n\"cases\": " + std::to_string(settings.cases) + ",\n\"seed\": " + std::to_string(settings.seed) +
					   ",\n\"kernels\": [";
	for (std::size_t i = 0; i < results.size(); ++i)
	{
		const StressResult& result = results[i];
		text += std::string(i == 0 ? "" : ",") + "\n{\"name\": " + jsonText(result.name) +
				", \"family\": " + jsonText(result.family) + ", \"against\": " + jsonText(result.what) +
				", \"unit\": " + jsonText(result.unit) + ", \"cases\": " + std::to_string(result.cases) +
				", \"compared\": " + std::to_string(result.compared) + ", \"unsure\": " + std::to_string(result.unsure) +
				", \"not_numbers\": " + std::to_string(result.broken) + ", \"out_of_range\": " + std::to_string(result.outside) +
				", \"absolute\": " + jsonOf(result.absolute, result, settings.seed) +
				", \"most_absolute\": " + doubleText(result.most_absolute) +
				", \"relative\": " + jsonOf(result.relative, result, settings.seed) +
				", \"first_not_number\": " + jsonOf(result.first_broken, result, settings.seed) +
				", \"first_out_of_range\": " + jsonOf(result.first_outside, result, settings.seed) +
				", \"passed\": " + (result.passed() ? "true" : "false") + "}";
	}
	return text + "\n]\n}\n";
}

namespace stress
{

void CaseNotes::line(std::string_view name, std::span<const double> values, bool narrow)
{
	m_text += std::string(name) + ":";
	for (const double value : values)
	{
		char hex[64];
		std::snprintf(hex, sizeof hex, " %a (%.*g)", value, narrow ? 9 : 17, value);
		m_text += hex;
	}
	m_text += "\n";
}

void CaseNotes::whole(std::string_view name, std::span<const int> values)
{
	m_text += std::string(name) + ":";
	for (const int value : values)
	{
		m_text += " " + std::to_string(value);
	}
	m_text += "\n";
}

void CaseNotes::add(std::string_view name, double value)
{
	line(name, std::array{value}, false);
}
void CaseNotes::add(std::string_view name, long double value)
{
	char text[96];
	std::snprintf(text, sizeof text, " %La (%.21Lg)", value, value);
	m_text += "  expected " + std::string(name) + ":" + text + "\n";
}
void CaseNotes::add(std::string_view name, int value)
{
	whole(name, std::array{value});
}
void CaseNotes::add(std::string_view name, std::string_view value)
{
	m_text += std::string(name) + ": " + std::string(value) + "\n";
}
void CaseNotes::add(std::string_view name, const glm::vec2& value)
{
	line(name, std::array{static_cast<double>(value.x), static_cast<double>(value.y)}, true);
}
void CaseNotes::add(std::string_view name, const glm::vec3& value)
{
	line(name, std::array{static_cast<double>(value.x), static_cast<double>(value.y), static_cast<double>(value.z)}, true);
}
void CaseNotes::add(std::string_view name, const glm::vec4& value)
{
	line(name,
		 std::array{static_cast<double>(value.x), static_cast<double>(value.y), static_cast<double>(value.z),
					static_cast<double>(value.w)},
		 true);
}
void CaseNotes::add(std::string_view name, const glm::dvec3& value)
{
	line(name, std::array{value.x, value.y, value.z}, false);
}
void CaseNotes::add(std::string_view name, const glm::ivec2& value)
{
	whole(name, std::array{value.x, value.y});
}
void CaseNotes::add(std::string_view name, const glm::ivec4& value)
{
	whole(name, std::array{value.x, value.y, value.z, value.w});
}

} // namespace stress
} // namespace nook
