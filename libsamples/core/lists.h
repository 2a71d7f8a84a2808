// SPDX-License-Identifier: GPL-3.0-or-later
// Lists, texts and sums made of the items of a list, in their order.
#pragma once

#include <algorithm>
#include <iterator>
#include <numeric>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
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

// The first item that isWanted accepts, or null.
template <class List, class Wanted> auto firstWhere(List&& list, const Wanted& isWanted)
{
	const auto found = std::find_if(std::begin(list), std::end(list), isWanted);
	return found != std::end(list) ? &*found : nullptr;
}

// `count` numbers, each one more than the one before it.
template <class Number> std::vector<Number> countingFrom(Number first, std::size_t count)
{
	std::vector<Number> numbers(count);
	std::iota(numbers.begin(), numbers.end(), first);
	return numbers;
}

// Index of `item` in `list`; appends it if there is no equal one.
template <class Item> std::size_t addOnce(std::vector<Item>& list, Item item)
{
	const auto same = std::find(list.begin(), list.end(), item);
	const auto index = static_cast<std::size_t>(same - list.begin());
	if (same == list.end())
	{
		list.push_back(std::move(item));
	}
	return index;
}

// Adds all items at the end.
template <class Item, class List = std::vector<Item>> void append(std::vector<Item>& to, const List& items)
{
	to.insert(to.end(), std::begin(items), std::end(items));
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
template <class Number> Number sumOver(const std::vector<Number>& list)
{
	return sumOver(list, [](const Number& value) { return value; });
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
