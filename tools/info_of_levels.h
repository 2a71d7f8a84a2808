// SPDX-License-Identifier: GPL-3.0-or-later
// What `nook info` is asked and answers, and its part about levels, volumes and images.
#pragma once

#include "filter_options.h"
#include "level_options.h"
#include "summary.h"

#include <string>
#include <vector>

namespace nook
{

struct InfoOptions
{
	std::string file;
	bool methods = false;    // instead of a file: the table of methods
	std::string features_of; // instead of a file: a method whose options are listed
	Domain domain = Domain::disk;
	CLI::Option* domain_given = nullptr;
	FilterOptions filters;
	LoadSettings load;
	std::vector<CLI::Option*> load_given;
	std::string json;
	std::string progress;
	int threads = 0;
};

// The same facts for people and for programs.
struct Answer
{
	std::string lines;
	Summary summary{"info"};

	void kind(const std::string& name, Domain domain, std::size_t count)
	{
		lines += name + ": " + std::string(nameOf(domain)) + ", " + std::to_string(count) + (count == 1 ? " sample" : " samples");
		summary.text("kind", name);
		summary.text("domain", nameOf(domain));
		summary.whole("count", count);
	}

	void fact(const std::string& name, const std::string& value)
	{
		if (!value.empty())
		{
			lines += name + ": " + value + "\n";
			summary.text(name, value);
		}
	}

	void measures(const std::vector<Measure>& found)
	{
		lines += "measured:\n" + measureLines(found);
		summary.measures("quality", found);
	}
};

// Options that say nothing about such a file. Throws Error (usage) where one is given.
void refuseGiven(const std::vector<CLI::Option*>& options, const std::string& expected);

// False where the file is none of these. Throws as what reads them.
bool describeOfLevels(const InfoOptions& options, const RunSettings& settings, Answer& answer);

} // namespace nook
