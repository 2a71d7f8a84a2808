// SPDX-License-Identifier: GPL-3.0-or-later
// How far a long computation is, told to whoever wants to show it.
#pragma once

#include <functional>
#include <string_view>

namespace nook
{

// Called with a stage's name and a share from 0 to 1; may be called from several threads, one at a time. May be empty.
using Progress = std::function<void(std::string_view stage, double share)>;

// How a computation runs; never changes its result.
struct RunSettings
{
	int threads = 1; // ≥ 1
	Progress progress;
};

} // namespace nook
