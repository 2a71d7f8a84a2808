// SPDX-License-Identifier: GPL-3.0-or-later
// The list of candidates: papers' own recipes, and nook's forms of the same methods.
#include "bench/candidates.h"

#include <initializer_list>

namespace nook
{
namespace
{

// Radius of the volumetric methods against that of rays with linear falloff: AOV §6.
constexpr double kVolumetricRatio = 1.1;

bool isVolumetric(ShadeMethod method)
{
	return method == ShadeMethod::vo_line || method == ShadeMethod::vo_point || method == ShadeMethod::vo_area ||
		   method == ShadeMethod::statvo || method == ShadeMethod::volumetric;
}

struct FilterChoice
{
	ShadeFilter filter = ShadeFilter::none;
	int taps = 5;
};

constexpr FilterChoice kNone{ShadeFilter::none, 5};
constexpr FilterChoice kWindow{ShadeFilter::window, 5};
constexpr FilterChoice kFive{ShadeFilter::bilateral, 5};
constexpr FilterChoice kNine{ShadeFilter::bilateral, 9};
constexpr FilterChoice kThirteen{ShadeFilter::bilateral, 13};

// What is multiplied out of a method that takes a pattern.
struct Axes
{
	std::vector<int> counts;
	std::vector<SampleSource> sources;
	std::vector<FilterChoice> filters;
	std::vector<double> thickness{0.0}; // in radii
	std::vector<bool> half{false};
};

class Grid
{
public:
	explicit Grid(GridSize size) : m_size(size) {}

	std::vector<Candidate> take()
	{
		volumetric();
		alchemy();
		statvo();
		rivals();
		volumes();
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

	static Candidate screen(ShadeMethod method, Origin origin, SampleSource source, int count, const FilterChoice& filter)
	{
		Candidate candidate;
		candidate.origin = origin;
		candidate.shade.method = method;
		candidate.shade.filter = filter.filter;
		candidate.shade.filter_taps = filter.taps;
		candidate.radius_ratio = isVolumetric(method) ? kVolumetricRatio : 1.0;
		candidate.source = source;
		candidate.count = count;
		return candidate;
	}

	void multiply(ShadeMethod method, Origin origin, const Axes& axes)
	{
		for (const int count : axes.counts)
		{
			for (const SampleSource source : axes.sources)
			{
				if (source == SampleSource::tile && count > kMaxTileCount)
				{
					continue;
				}
				for (const FilterChoice& filter : axes.filters)
				{
					for (const double thickness : axes.thickness)
					{
						for (const bool half : axes.half)
						{
							Candidate candidate = screen(method, origin, source, count, filter);
							candidate.thickness_ratio = thickness;
							candidate.shade.half_resolution = half;
							m_all.push_back(candidate);
						}
					}
				}
			}
		}
	}

	// VO §4.6: 4 × 4 pixels share a random texture, an edge-aware blur; thickness is §4.3.
	void volumetric()
	{
		const std::vector<FilterChoice> paper_filters =
			upTo<FilterChoice>({kWindow}, {kWindow, kThirteen}, {kNone, kWindow, kThirteen});
		const std::vector<FilterChoice> our_filters = upTo<FilterChoice>({kFive}, {kFive, kWindow}, {kNone, kFive, kNine, kWindow});
		const std::vector<SampleSource> our_sources =
			upTo<SampleSource>({SampleSource::tile}, {SampleSource::tile}, {SampleSource::tile, SampleSource::refined});
		const std::vector<bool> resolutions{false, true};
		const std::vector<double> thin{0.0, 0.5};
		multiply(ShadeMethod::vo_line, Origin::paper,
				 {upTo<int>({5, 9, 16}, {5, 9, 16, 33}, {5, 7, 9, 13, 16, 33}), {SampleSource::electro}, paper_filters, thin});
		multiply(
			ShadeMethod::vo_line, Origin::ours,
			{upTo<int>({5, 9, 16}, {3, 5, 7, 9, 12, 16}, {2, 3, 4, 5, 7, 9, 12, 16}), our_sources, our_filters, thin, resolutions});
		multiply(ShadeMethod::vo_point, Origin::paper,
				 {upTo<int>({6, 12, 33}, {6, 12, 33}, {6, 12, 33, 64}), {SampleSource::electro}, paper_filters, thin});
		multiply(ShadeMethod::vo_point, Origin::ours,
				 {upTo<int>({6, 12}, {6, 9, 12, 16}, {4, 6, 9, 12, 16}), our_sources, our_filters, thin,
				  upTo<bool>({false}, resolutions, resolutions)});
		multiply(ShadeMethod::vo_area, Origin::paper, {upTo<int>({5}, {5, 9}, {5, 9, 16}), {SampleSource::electro}, paper_filters});
		multiply(ShadeMethod::vo_area, Origin::ours,
				 {upTo<int>({5}, {3, 5, 9}, {3, 5, 9, 16}),
				  our_sources,
				  our_filters,
				  {0.0},
				  upTo<bool>({false}, resolutions, resolutions)});
	}

	// ALC §3: random samples on the disk, two passes of 13 taps.
	void alchemy()
	{
		multiply(ShadeMethod::alchemy, Origin::paper,
				 {upTo<int>({4, 12}, {4, 8, 12, 24}, {4, 8, 12, 24}),
				  {SampleSource::uniform},
				  upTo<FilterChoice>({kThirteen}, {kThirteen}, {kNone, kThirteen})});
		multiply(ShadeMethod::alchemy, Origin::ours,
				 {upTo<int>({4, 12}, {3, 4, 6, 9, 12, 16}, {3, 4, 6, 9, 12, 16}),
				  upTo<SampleSource>({SampleSource::tile}, {SampleSource::tile}, {SampleSource::tile, SampleSource::refined}),
				  upTo<FilterChoice>({kFive}, {kFive, kWindow}, {kNone, kFive, kNine, kWindow}),
				  {0.0},
				  {false, true}});
	}

	// SVO: 1, 2 or 4 adaptive layers, tables of whole, half and quarter pictures, four quadrants; no filter. Ours skip layers.
	void statvo()
	{
		for (const Origin origin : {Origin::paper, Origin::ours})
		{
			for (const int layers : upTo<int>({2, 4}, {1, 2, 4}, {1, 2, 4}))
			{
				for (const int cell_px : upTo<int>({1, 2}, {1, 2, 4}, {1, 2, 4}))
				{
					for (const bool quadrants : upTo<bool>({false}, {false, true}, {false, true}))
					{
						if ((m_size == GridSize::quick && layers == 2 && cell_px == 1) || (origin == Origin::ours && layers == 1))
						{
							continue; // one layer: there is none to skip
						}
						Candidate candidate = screen(ShadeMethod::statvo, origin, SampleSource::own, layers, kNone);
						candidate.shade.statvo.layers = layers;
						candidate.shade.statvo.cell_px = cell_px;
						candidate.shade.statvo.quadrants = quadrants;
						candidate.shade.statvo.skip = origin == Origin::ours;
						m_all.push_back(candidate);
					}
				}
			}
		}
	}

	// docs/reference/comparison.md
	void rivals()
	{
		for (const int count : upTo<int>({16}, {8, 16, 32}, {8, 16, 32, 64}))
		{
			m_all.push_back(screen(ShadeMethod::crytek, Origin::paper, SampleSource::own, count, kWindow));
		}
		for (const int count : upTo<int>({9}, {4, 9, 16}, {4, 9, 16, 32}))
		{
			m_all.push_back(screen(ShadeMethod::volumetric, Origin::paper, SampleSource::electro, count, kWindow));
		}
		for (const int directions : upTo<int>({6}, {4, 6, 8}, {4, 6, 8, 16}))
		{
			Candidate candidate = screen(ShadeMethod::hbao, Origin::paper, SampleSource::own, directions, kThirteen);
			candidate.shade.rival.directions = directions;
			m_all.push_back(candidate);
		}
		for (const int count : upTo<int>({11}, {6, 11, 24}, {6, 11, 24, 48}))
		{
			Candidate candidate = screen(ShadeMethod::sao, Origin::paper, SampleSource::own, count, kFive);
			candidate.shade.rival.spiral_samples = count;
			m_all.push_back(candidate);
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
