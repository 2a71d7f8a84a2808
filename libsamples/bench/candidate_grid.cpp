// SPDX-License-Identifier: GPL-3.0-or-later
// The list of candidates: the axes of each row of the table of methods, volumes and rays.
#include "bench/candidates.h"

#include <utility>

namespace nook
{
namespace
{

class Grid
{
public:
	explicit Grid(GridSize size) : m_size(size) {}

	std::vector<Candidate> take()
	{
		for (const MethodRow& row : methodTable())
		{
			if (row.kind == MethodKind::screen)
			{
				for (const CandidateAxes& axes : row.axes(m_size))
				{
					multiply(row, axes);
				}
			}
		}
		volumes();
		bakes();
		rays();
		return std::move(m_all);
	}

private:
	// The list for this size.
	template <class Item>
	std::vector<Item> upTo(const std::vector<Item>& quick, const std::vector<Item>& normal, const std::vector<Item>& full) const
	{
		return m_size == GridSize::quick ? quick : m_size == GridSize::normal ? normal : full;
	}

	void multiply(const MethodRow& row, const CandidateAxes& axes)
	{
		for (const int count : axes.counts)
		{
			for (const SampleSource source : axes.sources)
			{
				if (source == SampleSource::tile && count > kMaxTileCount)
				{
					continue;
				}
				Candidate candidate;
				candidate.origin = axes.origin;
				candidate.only_form = axes.only_form;
				candidate.radius_ratio = row.radius_ratio;
				candidate.source = source;
				candidate.count = count;
				for (const ShadeSettings& form : axes.forms)
				{
					candidate.shade = form;
					candidate.shade.method = row.method;
					if (row.set_count != nullptr)
					{
						row.set_count(candidate.shade, count);
					}
					addFiltered(candidate, axes);
				}
			}
		}
	}

	void addFiltered(Candidate candidate, const CandidateAxes& axes)
	{
		for (const FilterChoice& filter : axes.filters)
		{
			candidate.shade.filter = filter.filter;
			candidate.shade.filter_taps = filter.taps;
			for (const double thickness : axes.thickness)
			{
				candidate.thickness_ratio = thickness;
				for (const bool half : axes.half)
				{
					candidate.shade.half_resolution = half;
					addRecipes(candidate, axes);
				}
			}
		}
	}

	void addRecipes(Candidate candidate, const CandidateAxes& axes)
	{
		for (const bool rays : axes.rays)
		{
			const MethodRecipe* const recipe = rays ? recipeFor(raysRecipes(), candidate.shade.method) : nullptr;
			candidate.recipe = recipe != nullptr ? std::optional(*recipe) : std::nullopt;
			if (!rays || recipe != nullptr)
			{
				m_all.push_back(candidate);
			}
		}
	}

	void addVolumes(Origin origin, VolumeRecipe recipe, int directions, int every_px)
	{
		Candidate candidate;
		candidate.kind = CandidateKind::volumes;
		candidate.origin = origin;
		candidate.volumes = recipe;
		candidate.aov.mask = directions > 0;
		candidate.aov.directions = directions > 0 ? directions : candidate.aov.directions;
		candidate.aov.every_px = every_px;
		m_all.push_back(candidate);
	}

	// AOV §5.5: one pixel of n²; masks are Laine and Karras', here with nook's polygons.
	void volumes()
	{
		const std::vector<int> every{1, 3, 5};
		for (const int n : upTo<int>({1, 3}, every, every))
		{
			addVolumes(Origin::paper, VolumeRecipe::triangles, 0, n);
		}
		for (const int n : every)
		{
			addVolumes(Origin::ours, VolumeRecipe::built, 0, n);
		}
		for (const int directions : upTo<int>({128}, {64, 128, 256}, {32, 64, 128, 256}))
		{
			for (const int n : upTo<int>({3}, every, every))
			{
				addVolumes(Origin::ours, VolumeRecipe::masks, directions, n);
			}
		}
	}

	// Budgets of bytes: the level's own vertices, and as many as an error asks for.
	void bakes()
	{
		for (const double error : upTo<double>({0.0, 0.1}, {0.0, 0.1, 0.05}, {0.0, 0.2, 0.1, 0.05}))
		{
			Candidate candidate;
			candidate.kind = CandidateKind::bake;
			candidate.bake_error = error;
			m_all.push_back(candidate);
		}
	}

	void rays()
	{
		for (const int count : upTo<int>({1, 8, 64}, {1, 4, 16, 64, 256}, {1, 2, 4, 8, 16, 32, 64, 128, 256}))
		{
			Candidate candidate;
			candidate.kind = CandidateKind::rays;
			candidate.origin = Origin::rays;
			candidate.count = count;
			m_all.push_back(candidate);
		}
	}

	GridSize m_size;
	std::vector<Candidate> m_all;
};

} // namespace

std::vector<Candidate> candidateGrid(GridSize size)
{
	return Grid(size).take();
}

} // namespace nook
