// SPDX-License-Identifier: GPL-3.0-or-later
// Options of nook bake that have to do with occlusion volumes which are drawn as well: what is baked is the difference to them.
#pragma once

#include "summary.h"

#include "bake/bake.h"
#include "scene/baked_values.h"
#include "volume/evaluate.h"

#include <CLI/CLI.hpp>

#include <memory>
#include <string>

namespace nook
{

struct BesideOptions
{
	std::string path; // of the volumes; empty: none
	bool mask = false;
	int directions = 128;
	CLI::Option* method = nullptr;
	CLI::Option* directions_option = nullptr;
};

// --volumes, --volumes-by, --directions
void addBesideOptions(CLI::App& app, BesideOptions& options);

// Before any work. Throws Error (usage).
void checkBeside(const BesideOptions& options);

// Volumes that are read, for as long as a bake asks for them.
class Beside
{
public:
	// Reads the file. Requires a path.
	Beside(const BesideOptions& options, const RunSettings& run);

	double visibilityAt(glm::dvec3 position, glm::dvec3 normal) const;

private:
	BesideOptions m_options;
	VolumeSet m_volumes;
	std::unique_ptr<VolumeEvaluator> m_evaluator;
};

BakedKind kindOf(const BesideOptions& options);

} // namespace nook
