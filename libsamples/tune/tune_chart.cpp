// SPDX-License-Identifier: GPL-3.0-or-later
#include "tune/tune_page.h"

#include "core/text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace nook
{
namespace
{

// Numbers with a point, whatever the digits: for SVG.
std::string place(double value)
{
	return fixedText(value, 1);
}

const TuneSearch& shown(const TuneReport& report)
{
	return report.grid ? *report.grid : report.search;
}

// Time to the right, error upward, both logarithmic.
class Chart
{
public:
	explicit Chart(const TuneReport& report) : m_report(report)
	{
		for (const Tried& tried : shown(report).tried)
		{
			if (tried.failed.empty() && !tried.trial.views.empty())
			{
				take(m_time, tried.time_s);
				take(m_error, tried.error);
			}
		}
		take(m_time, report.settings.goal.budget_s.value_or(m_time[0]));
		take(m_error, report.settings.goal.max_error.value_or(m_error[0]));
		for (std::array<double, 2>* range : {&m_time, &m_error})
		{
			const double margin = std::pow((*range)[1] / (*range)[0], 0.05) * 1.02;
			(*range)[0] /= margin;
			(*range)[1] *= margin;
		}
	}

	std::string svg() const
	{
		std::string text = "<svg viewBox=\"0 0 760 420\" role=\"img\" aria-label=\"time against error\">\n";
		ticks(text);
		goal(text);
		std::string points;
		std::string line;
		for (const Tried& tried : shown(m_report).tried)
		{
			if (tried.failed.empty() && !tried.trial.views.empty())
			{
				points += point(tried, isFrom(tried, m_report.rungs.once()) ? "full" : "coarse", 3.0);
			}
		}
		for (const std::size_t i : frontOf(shown(m_report), m_report.rungs.once()))
		{
			const Tried& tried = shown(m_report).tried[i];
			line += (line.empty() ? "M" : " L") + place(x(tried.time_s)) + " " + place(y(tried.error));
		}
		text += points + "<path class=\"front\" d=\"" + line + "\"/>\n";
		if (m_report.search.pick)
		{
			const Tried& pick = m_report.search.tried[*m_report.search.pick];
			text += point(pick, "pick", 6.0);
			const bool right = x(pick.time_s) < 460.0;
			text += "<text class=\"pick-name\" x=\"" + place(x(pick.time_s) + (right ? 10.0 : -10.0)) + "\" y=\"" +
					place(y(pick.error) - 8.0) + "\"" + (right ? "" : " text-anchor=\"end\"") + ">" +
					xmlText(m_report.candidates[pick.candidate].name()) + "</text>\n";
		}
		return text + "</svg>\n";
	}

private:
	static void take(std::array<double, 2>& range, double value)
	{
		value = std::max(value, 1e-9);
		range = {std::min(range[0], value), std::max(range[1], value)};
	}

	static double share(const std::array<double, 2>& range, double value)
	{
		return std::log(std::max(value, 1e-9) / range[0]) / std::log(range[1] / range[0]);
	}
	double x(double time_s) const
	{
		return 60.0 + 680.0 * share(m_time, time_s);
	}
	double y(double error) const
	{
		return 380.0 - 360.0 * share(m_error, error);
	}

	std::string point(const Tried& tried, const char* kind, double size) const
	{
		return std::string("<circle class=\"") + kind + "\" cx=\"" + place(x(tried.time_s)) + "\" cy=\"" + place(y(tried.error)) +
			   "\" r=\"" + place(size) + "\"><title>" + xmlText(m_report.candidates[tried.candidate].name()) + ": " +
			   roundedText(1e3 * tried.time_s, 3) + " ms, " + roundedText(tried.error, 4) + "</title></circle>\n";
	}

	// Round numbers within a range: more of them where it is short.
	static std::vector<double> roundNumbers(const std::array<double, 2>& range)
	{
		const std::vector<double> steps = range[1] / range[0] < 8.0
											  ? std::vector<double>{1.0, 1.2, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}
											  : std::vector<double>{1.0, 2.0, 5.0};
		std::vector<double> numbers;
		for (double decade = 1e-9; decade < 1e6; decade *= 10.0)
		{
			for (const double step : steps)
			{
				if (decade * step > range[0] && decade * step < range[1])
				{
					numbers.push_back(decade * step);
				}
			}
		}
		return numbers;
	}

	void ticks(std::string& text) const
	{
		for (const double value : roundNumbers(m_time))
		{
			const std::string at = place(x(value));
			text += "<line class=\"axis\" x1=\"" + at + "\" x2=\"" + at + "\" y1=\"20\" y2=\"380\"/><text x=\"" + at +
					"\" y=\"396\" text-anchor=\"middle\">" + roundedText(1e3 * value, 4) + "</text>\n";
		}
		for (const double value : roundNumbers(m_error))
		{
			const std::string at = place(y(value));
			text += "<line class=\"axis\" x1=\"60\" x2=\"740\" y1=\"" + at + "\" y2=\"" + at + "\"/><text x=\"54\" y=\"" +
					place(y(value) + 4.0) + "\" text-anchor=\"end\">" + roundedText(value, 4) + "</text>\n";
		}
		text += "<text x=\"740\" y=\"414\" text-anchor=\"end\">milliseconds</text><text x=\"60\" y=\"13\">" +
				std::string(nameOf(m_report.settings.measure)) + "</text>\n";
	}

	void goal(std::string& text) const
	{
		const TuneGoal& goal = m_report.settings.goal;
		if (goal.budget_s)
		{
			const std::string at = place(x(*goal.budget_s));
			text += "<line class=\"goal\" x1=\"" + at + "\" x2=\"" + at + "\" y1=\"20\" y2=\"380\"/>\n";
			return;
		}
		const std::string at = place(y(*goal.max_error));
		text += "<line class=\"goal\" x1=\"60\" x2=\"740\" y1=\"" + at + "\" y2=\"" + at + "\"/>\n";
	}

	const TuneReport& m_report;
	std::array<double, 2> m_time{1e30, 1e-9};
	std::array<double, 2> m_error{1e30, 1e-9};
};

} // namespace

std::string tuneChart(const TuneReport& report)
{
	return Chart(report).svg();
}

} // namespace nook
