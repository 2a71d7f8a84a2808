// SPDX-License-Identifier: GPL-3.0-or-later
#include "progress_line.h"

#include "core/text.h"

#include <cmath>
#include <cstdio>
#include <optional>
#include <string>

namespace nook
{
namespace
{

// "1 min 20 s".
std::string spoken(double seconds)
{
	const auto whole = static_cast<long>(std::ceil(seconds));
	const long hours = whole / 3600;
	const long minutes = whole / 60 % 60;
	if (hours > 0)
	{
		return std::to_string(hours) + " h " + std::to_string(minutes) + " min";
	}
	const std::string rest = std::to_string(whole % 60) + " s";
	return minutes > 0 ? std::to_string(minutes) + " min " + rest : rest;
}

std::string percentOf(double share)
{
	return std::to_string(static_cast<int>(std::floor(100.0 * share))) + " %";
}

std::string barOf(double share)
{
	constexpr std::size_t kCells = 20;
	const auto full = static_cast<std::size_t>(std::floor(static_cast<double>(kCells) * share));
	return "[" + std::string(full, '#') + std::string(kCells - full, '.') + "]";
}

// The bar and the time left are those of the outermost stage that knows them. Of one that nothing counts the name is all.
std::string textOf(std::span<const ProgressStage> stages, double now_s)
{
	std::string text;
	bool has_bar = false;
	bool has_time = false;
	for (const ProgressStage& stage : stages)
	{
		text += (text.empty() ? "" : ": ") + oneLine(stage.name);
		if (stage.share > 0.0)
		{
			text += (has_bar ? " " : " " + barOf(stage.share) + " ") + percentOf(stage.share);
			has_bar = true;
		}
		const std::optional<double> left_s = stage.remainingAt(now_s);
		if (left_s && !has_time)
		{
			text += ", " + spoken(*left_s) + " left";
			has_time = true;
		}
	}
	return text;
}

} // namespace

// Without line breaks by the terminal (DECAWM) while it is written: of a line that is too long, the end is not seen.
void ProgressLine::show(std::span<const ProgressStage> stages, double now_s)
{
	const bool begins = stages.size() == 1 && stages.front().share == 0.0;
	if (!begins && m_shown && now_s - m_shown_s < kProgressEvery_s)
	{
		return;
	}
	m_shown = true;
	m_shown_s = now_s;
	std::fprintf(stderr, "\r\033[?7l%s\033[K\033[?7h", textOf(stages, now_s).c_str());
	std::fflush(stderr);
}

void ProgressLine::clear()
{
	if (m_shown)
	{
		std::fputs("\r\033[K", stderr);
		std::fflush(stderr);
		m_shown = false;
	}
}

} // namespace nook
