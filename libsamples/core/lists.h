// SPDX-License-Identifier: GPL-3.0-or-later
// Lists, texts and sums made of the items of a list, in their order.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

namespace nook
{

// make(item) for each item.
template <class List, class Make> auto mapped(const List& list, const Make& make)
{
	std::vector<std::decay_t<decltype(make(*std::begin(list)))>> made;
	made.reserve(std::size(list));
	for (const auto& item : list)
	{
		made.push_back(make(item));
	}
	return made;
}

// make(0), make(1), … make(count - 1).
template <class Make> auto listOf(std::size_t count, const Make& make)
{
	std::vector<std::decay_t<decltype(make(count))>> made;
	made.reserve(count);
	for (std::size_t i = 0; i < count; ++i)
	{
		made.push_back(make(i));
	}
	return made;
}

// The items and the indices 0 to count - 1 that isWanted accepts.
template <class List, class Wanted> auto itemsWhere(const List& list, const Wanted& isWanted)
{
	std::vector<std::decay_t<decltype(*std::begin(list))>> wanted;
	std::copy_if(std::begin(list), std::end(list), std::back_inserter(wanted), isWanted);
	return wanted;
}
template <class Wanted> std::vector<std::size_t> indicesWhere(std::size_t count, const Wanted& isWanted)
{
	std::vector<std::size_t> wanted;
	for (std::size_t i = 0; i < count; ++i)
	{
		if (isWanted(i))
		{
			wanted.push_back(i);
		}
	}
	return wanted;
}

// The texts of all items with `between` between them.
template <class List, class Text> std::string joinedText(const List& list, std::string_view between, const Text& textOf)
{
	std::string text;
	for (const auto& item : list)
	{
		text += text.empty() ? "" : between;
		text += textOf(item);
	}
	return text;
}
template <class List> std::string joinedText(const List& list, std::string_view between)
{
	return joinedText(list, between, [](std::string_view item) { return item; });
}

// The sum of valueOf(item), from 0 on.
template <class List, class Value> auto sumOver(const List& list, const Value& valueOf)
{
	std::decay_t<decltype(valueOf(*std::begin(list)))> sum{};
	for (const auto& item : list)
	{
		sum += valueOf(item);
	}
	return sum;
}
inline double sumOver(const std::vector<double>& list)
{
	return sumOver(list, [](double value) { return value; });
}

// use(run) for each longest run of items that are the same as its first one.
template <class Item, class Same, class Use> void eachRun(std::span<const Item> list, const Same& same, const Use& use)
{
	for (std::size_t begin = 0, end = 0; begin < list.size(); begin = end)
	{
		while (end < list.size() && same(list[begin], list[end]))
		{
			++end;
		}
		use(list.subspan(begin, end - begin));
	}
}

} // namespace nook
