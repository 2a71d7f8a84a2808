// SPDX-License-Identifier: GPL-3.0-or-later
#include "emit_volumes.h"

#include "summary.h"
#include "volume_methods.h"

#include "core/error.h"
#include "core/file.h"
#include "emit/module_volumes.h"
#include "version.h"

namespace nook
{
namespace
{

void refuseWith(const CLI::Option* option, const std::string& method)
{
	if (option != nullptr && option->count() > 0)
	{
		throw Error(ExitCode::usage, option->get_name() + ": found with " + method + ", expected a screen-space method");
	}
}

} // namespace

bool isOfVolumes(const EmitOptions& options)
{
	const MethodRow* const row = methodNamed(options.methods);
	return row != nullptr && row->kind == MethodKind::volumes;
}

void emitVolumes(const EmitOptions& options, const CLI::App& app)
{
	checkOutputs(options.outputs, kModuleFormats, {});
	const bool mask = methodNamed(options.methods)->masks;
	for (const char* const name : {"--patterns", "--counts", "--recipe"})
	{
		refuseWith(app.get_option(name), options.methods);
	}
	for (const CLI::Option* const option :
		 {options.tile, options.normals, options.block, options.space, options.gather, options.main})
	{
		refuseWith(option, options.methods);
	}
	for (const FeatureOption& feature : options.features)
	{
		refuseWith(feature.option, options.methods);
	}
	checkDirections(*options.directions_option, options.directions, mask);
	const GlslTarget target = options.settings.target;
	if (options.glsl->count() == 0 || !drawsVolumes(target))
	{
		const std::string found =
			options.glsl->count() == 0 ? "none" : std::string(glslTargets()[static_cast<std::size_t>(target)]);
		throw Error(ExitCode::usage, "--glsl: found " + found + ", expected 330 or 430 for " + options.methods);
	}
	std::string command = "nook emit --methods " + options.methods;
	command += options.settings.device_depth ? " --depth device" : "";
	command += options.directions_option->count() > 0 ? " --directions " + std::to_string(options.directions) : "";
	command += " --glsl " + std::string(glslTargets()[static_cast<std::size_t>(target)]);
	const AovTextSettings text{target == GlslTarget::gl430, mask ? options.directions : 0, options.settings.device_depth};
	OutputSet files;
	for (const std::string& path : options.outputs.files)
	{
		if (!isGlsl(path))
		{
			throw Error(ExitCode::usage, path + ": found " + (isScript(path) ? "a script" : "a header") +
											 ", expected a .glsl file alone: nook_volumes_draw.h fills the block");
		}
		files.add(path, volumesGlsl(text, {command, NOOK_VERSION, {}, {}}));
	}
	Summary summary("emit");
	summary.text("command", command);
	summary.text("method", options.methods);
	addSide(files, options.outputs, summary.json(), {});
	files.commit();
}

} // namespace nook
