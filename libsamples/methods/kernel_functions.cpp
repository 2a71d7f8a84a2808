// SPDX-License-Identifier: GPL-3.0-or-later
#include "methods/kernel_functions.h"

#include "core/error.h"

namespace nook
{

std::string FunctionWriter::add(const std::string& entry, const std::map<std::string, std::string>& constants)
{
	std::map<std::string, std::string> texts; // of what is reached
	reach(entry, constants, texts);
	if (texts.empty())
	{
		throw Error(ExitCode::runtime, std::string("kernels: found no ") + entry + ", expected one in methods/kernels/*.glsl");
	}
	std::map<std::string, std::string> names{{"nookSample", entry + "Sample"}, {"nookVariant", entry + "Variant"}};
	std::string result;
	for (const KernelFunction& function : m_kernels.functions)
	{
		const auto found = texts.find(function.name);
		if (found == texts.end())
		{
			continue;
		}
		std::string text = renamed(found->second, names);
		const auto [there, fresh] = m_written.emplace(function.name, text);
		if (!fresh && there->second == text)
		{
			continue;
		}
		if (!fresh) // another method has it with other constants
		{
			names[function.name] = function.name + "Of" + entry.substr(4);
			text = renamed(text, names);
		}
		m_credits.insert(function.credit);
		result += "\n" + resolved(function.comment, constants) + text;
	}
	return result;
}

bool FunctionWriter::uses(std::string_view name) const
{
	return m_used.contains(std::string(name));
}

std::string FunctionWriter::credits() const
{
	std::string text;
	for (const std::size_t credit : m_credits)
	{
		text += "//\n" + m_kernels.credits[credit];
	}
	return text;
}

void FunctionWriter::reach(const std::string& name, const std::map<std::string, std::string>& constants,
						   std::map<std::string, std::string>& texts)
{
	m_used.insert(name);
	for (const KernelFunction& function : m_kernels.functions)
	{
		if (function.name == name && !texts.contains(name))
		{
			const std::string text = resolved(function.text, constants);
			texts[name] = text;
			for (const std::string& used : identifiersOf(text))
			{
				reach(used, constants, texts);
			}
		}
	}
}

} // namespace nook
