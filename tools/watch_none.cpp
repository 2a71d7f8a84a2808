// SPDX-License-Identifier: GPL-3.0-or-later
#include "watch.h"

namespace nook
{

Progress pageProgress()
{
	return {};
}

Watch pageWatch()
{
	return {};
}

} // namespace nook
