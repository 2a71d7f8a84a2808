// SPDX-License-Identifier: GPL-3.0-or-later
#include "bench/measurement_cache.h"

#include "bench/measurement_json.h"
#include "core/base64.h"
#include "core/error.h"
#include "core/file.h"

#include <cstring>
#include <filesystem>
#include <system_error>

namespace nook
{
namespace
{

constexpr const char* kSchema = "nook.measurement/1";

std::string textOf(std::span<const float> values)
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

// What a file of ours holds; discarded where there is none, another thing, or one that cannot be read.
nlohmann::json stored(const std::string& path)
{
	std::error_code ignored;
	if (path.empty() || !std::filesystem::exists(path, ignored))
	{
		return nlohmann::json::value_t::discarded;
	}
	try
	{
		nlohmann::json json = nlohmann::json::parse(readFile(path), nullptr, false);
		const bool ours = json.is_object() && json.contains("schema") && json["schema"] == kSchema;
		return ours ? json : nlohmann::json(nlohmann::json::value_t::discarded);
	}
	catch (const Error&)
	{
		return nlohmann::json::value_t::discarded; // cannot be read: what it held is measured again
	}
}

void store(const std::string& path, nlohmann::ordered_json json)
{
	if (!path.empty())
	{
		json["schema"] = kSchema;
		writeFile(path, json.dump() + "\n");
	}
}

} // namespace

MeasurementCache::MeasurementCache(const std::string& folder) : m_folder(folder)
{
	if (folder.empty())
	{
		return;
	}
	std::error_code problem;
	std::filesystem::create_directory(folder, problem);
	if (problem || !std::filesystem::is_directory(folder))
	{
		throw Error(ExitCode::file, folder + ": found " + (problem ? problem.message() : "a file") +
										", expected a folder for measurements, or a place for one");
	}
}

std::string MeasurementCache::pathOf(const std::string& hash) const
{
	return m_folder.empty() ? std::string() : (std::filesystem::path(m_folder) / (hash + ".json")).string();
}

std::optional<Measurement> MeasurementCache::measurement(const std::string& hash) const
{
	const nlohmann::json json = stored(pathOf(hash));
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
	const nlohmann::json json = stored(pathOf(hash));
	if (json.is_discarded() || !json.contains("number") || !json["number"].is_number())
	{
		return std::nullopt;
	}
	return json["number"].get<double>();
}

std::optional<Reference> MeasurementCache::reference(const std::string& hash, std::size_t pixels) const
{
	const nlohmann::json json = stored(pathOf(hash));
	if (json.is_discarded() || !json.contains("visibility") || !json["visibility"].is_string() || !json.contains("number") ||
		!json["number"].is_number())
	{
		return std::nullopt;
	}
	Reference reference{valuesOf(json["visibility"].get<std::string>()), json["number"].get<double>()};
	return reference.visibility.size() == pixels ? std::optional(reference) : std::nullopt;
}

void MeasurementCache::keep(const std::string& hash, const Measurement& measurement) const
{
	store(pathOf(hash), {{"measurement", measurementJson(measurement)}, {"visibility", textOf(measurement.visibility)}});
}

void MeasurementCache::keep(const std::string& hash, double number) const
{
	store(pathOf(hash), {{"number", number}});
}

void MeasurementCache::keep(const std::string& hash, const Reference& reference) const
{
	store(pathOf(hash), {{"number", reference.error}, {"visibility", textOf(reference.visibility)}});
}

} // namespace nook
