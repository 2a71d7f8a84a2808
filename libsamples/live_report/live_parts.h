// SPDX-License-Identifier: GPL-3.0-or-later
// The parts of the page's JSON, a function and a file each.
#pragma once

#include "bench/measure_view.h"
#include "core/base64.h"
#include "live_report/live_report.h"

#include <nlohmann/json.hpp>

#include <cstring>
#include <span>
#include <string>
#include <vector>

namespace nook
{

using LiveJson = nlohmann::ordered_json;

// Numbers as bytes, the least significant one first, as base64.
template <class T> std::string packed(std::span<const T> values)
{
	std::vector<uint8_t> bytes(values.size_bytes());
	if (!bytes.empty())
	{
		std::memcpy(bytes.data(), values.data(), bytes.size());
	}
	return base64Of(bytes);
}

template <class T> std::string packed(const std::vector<T>& values)
{
	return packed(std::span<const T>(values));
}

// {"worker": JavaScript, "wasm": base64}; appends what it reads.
LiveJson liveProgram(const LiveReportSettings& settings, std::vector<std::string>& read);

// Domain → variant → count → measure → its text, as nook info prints it; appends what it reads.
LiveJson liveCatalogue(const LiveReportSettings& settings, std::vector<std::string>& read);

// Triangles, depth, normals and what rays see.
LiveJson liveView(const LevelCamera& camera, const LevelBench& level, ViewBench& view);

// Every method with its samples, modules, passes and settings.
LiveJson liveModules(const LevelBench& level, const ViewBench& view, const std::string& version, const RunSettings& run);

} // namespace nook
