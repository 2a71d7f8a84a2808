// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of measurements that are done, one file each, named by the hash of all that they depend on.
#pragma once

#include "bench/measure_view.h"
#include "core/temporary_file.h"

#include <nlohmann/json.hpp>

#include <optional>
#include <string>

namespace nook
{

// An empty folder name: nothing is kept. Each file appears whole or not at all, with a checksum of its name and of what it holds;
// one that cannot be read, is of another version or was changed counts as none.
class MeasurementCache
{
public:
	// Makes the folder (its parent must exist); it goes again where nothing was kept. Throws Error (file).
	explicit MeasurementCache(const std::string& folder);

	std::optional<Measurement> measurement(const std::string& hash) const;
	std::optional<double> number(const std::string& hash) const;
	std::optional<Reference> reference(const std::string& hash, std::size_t pixels) const;

	// A measurement as it comes back from the cache, whose times have fewer digits: what a report should go on with either way.
	static Measurement asStored(Measurement measurement);

	// Replace what is there. Throw Error (file).
	void keep(const std::string& hash, const Measurement& measurement) const;
	void keep(const std::string& hash, double number) const;
	void keep(const std::string& hash, const Reference& reference) const;

private:
	std::string pathOf(const std::string& hash) const;
	nlohmann::json stored(const std::string& hash) const;
	void store(const std::string& hash, const nlohmann::ordered_json& entry) const;

	std::string m_folder;
	NewFolders m_new; // none stays where nothing was kept
};

} // namespace nook
