// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/pass_times.h"

#include <algorithm>

namespace nook
{

PassTime passTimeOf(const std::string& name, std::vector<double> seconds)
{
	seconds.erase(seconds.begin(), seconds.begin() + (seconds.size() > 1 ? 1 : 0));
	const std::vector<double> drawings = seconds;
	const auto middle = seconds.begin() + static_cast<std::ptrdiff_t>(seconds.size() / 2);
	std::nth_element(seconds.begin(), middle, seconds.end());
	return {name, *middle, drawings};
}

void setResult(Shaded& shaded, std::vector<float> values, bool quads)
{
	if (!quads)
	{
		shaded.visibility = std::move(values);
		return;
	}
	for (std::size_t i = 0; i < values.size(); i += 4)
	{
		shaded.bent.emplace_back(values[i], values[i + 1], values[i + 2]);
		shaded.visibility.push_back(values[i + 3]);
	}
}

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

void PassTimes::finish(Shaded& shaded) const
{
	for (std::size_t i = 0; i < m_names.size(); ++i)
	{
		shaded.passes.push_back(passTimeOf(m_names[i], m_seconds[i]));
		shaded.seconds += shaded.passes.back().seconds;
	}
}

} // namespace nook
