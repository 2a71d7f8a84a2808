// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/pass_times.h"

#include <algorithm>

namespace nook
{

PassTimes::PassTimes(const ShadePlan& plan) : m_seconds(plan.passes.size())
{
	for (const ShadePass& pass : plan.passes)
	{
		m_names.push_back(pass.kernel.name);
	}
}

int PassTimes::drawings(const DrawSettings& settings)
{
	return settings.repetitions + 1;
}

void PassTimes::add(std::size_t pass, double seconds)
{
	m_seconds[pass].push_back(seconds);
}

void PassTimes::finish(const DrawSettings& settings, Shaded& shaded) const
{
	for (std::size_t i = 0; i < m_names.size(); ++i)
	{
		std::vector<double> seconds = m_seconds[i];
		seconds.erase(seconds.begin(), seconds.begin() + (settings.repetitions > 0 ? 1 : 0));
		const std::vector<double> drawings = seconds;
		const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
		std::nth_element(seconds.begin(), middle, seconds.end());
		shaded.passes.push_back({m_names[i], *middle, drawings});
		shaded.seconds += *middle;
	}
}

} // namespace nook
