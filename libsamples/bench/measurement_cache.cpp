// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/measurement_cache.h"

#include "bench/measurement_json.h"
#include "core/base64.h"
#include "core/content_hash.h"
#include "core/error.h"
#include "core/file.h"
#include "core/json_text.h"

#include <cstring>
#include <filesystem>
#include <string_view>
#include <system_error>

namespace nook
{
namespace
{

// The text before, between and after the checksum and the entry.
constexpr std::string_view kBefore = R"({"schema":"nook.measurement/2","checksum":")";
constexpr std::string_view kBetween = R"(","entry":)";
constexpr std::string_view kAfter = "}\n";
constexpr std::size_t kDigits = 32; // of a checksum

// Of the name, too: an entry under another's name is none.
std::string textOf(const std::string& name, const std::string& entry)
{
	ContentHash checksum;
	checksum.add(name);
	checksum.add(entry);
	return std::string(kBefore) + checksum.text() + std::string(kBetween) + entry + std::string(kAfter);
}

// The entry of a text that textOf() made for that name; empty for any other, by as much as a byte.
std::string entryOf(const std::string& name, const std::string& text)
{
	const std::size_t first = kBefore.size() + kDigits + kBetween.size();
	if (text.size() < first + kAfter.size())
	{
		return {};
	}
	std::string entry = text.substr(first, text.size() - first - kAfter.size());
	return text == textOf(name, entry) ? entry : std::string();
}

std::string base64Text(std::span<const float> values)
{
	std::vector<uint8_t> bytes(values.size_bytes());
	std::memcpy(bytes.data(), values.data(), bytes.size());
	return base64Of(bytes);
}

std::vector<float> valuesOf(const std::string& text)
{
	const std::optional<std::vector<uint8_t>> bytes = bytesOfBase64(text);
	std::vector<float> values(bytes ? bytes->size() / sizeof(float) : 0);
	if (!values.empty())
	{
		std::memcpy(values.data(), bytes->data(), values.size() * sizeof(float));
	}
	return values;
}

} // namespace

MeasurementCache::MeasurementCache(const std::string& folder) : m_folder(folder)
{
	if (folder.empty())
	{
		return;
	}
	std::error_code problem;
	const std::filesystem::path above = (std::filesystem::absolute(folder) / "").parent_path().parent_path(); // of "cache/", too
	if (std::filesystem::is_directory(above, problem))
	{
		m_new.make(folder, problem);
	}
	if (problem || !std::filesystem::is_directory(folder))
	{
		throw Error(ExitCode::file, folder + ": found " + (problem ? problem.message() : "a file") +
										", expected a folder for measurements, or a place for one");
	}
}

std::string MeasurementCache::pathOf(const std::string& hash) const
{
	return (std::filesystem::path(m_folder) / (hash + ".json")).string();
}

// Discarded where there is none, or one that was not written as it is.
nlohmann::json MeasurementCache::stored(const std::string& hash) const
{
	std::error_code ignored;
	if (m_folder.empty() || !std::filesystem::exists(pathOf(hash), ignored))
	{
		return nlohmann::json::value_t::discarded;
	}
	try
	{
		return looseJson(entryOf(hash, readFile(pathOf(hash))));
	}
	catch (const Error&)
	{
		return nlohmann::json::value_t::discarded; // cannot be read: what it held is measured again
	}
}

void MeasurementCache::store(const std::string& hash, const nlohmann::ordered_json& entry) const
{
	if (!m_folder.empty())
	{
		writeFile(pathOf(hash), textOf(hash, jsonLine(entry)));
	}
}

std::optional<Measurement> MeasurementCache::measurement(const std::string& hash) const
{
	const nlohmann::json json = stored(hash);
	if (json.is_discarded())
	{
		return std::nullopt;
	}
	try
	{
		const std::string path;
		const JsonValue root{&json, &path, ""};
		Measurement measurement = measurementFrom(root.at("measurement"));
		measurement.visibility = valuesOf(root.at("visibility").string());
		return measurement;
	}
	catch (const Error&)
	{
		return std::nullopt;
	}
}

std::optional<double> MeasurementCache::number(const std::string& hash) const
{
	const nlohmann::json json = stored(hash);
	if (json.is_discarded() || !json.contains("number") || !json["number"].is_number())
	{
		return std::nullopt;
	}
	return json["number"].get<double>();
}

std::optional<Reference> MeasurementCache::reference(const std::string& hash, std::size_t pixels) const
{
	const nlohmann::json json = stored(hash);
	if (json.is_discarded() || !json.contains("visibility") || !json["visibility"].is_string() || !json.contains("number") ||
		!json["number"].is_number())
	{
		return std::nullopt;
	}
	Reference reference{valuesOf(json["visibility"].get<std::string>()), json["number"].get<double>()};
	return reference.visibility.size() == pixels ? std::optional(reference) : std::nullopt;
}

Measurement MeasurementCache::asStored(Measurement measurement)
{
	const nlohmann::json json = measurementJson(measurement);
	const std::string path;
	Measurement rounded = measurementFrom({&json, &path, ""});
	rounded.visibility = std::move(measurement.visibility);
	return rounded;
}

void MeasurementCache::keep(const std::string& hash, const Measurement& measurement) const
{
	store(hash, {{"measurement", measurementJson(measurement)}, {"visibility", base64Text(measurement.visibility)}});
}

void MeasurementCache::keep(const std::string& hash, double number) const
{
	store(hash, {{"number", number}});
}

void MeasurementCache::keep(const std::string& hash, const Reference& reference) const
{
	store(hash, {{"number", reference.error}, {"visibility", base64Text(reference.visibility)}});
}

} // namespace nook
