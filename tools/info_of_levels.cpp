// SPDX-License-Identifier: GPL-3.0-or-later
#include "info_of_levels.h"

#include "image_info.h"
#include "level_info.h"
#include "volume_info.h"

#include "core/file.h"
#include "volume/volume_glb.h"

namespace nook
{
namespace
{

// A level may have the same ending.
bool isVolumes(const std::string& path)
{
	return path.ends_with(".glb") && holdsVolumes(readFile(path));
}

} // namespace

bool describeOfLevels(const InfoOptions& options, const RunSettings& settings, Answer& answer)
{
	if (isVolumes(options.file))
	{
		refuseGiven({options.domain_given}, "a pattern without a domain");
		refuseGiven(options.load_given, "a level");
		VolumeFileFacts facts;
		const VolumeSet volumes = readVolumes(options.file, facts);
		answer.lines = describeVolumes(volumes, facts, answer.summary);
	}
	else if (isLevelName(options.file))
	{
		refuseGiven({options.domain_given}, "a pattern without a domain");
		const LoadedLevel loaded = loadLevel(options.file, options.load, settings);
		checkRead({{}, options.json, {}, options.progress}, loaded.level.files);
		const ProgressCounter stage(settings.progress, "advice");
		answer.lines = describeLevel(loaded, settings.threads, answer.summary);
	}
	else if (isImageName(options.file))
	{
		refuseGiven({options.domain_given}, "a pattern without a domain");
		refuseGiven(options.load_given, "a level");
		answer.lines = describeImage(readImage(options.file), answer.summary);
	}
	else
	{
		return false;
	}
	return true;
}

} // namespace nook
