// SPDX-License-Identifier: GPL-3.0-or-later
// Long lists of numbers ↔ bytes, as they lie in memory: every machine of ours has its lowest byte first.
#pragma once

#include "core/byte_text.h"

#include <cstring>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nook
{

// Of a type without padding.
template <class Item> void addList(ByteWriter& out, const std::vector<Item>& list)
{
	static_assert(std::is_trivially_copyable_v<Item>);
	out.text({reinterpret_cast<const char*>(list.data()), list.size() * sizeof(Item)});
}

// What addList() wrote, in place of what is in the list.
template <class Item> void takeList(ByteReader& in, std::vector<Item>& list)
{
	static_assert(std::is_trivially_copyable_v<Item>);
	const std::string_view bytes = in.bytes(in.whole());
	list.resize(bytes.size() / sizeof(Item));
	if (!list.empty())
	{
		std::memcpy(list.data(), bytes.data(), list.size() * sizeof(Item));
	}
}

} // namespace nook
