// SPDX-License-Identifier: GPL-3.0-or-later
// The list of candidates: the axes of each row of the table of methods, volumes and rays.
#include "study/candidates.h"

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
		assets();
		rays();
		return std::move(m_all);
	}

private:
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

	void assets()
	{
		for (const AssetKind& kind : assetTable())
		{
			for (const AssetCandidate& one : kind.candidates(m_size))
			{
				Candidate candidate;
				static_cast<AssetSettings&>(candidate) = one.settings;
				candidate.kind = CandidateKind::asset;
				candidate.asset = &kind;
				candidate.origin = one.origin;
				m_all.push_back(candidate);
			}
		}
	}

	void rays()
	{
		for (const int count : upTo<int>(m_size, {1, 8, 64}, {1, 4, 16, 64, 256}, {1, 2, 4, 8, 16, 32, 64, 128, 256}))
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
