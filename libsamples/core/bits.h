// SPDX-License-Identifier: GPL-3.0-or-later
// The bits of a value as another type: std::bit_cast, which libc++ 13 has not.
#pragma once

namespace nook
{

template <class To, class From> constexpr To bitsAs(const From& value)
{
	static_assert(sizeof(To) == sizeof(From));
	return __builtin_bit_cast(To, value);
}

} // namespace nook
