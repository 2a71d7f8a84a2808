// SPDX-License-Identifier: GPL-3.0-or-later
// The command that measures a report again.
#include "study/command_words.h"
#include "study/error_report.h"

#include "core/decimal.h"

#include <filesystem>

namespace nook
{

std::string errorReportCommand(const ErrorReportSettings& settings)
{
	const ErrorReportSettings defaults;
	std::string text = "nook report error";
	for (const std::string& level : settings.levels)
	{
		text += " " + shellWord(level.starts_with("builtin:") ? level : std::filesystem::path(level).filename().string());
	}
	text += loadOptions(settings.load) + " --grid " + std::string(nameOf(settings.grid));
	for (const std::string& method : settings.methods)
	{
		text += (&method == &settings.methods.front() ? " --methods " : ",") + method;
	}
	text += settings.automatic > 0    ? " --camera auto:" + std::to_string(settings.automatic)
			: settings.camera.empty() ? ""
									  : " --camera " + shellWord(settings.camera);
	text += " --size " + std::to_string(settings.width_px) + "x" + std::to_string(settings.height_px) + " --rays " +
			std::to_string(settings.rays);
	text += settings.radius_m > 0.0 ? " --radius " + numberText(settings.radius_m) : "";
	text += " --repetitions " + std::to_string(settings.measure.repetitions);
	text += settings.measure.device == Device::cpu ? " --device cpu" : "";
	text += settings.measure.gl_device ? " --gl-device " + std::to_string(*settings.measure.gl_device) : "";
	text += settings.pictures != defaults.pictures ? " --pictures " + std::to_string(settings.pictures) : "";
	text += settings.frames > 0 ? " --frames " + std::to_string(settings.frames) + " --ema " + numberText(settings.ema) : "";
	text += settings.measure.slowest_s != kSlowestPicture_s ? " --slowest " + numberText(settings.measure.slowest_s) : "";
	text += settings.shifts != defaults.shifts ? " --shifts " + std::to_string(settings.shifts) : "";
	return text;
}

} // namespace nook
