// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/second_limit.h"

#include "error_report/second_layer.h"
#include "fit/shape_fit.h"

#include <array>
#include <cmath>
#include <limits>

namespace nook
{
namespace
{

constexpr std::array<double, 7> kThickness{0.0625, 0.125, 0.25, 0.5, 0.75, 1.0, 2.0};
constexpr std::array<int, 2> kSteps{8, 32};
constexpr int kEvery = 3; // of both axes: with the window's side of 4 it comes by every variant

class Search
{
public:
	Search(const ViewBench& on, const Tracer& tracer, const RunSettings& run)
		: m_on(on), m_tracer(tracer), m_run(run), m_surfaces(surfacesOf(on.gbuffer())), m_some(m_surfaces)
	{
		const auto width = static_cast<std::size_t>(on.gbuffer().width_px);
		for (std::size_t i = 0; i < m_some.size(); ++i)
		{
			m_some[i] = i % width % kEvery == 0 && i / width % kEvery == 0 ? m_some[i] : char{0};
		}
	}

	SecondLimit best(LayersSettings settings)
	{
		settings.every_px = kEvery;
		settings.slices = 4;
		ProgressCounter progress(m_run.progress, "limit of two layers",
								 2 * kSteps.size() * kThickness.size() + kThickness.size() + 1);
		const double thickness = settings.thickness;
		for (const SecondSurface which : {SecondSurface::any, SecondSurface::facing})
		{
			const std::vector<float> second = secondDepths(m_tracer, m_on.gbuffer(), which, m_run);
			for (const int steps : kSteps)
			{
				for (const double behind : kThickness)
				{
					settings.steps = steps;
					settings.second_thickness = behind;
					attempt(settings, which, second);
					progress.finishOne();
				}
			}
		}
		const std::vector<float> second = secondDepths(m_tracer, m_on.gbuffer(), m_which, m_run);
		settings = m_best;
		for (const double first : kThickness)
		{
			settings.thickness = first;
			if (first != thickness)
			{
				attempt(settings, m_which, second);
			}
			progress.finishOne();
		}
		const SecondLimit limit = measured(second);
		progress.finishOne();
		return limit;
	}

private:
	void attempt(const LayersSettings& settings, SecondSurface which, const std::vector<float>& second)
	{
		const std::vector<float> visibility = layersVisibility(m_on.gbuffer(), second, settings, m_run);
		const ShapeView view = shapeView(0, visibility, m_on.reference().visibility, m_some);
		const double error = shapedError({&view, 1}, fitShape({&view, 1}));
		if (error < m_error)
		{
			m_error = error;
			m_best = settings;
			m_which = which;
		}
	}

	// All pixels.
	SecondLimit measured(const std::vector<float>& second) const
	{
		LayersSettings settings = m_best;
		settings.every_px = 1;
		settings.slices = 16;
		std::vector<float> visibility = layersVisibility(m_on.gbuffer(), second, settings, m_run);
		const ShapeView view = shapeView(0, visibility, m_on.reference().visibility, m_surfaces);
		const CurveShape shape = fitShape({&view, 1});
		for (float& v : visibility)
		{
			v = static_cast<float>(std::pow(std::max(0.0, 1.0 - shape.strength * (1.0 - static_cast<double>(v))), shape.power));
		}
		return {{settings.thickness, shape.strength, shape.power, m_on.errorsOf(visibility)},
				settings.second_thickness,
				m_which == SecondSurface::facing};
	}

	const ViewBench& m_on;
	const Tracer& m_tracer;
	const RunSettings& m_run;
	std::vector<char> m_surfaces;
	std::vector<char> m_some; // of them
	LayersSettings m_best;
	SecondSurface m_which = SecondSurface::any;
	double m_error = std::numeric_limits<double>::infinity();
};

} // namespace

SecondLimit secondLimitOf(const ViewBench& on, const Tracer& tracer, double radius_m, const ScreenLimit& one,
						  const RunSettings& run)
{
	LayersSettings settings;
	settings.radius_m = radius_m;
	settings.thickness = one.thickness;
	return Search(on, tracer, run).best(settings);
}

} // namespace nook
