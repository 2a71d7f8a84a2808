// SPDX-License-Identifier: GPL-3.0-or-later
// Numbers → text that reads back as the same number, the same in every locale.
#pragma once

#include "core/decimal.h"

namespace nook
{

// The shortest decimal: "0.1", "1e-09", "inf".
inline std::string numberText(double value)
{
	return shortestDecimal(value);
}

} // namespace nook
