// SPDX-License-Identifier: GPL-3.0-or-later
// Statistical volumetric obscurance: its row, its options, and the passes before its own: ranges, tables, and where layers are not
// needed.
#include "core/error.h"
#include "methods/feature_parts.h"
#include "methods/method_table.h"
#include "methods/runtime/nook_block.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <string>

namespace nook
{
namespace
{

using namespace feature_parts;
using shade_kernels::Kernels;

constexpr int kTile = 8; // pixels; same value in statvo_tables.glsl and statvo_flags.glsl
constexpr int kTaps = 8; // of nookTableSum
constexpr int kEntryBytes = 16;
constexpr std::int64_t kMostBytes = std::int64_t(4) << 30;

int partsOf(int length, int part)
{
	return (length + part - 1) / part;
}

// Adaptive layers without those obtained as differences, SVO §7.2.
int tablesOf(const StatVoSettings& settings)
{
	return settings.layers;
}

class StatVoPlanner
{
public:
	StatVoPlanner(ShadePlan& plan, const ShadeBlock& block, const StatVoSettings& settings, bool compute)
		: m_plan(plan), m_settings(settings), m_compute(compute), m_block(block), m_width(block.last.x - block.first.x + 1),
		  m_height(block.last.y - block.first.y + 1)
	{
	}

	void add(ShadePass& method)
	{
		m_range = addRange();
		const std::size_t tables = addTables();
		method.reads.push_back({ShadeSlot::range, m_range});
		method.reads.push_back({ShadeSlot::tables, tables});
		if (m_settings.skip && m_settings.layers > 1)
		{
			method.reads.push_back({ShadeSlot::levels, addFlags()});
			m_block.skip = 1;
		}
		method.block = m_block;
	}

private:
	ShadePass& addPass(const ShadeKernel& kernel, const std::vector<ShadeRead>& reads, std::size_t picture)
	{
		return m_plan.addPass(kernel, reads, picture, m_block);
	}

	std::size_t addRange()
	{
		int width = partsOf(m_width, kTile);
		int height = partsOf(m_height, kTile);
		std::size_t picture = m_plan.addPicture({PictureFormat::quad, 2 * width, height});
		addPass({"range", "nookStatRange", &Kernels::nookStatRange}, {}, picture);
		while (width > 1 || height > 1)
		{
			m_block.range_width = width;
			m_block.range_height = height;
			width = partsOf(width, kTile);
			height = partsOf(height, kTile);
			const std::size_t next = m_plan.addPicture({PictureFormat::quad, 2 * width, height});
			addPass({"range", "nookStatRangeUp", &Kernels::nookStatRangeUp}, {{ShadeSlot::levels, picture}}, next);
			picture = next;
		}
		const std::size_t frame = m_plan.addPicture({PictureFormat::quad, 2, 1});
		addPass({"frame", "nookStatFrame", &Kernels::nookStatFrame}, {{ShadeSlot::levels, picture}}, frame);
		return frame;
	}

	std::size_t addTables()
	{
		PictureShape shape{PictureFormat::counts, partsOf(m_width, m_settings.cell_px) + 1,
						   partsOf(m_height, m_settings.cell_px) + 1, 1, 1};
		m_scratch = {m_plan.addPicture(shape), m_plan.addPicture(shape)};
		shape.layers = tablesOf(m_settings);
		const std::size_t tables = m_plan.addPicture(shape);
		for (int table = 0; table < shape.layers; ++table)
		{
			m_block.table = table;
			// The first one needs no table, but OpenGL requires one of the right kind.
			const std::vector<ShadeRead> reads{{ShadeSlot::range, m_range}, {ShadeSlot::tables, tables}};
			addPass({"cells " + std::to_string(table), "nookStatCells", &Kernels::nookStatCells}, reads, m_scratch[0]);
			addSums(shape, tables, table);
		}
		return tables;
	}

	// Sums from the first scratch picture into a layer of the tables.
	void addSums(const PictureShape& shape, std::size_t tables, int table)
	{
		struct Step
		{
			int axis;
			int stride;
		};
		std::vector<Step> steps;
		for (const int axis : {0, 1})
		{
			const int length = axis == 0 ? shape.width : shape.height;
			for (int stride = 1; stride < (m_compute ? 2 : length); stride *= kTaps)
			{
				steps.push_back({axis, stride});
			}
		}
		for (std::size_t i = 0; i < steps.size(); ++i)
		{
			m_block.stride = steps[i].stride;
			m_block.axis = steps[i].axis;
			const bool last = i + 1 == steps.size();
			const std::string name = std::string(steps[i].axis == 0 ? "sums x " : "sums y ") + std::to_string(table);
			ShadePass& pass = addPass({name, "nookTableSum", &Kernels::nookTableSum}, {{ShadeSlot::tables, m_scratch[i % 2]}},
									  last ? tables : m_scratch[(i + 1) % 2]);
			pass.layer = last ? table : 0;
			pass.scans = m_compute;
		}
	}

	std::size_t addFlags()
	{
		const int width = partsOf(m_width, kTile);
		const int height = partsOf(m_height, kTile);
		int levels = 1;
		while (std::max(width, height) >> levels > 0)
		{
			levels += 1;
		}
		const std::size_t slopes = m_plan.addPicture({PictureFormat::quad, width, height, levels});
		addPass({"slopes", "nookStatSlopes", &Kernels::nookStatSlopes}, {}, slopes);
		for (int level = 1; level < levels; ++level)
		{
			m_block.level = level;
			addPass({"slopes", "nookStatSlopesUp", &Kernels::nookStatSlopesUp}, {{ShadeSlot::levels, slopes}}, slopes).level =
				level;
		}
		const std::size_t flags = m_plan.addPicture({PictureFormat::scalar, width, height});
		addPass({"flags", "nookStatFlags", &Kernels::nookStatFlags}, {{ShadeSlot::levels, slopes}}, flags);
		return flags;
	}

	ShadePlan& m_plan;
	const StatVoSettings& m_settings;
	bool m_compute;
	ShadeBlock m_block;
	int m_width;
	int m_height;
	std::size_t m_range = 0;
	std::array<std::size_t, 2> m_scratch{};
};

void fillStatVo(ShadeBlock& block, const ShadeSettings& settings)
{
	const StatVoSettings& statvo = settings.statvo;
	assert(statvo.height > 0.0 && statvo.slope > 0.0 && statvo.largest_px > 0);
	const int longer = std::max(block.last.x - block.first.x, block.last.y - block.first.y) + 1;
	block.box_height = static_cast<float>(statvo.height);
	block.slope = static_cast<float>(statvo.slope);
	block.largest_px = static_cast<float>(statvo.largest_px);
	block.least_box_px = static_cast<float>(nook_least_box(longer, statvo.largest_px, statvo.height));
	block.layers = statvo.layers;
	block.uniform_layers = statvo.layering == StatVoLayering::uniform ? 1 : 0;
	block.quadrants = statvo.quadrants ? 1 : 0;
	block.table_cell = statvo.cell_px;
}

// Appends the passes and their pictures, and makes `method` read them. Throws Error (unsupported) for tables larger than 4 GiB.
void addStatVo(ShadePlan& plan, ShadePass& method, const ShadeBlock& block, const ShadeSettings& shade, bool compute)
{
	const StatVoSettings& settings = shade.statvo;
	const std::int64_t width = partsOf(block.last.x - block.first.x + 1, settings.cell_px) + 1;
	const std::int64_t height = partsOf(block.last.y - block.first.y + 1, settings.cell_px) + 1;
	const std::int64_t bytes = width * height * kEntryBytes * (tablesOf(settings) + 2);
	refuseIf(bytes > kMostBytes,
			 "tables: found " + std::to_string(bytes >> 20) + " MiB of " + std::to_string(settings.layers) +
				 " layers, expected at most " + std::to_string(kMostBytes >> 20),
			 ExitCode::unsupported);
	StatVoPlanner(plan, block, settings, compute).add(method);
}

// Describes the passes for users of a module: which functions draw which pictures, one per line.
std::string statVoPassesText(const ShadeSettings& settings)
{
	const StatVoSettings& statvo = settings.statvo;
	const std::string cell = std::to_string(statvo.cell_px);
	const bool twice = statvo.layers > 1 && statvo.layering == StatVoLayering::adaptive;
	return "width and height below are those of all pixels that hold depth, guard band included:\n"
		   "nookStatRange(texel): RGBA32F, 2 ceil(width / 8) x ceil(height / 8); 64 depth reads per texel\n"
		   "nookStatRangeUp(texel), again and again until the picture is 2 x 1: RGBA32F, 2 ceil(w / 8) x ceil(h / 8); reads the "
		   "picture\n"
		   "    before as nook_levels; nook_pass.xy = (w, h), where that picture has 2 w x h texels\n"
		   "nookStatFrame(texel): RGBA32F, 2 x 1; reads the last of these as nook_levels; later passes read it as nook_range\n"
		   "for each table t from 0 to " +
		   std::to_string(statvo.layers - 1) + ":\n    nookStatCells(texel): RGBA32UI, ceil(width / " + cell +
		   ") + 1 x ceil(height / " + cell + ") + 1; nook_pass.z = t; reads the tables so far as nook_tables;\n        " +
		   (twice ? "1 depth read per pixel for t = 0, 2 for others\n" : "1 depth read per pixel\n") +
		   "    nookTableSum(texel): same size; reads the picture before as layer 0 of nook_tables; for axis 0, then for axis 1, "
		   "with the\n"
		   "        strides 1, 8, 64, ... below the length of that side; nook_pass.xy = (stride, axis); the last one is layer t of "
		   "nook_tables\n" +
		   (!statvo.skip || statvo.layers == 1
				? ""
				: "nookStatSlopes(texel): level 0 of a picture RGBA32F, ceil(width / 8) x ceil(height / 8), with all mip levels; "
				  "256 depth reads per texel\n"
				  "nookStatSlopesUp(texel): its other levels, each from the one before as nook_levels; nook_pass.x = level\n"
				  "nookStatFlags(texel): R32F, ceil(width / 8) x ceil(height / 8); reads that picture as nook_levels; 64 depth "
				  "reads per texel;\n"
				  "    the next pass reads this one as nook_levels\n");
}

// "4 adaptive layers, full tables": for notes and summaries.
std::string layersText(const ShadeSettings& settings)
{
	const StatVoSettings& statvo = settings.statvo;
	return std::to_string(statvo.layers) + " " + valueText(featureOf("--layering"), settings) +
		   (statvo.layers == 1 ? " layer, " : " layers, ") + valueText(featureOf("--tables"), settings) + " tables" +
		   (statvo.quadrants ? ", quadrants" : "");
}

int setBestLayers(ShadeSettings& settings)
{
	settings.statvo = {};
	settings.statvo.quadrants = true;
	settings.statvo.skip = false;
	return settings.statvo.layers;
}

using T = StatVoSettings;

std::vector<FeatureRow> layerOptions()
{
	std::vector<FeatureRow> rows;
	FeatureRow& layers = addWhole(rows, 0, "--layers", 1, 64, member<&S::statvo, &T::layers>(),
								  "StatVO: layers of depth, 1, 2 or 4 (default); uniform: 1 to 64");
	layers.places = kInShade | kInEmit;
	layers.range = "1, 2, 4; uniform: 1 to 64";
	layers.stated = true;
	addChoice(rows, 0, "--layering", {"adaptive", "uniform"}, member<&S::statvo, &T::layering>(),
			  "StatVO: adaptive (default), by the mean depth around each pixel; or uniform, equal parts of the picture's "
			  "depths")
		.word = [](const S& s)
	{
		return std::string(s.statvo.layering == StatVoLayering::uniform ? "uniform" : "");
	};
	addFlag(rows, 0, "--quadrants", member<&S::statvo, &T::quadrants>(),
			"StatVO: evaluates four parts of the box separately; better but more expensive")
		.word = wordIf<"quadrants", &S::statvo, &T::quadrants>;
	addChoice(rows, 0, "--tables", {"full", "half", "quarter"},
			  {[](const S& s) { return static_cast<double>(s.statvo.cell_px / 2); },
			   [](S& s, double i)
			   {
				   s.statvo.cell_px = 1 << static_cast<int>(i);
			   }},
			  "StatVO: summed-area tables of full (default), half or quarter width and height")
		.word = [](const S& s)
	{
		return s.statvo.cell_px > 1 ? "cells-" + std::to_string(s.statvo.cell_px) : std::string();
	};
	addNumber(rows, 0, "--slope", 1e-3, 1e3, "per height", member<&S::statvo, &T::slope>(),
			  "StatVO: how fast surfaces farther in front than the box height stop counting, per height (default 1)");
	addNumber(rows, 0, "--height", 0.05, 100.0, "radii", member<&S::statvo, &T::height>(),
			  "StatVO: height of the box above the surface, in radii (default 1)");
	addWhole(rows, 0, "--largest", 1, 255, member<&S::statvo, &T::largest_px>(),
			 "StatVO: maximum half side of the box in pixels, which limits boxes near the camera; larger values need coarser "
			 "tables (default 127)")
		.unit = "px";
	addChoice(rows, 0, "--skip", kYesNo, yesNo<&S::statvo, &T::skip>(),
			  "StatVO: skips layers where the surface is smooth, without visible change (default yes)")
		.word = wordIf<"skip", &S::statvo, &T::skip>;
	addChoice(rows, 0, "--tables-by", {"automatic", "compute", "fragments"}, member<&S::statvo, &T::builder>(),
			  "StatVO, --device gl: sums by compute shaders or by fragments; automatic (default): compute shaders if the "
			  "GPU supports them")
		.places = kInShade;
	return rows;
}

// Adaptive layers with tables at full, half and quarter resolution, four quadrants; no filter.
CandidateAxes layers(Origin origin, const std::vector<int>& counts, const std::vector<int>& cells,
					 const std::vector<bool>& quadrants)
{
	CandidateAxes axes{.origin = origin, .counts = counts};
	axes.forms.clear();
	for (const int cell_px : cells)
	{
		for (const bool four : quadrants)
		{
			ShadeSettings form;
			form.statvo.cell_px = cell_px;
			form.statvo.quadrants = four;
			form.statvo.skip = origin == Origin::ours;
			axes.forms.push_back(form);
		}
	}
	return axes;
}

// SVO: 1, 2 or 4 layers. Ours skip layers, which does not apply to a single one.
std::vector<CandidateAxes> axesOfLayers(GridSize size)
{
	std::vector<CandidateAxes> all;
	if (size == GridSize::quick)
	{
		for (const Origin origin : {Origin::paper, Origin::ours})
		{
			all.push_back(layers(origin, {2}, {2}, {false}));
			all.push_back(layers(origin, {4}, {1, 2}, {false}));
		}
		return all;
	}
	const std::vector<int> cells{1, 2, 4};
	const std::vector<bool> quadrants{false, true};
	all.push_back(layers(Origin::paper, {1}, cells, quadrants));
	all.back().only_form = true;
	all.push_back(layers(Origin::paper, {2, 4}, cells, quadrants));
	all.push_back(layers(Origin::ours, {2, 4}, cells, quadrants));
	return all;
}

} // namespace

std::vector<MethodRow> statVoRows()
{
	return {
		{.name = "statvo",
		 .what = "statistical volumetric obscurance",
		 .page = "statvo.md",
		 .emitted = true,
		 .features = kOfNormals,
		 .options = layerOptions(),
		 .radius_ratio = kVolumetricRatio,
		 .axes = axesOfLayers,
		 // It uses all pixels instead of samples: its kernel reads no values.
		 .own_samples =
			 [](const ShadeSettings&) {
				 return ShadeSamples{1, 1, {glm::vec4(0.0F)}};
			 },
		 .set_count = [](ShadeSettings& settings, int count) { settings.statvo.layers = count; },
		 .layers_text = layersText,
		 .set_best = setBestLayers,
		 .kernel = {"statvo", "nookStatVo", &Kernels::nookStatVo},
		 .sample_depths = [](const ShadeSettings&) { return 0; }, // beside the pixel's own, whatever the layers
		 .add_passes = addStatVo,
		 .passes_text = statVoPassesText,
		 .fill = fillStatVo,
		 .layers_view = {"layers", "nookDebugLayers", &Kernels::nookDebugLayers}},
	};
}

} // namespace nook
