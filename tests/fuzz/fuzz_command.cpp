// SPDX-License-Identifier: GPL-3.0-or-later
// Command lines of all verbs, including cameras: parsed as in main(), without running anything. One argument per line.
#include "fuzz.h"

#include "options.h"

#include <vector>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
	std::vector<std::string> words{"nook"};
	std::string word;
	for (std::size_t i = 0; i < size; ++i)
	{
		if (data[i] == '\n')
		{
			words.push_back(word);
			word.clear();
		}
		else if (data[i] != 0)
		{
			word += static_cast<char>(data[i]);
		}
	}
	words.push_back(word);
	std::vector<const char*> arguments;
	for (const std::string& one : words)
	{
		arguments.push_back(one.c_str());
	}
	// Created once, since that takes longer than parsing; parse() resets earlier results.
	static CLI::App app("");
	static const std::vector<nook::Verb> verbs = nook::addVerbs(app);
	nook::fuzz::tryTo(
		[&]
		{
			try
			{
				app.parse(static_cast<int>(arguments.size()), arguments.data());
			}
			catch (const CLI::ParseError&)
			{
				// main() would print the error or the help.
			}
		});
	return 0;
}
