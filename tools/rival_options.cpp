// SPDX-License-Identifier: GPL-3.0-or-later
#include "rival_options.h"

#include "options.h"

#include "core/error.h"

namespace nook
{

std::vector<RivalOption> addRivalOptions(CLI::App& app, RivalSettings& settings)
{
	const auto crytek = [](CLI::Option* option)
	{
		return RivalOption{option, ShadeMethod::crytek, "crytek"};
	};
	const auto hbao = [](CLI::Option* option)
	{
		return RivalOption{option, ShadeMethod::hbao, "hbao"};
	};
	const auto sao = [](CLI::Option* option)
	{
		return RivalOption{option, ShadeMethod::sao, "sao"};
	};
	return {
		crytek(addNumber(app, "--crytek-range", settings.range, 1e-3, 1e6,
						 "crytek: what is that many radii in front counts as 1/2 (default 2.7)")),
		hbao(addWhole(app, "--hbao-directions", settings.directions, 1, 64, "hbao: directions in the picture (default 6)")),
		hbao(addWhole(app, "--hbao-steps", settings.steps, 1, 64, "hbao: steps along each direction (default 6)")),
		hbao(addNumber(app, "--hbao-angle-bias", settings.angle_bias_deg, 0.0, 89.0,
					   "hbao: degrees over the tangent plane that count for nothing (default 30)")),
		hbao(addNumber(app, "--hbao-strength", settings.strength, 1e-6, 1e6, "hbao: factor of the obscurance (default 1)")),
		sao(addWhole(app, "--sao-samples", settings.spiral_samples, 1, 256, "sao: samples of the spiral (default 11)")),
		sao(addWhole(app, "--sao-turns", settings.spiral_turns, 1, 256, "sao: turns of the spiral (default 7)")),
		sao(addNumber(app, "--sao-intensity", settings.intensity, 1e-6, 1e6,
					  "sao: factor of the obscurance, with lengths in units of the radius (default 1)")),
		sao(addNumber(app, "--sao-bias", settings.bias, 0.0, 1.0,
					  "sao: height over the tangent plane that counts for nothing, in radii (default 0.012)")),
		sao(addNumber(app, "--sao-epsilon", settings.epsilon, 1e-12, 1e6,
					  "sao: keeps the quotient finite, in squares of the radius (default 0.01)")),
		sao(addWhole(app, "--sao-levels", settings.levels, 0, 8, "sao: coarser depths for samples that are far away (default 5)"))};
}

void checkRivalOptions(const std::vector<RivalOption>& options, ShadeMethod method)
{
	for (const RivalOption& rival : options)
	{
		if (rival.option->count() > 0 && rival.method != method)
		{
			throw Error(ExitCode::usage, rival.option->get_name() + ": found with another method, expected --method " +
											 std::string(rival.method_name));
		}
	}
}

} // namespace nook
