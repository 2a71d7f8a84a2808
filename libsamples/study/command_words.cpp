// SPDX-License-Identifier: GPL-3.0-or-later
#include "study/command_words.h"

#include "core/decimal.h"

#include <algorithm>
#include <cctype>
#include <string_view>

namespace nook
{

std::string shellWord(const std::string& text)
{
	const auto isPlain = [](char c)
	{
		return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("_-./:+=,").find(c) != std::string_view::npos;
	};
	if (!text.empty() && std::all_of(text.begin(), text.end(), isPlain))
	{
		return text;
	}
	std::string made = "'";
	for (const char c : text)
	{
		made += c == '\'' ? std::string("'\\''") : std::string(1, c);
	}
	return made + "'";
}

std::string loadOptions(const LoadSettings& load)
{
	std::string text = load.unit_m > 0.0 ? " --unit " + numberText(load.unit_m) : "";
	text += load.up == UpAxis::file ? "" : std::string(" --up ") + "xyz"[static_cast<std::size_t>(load.up) - 1];
	text += load.max_texels == kMaxTexels ? "" : " --max-texels " + std::to_string(load.max_texels);
	text += load.pose == Pose::rest ? " --pose rest" : "";
	text += load.tr == TrMeaning::automatic ? "" : load.tr == TrMeaning::opacity ? " --tr opacity" : " --tr transparency";
	return text + (load.strict ? " --strict" : "") + (load.allow_outside ? " --allow-outside" : "");
}

} // namespace nook
