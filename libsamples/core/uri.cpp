// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/file.h"

#include <cstddef>

namespace nook
{

std::string unescaped(const std::string& uri)
{
	const auto hex = [](char c)
	{
		return c >= '0' && c <= '9' ? c - '0' : c >= 'a' && c <= 'f' ? c - 'a' + 10 : c >= 'A' && c <= 'F' ? c - 'A' + 10 : -1;
	};
	std::string text;
	for (std::size_t i = 0; i < uri.size(); ++i)
	{
		if (uri[i] == '%' && i + 2 < uri.size() && hex(uri[i + 1]) >= 0 && hex(uri[i + 2]) >= 0)
		{
			text.push_back(static_cast<char>(static_cast<unsigned char>(16 * hex(uri[i + 1]) + hex(uri[i + 2]))));
			i += 2;
		}
		else
		{
			text.push_back(uri[i]);
		}
	}
	return text;
}

} // namespace nook
