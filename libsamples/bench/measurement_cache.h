// SPDX-License-Identifier: GPL-3.0-or-later
// A folder of measurements that are done, one file each, named by the hash of all that they depend on.
#pragma once

#include "bench/measure_view.h"

#include <optional>
#include <string>

namespace nook
{

// An empty folder name: nothing is kept. Each file appears whole or not at all; one that cannot be read or understood counts as
// none.
class MeasurementCache
{
public:
	// Makes the folder (its parent must exist). Throws Error (file).
	explicit MeasurementCache(const std::string& folder);

	std::optional<Measurement> measurement(const std::string& hash) const;
	std::optional<double> number(const std::string& hash) const;
	std::optional<Reference> reference(const std::string& hash, std::size_t pixels) const;

	// Throw Error (file).
	void keep(const std::string& hash, const Measurement& measurement) const;
	void keep(const std::string& hash, double number) const;
	void keep(const std::string& hash, const Reference& reference) const;

private:
	std::string pathOf(const std::string& hash) const;

	std::string m_folder;
};

} // namespace nook
