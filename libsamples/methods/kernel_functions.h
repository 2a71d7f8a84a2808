// SPDX-License-Identifier: GPL-3.0-or-later
// Kernels → the functions of a module, each with its constants in it, none twice.
#pragma once

#include "methods/kernel_text.h"

#include <map>
#include <set>
#include <string>
#include <string_view>

namespace nook
{

class FunctionWriter
{
public:
	explicit FunctionWriter(const KernelText& kernels) : m_kernels(kernels) {}

	// Appends what a function needs, itself included, and is not yet there.
	std::string add(const std::string& entry, const std::map<std::string, std::string>& constants);

	bool uses(std::string_view name) const;

	// The head comments of all files that functions are from.
	std::string credits() const;

private:
	void reach(const std::string& name, const std::map<std::string, std::string>& constants,
			   std::map<std::string, std::string>& texts);

	const KernelText& m_kernels;
	std::map<std::string, std::string> m_written;
	std::set<std::string> m_used;
	std::set<std::size_t> m_credits;
};

} // namespace nook
