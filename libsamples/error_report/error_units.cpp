// SPDX-License-Identifier: GPL-3.0-or-later
#include "error_report/error_units.h"

#include "bench/measurement_json.h"
#include "core/byte_text.h"
#include "core/error.h"
#include "core/json_reader.h"
#include "core/json_text.h"

#include <vector>

namespace nook
{
namespace
{

void saveFloats(ByteWriter& out, const std::vector<float>& values)
{
	out.whole(values.size());
	for (const float value : values)
	{
		out.number(value);
	}
}

std::vector<float> loadFloats(ByteReader& in)
{
	std::vector<float> values(in.count(sizeof(float)));
	for (float& value : values)
	{
		value = in.single();
	}
	return values;
}

} // namespace

ErrorPoint emptyPoint(const Candidate& candidate)
{
	return {candidate.name(),
			candidate.method(),
			candidate.origin,
			candidate.count,
			candidate.resolution(),
			candidate.scale,
			{},
			{},
			false,
			{},
			candidate};
}

std::string savedPoint(const TriedPoint& tried, const std::string& renderer)
{
	ByteWriter out;
	out.text(renderer);
	out.text(tried.failure);
	out.number(tried.expected_s);
	out.text(tried.point ? jsonLine(measurementJson(tried.point->measured)) : "");
	saveFloats(out, tried.point ? tried.point->measured.visibility : std::vector<float>());
	return out.take();
}

bool loadPoint(std::string_view bytes, const std::string& renderer, const Candidate& candidate, std::size_t pixels,
			   TriedPoint& tried)
{
	ByteReader in(bytes);
	if (const std::string found = in.text(); found != renderer)
	{
		throw Error(ExitCode::invalid_input, "merge: found a part measured on " + found + ", expected " + renderer + " as here");
	}
	tried.failure = in.text();
	tried.expected_s = in.number();
	const std::string text = in.text();
	std::vector<float> visibility = loadFloats(in);
	if (!in.isAtEnd() || text.empty() == tried.failure.empty())
	{
		return false;
	}
	if (tried.failure.empty())
	{
		const std::string path = "a part's measurement";
		const nlohmann::json json = parseJson(text, path);
		tried.point = emptyPoint(candidate);
		tried.point->measured = measurementFrom({&json, &path, ""});
		tried.point->measured.visibility = std::move(visibility);
		return tried.point->measured.visibility.size() == pixels && tried.point->measured.candidate == tried.point->name;
	}
	return true;
}

std::string savedNumber(const std::optional<double>& number)
{
	ByteWriter out;
	out.byte(number ? 1 : 0);
	out.number(number.value_or(0.0));
	return out.take();
}

bool loadNumber(std::string_view bytes, std::optional<double>& number)
{
	ByteReader in(bytes);
	const bool any = in.byte() != 0;
	const double value = in.number();
	number = any ? std::optional(value) : std::nullopt;
	return in.isAtEnd();
}

std::string savedReference(const Reference& reference)
{
	ByteWriter out;
	out.number(reference.error);
	saveFloats(out, reference.visibility);
	return out.take();
}

bool loadReference(std::string_view bytes, std::size_t pixels, Reference& reference)
{
	ByteReader in(bytes);
	reference.error = in.number();
	reference.visibility = loadFloats(in);
	return in.isAtEnd() && reference.visibility.size() == pixels;
}

} // namespace nook
