// SPDX-License-Identifier: GPL-3.0-or-later
// Errors between pictures.
#pragma once

#include "testing.h"

#include "scene/reference.h"

namespace nook::test
{

inline double numberOf(float value)
{
	return static_cast<double>(value);
}
inline double numberOf(const ReferenceValue& value)
{
	return value.visibility;
}

// Root mean squared difference of pictures of visibility, or of references.
template <class A, class B> double rmseOf(const std::vector<A>& a, const std::vector<B>& b)
{
	REQUIRE(a.size() == b.size());
	double squares = 0.0;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		const double difference = numberOf(a[i]) - numberOf(b[i]);
		squares += difference * difference;
	}
	return std::sqrt(squares / static_cast<double>(a.size()));
}

struct Difference
{
	double mean = 0.0;
	double signed_mean = 0.0;
	double worst = 0.0;
	double beyond = 0.0; // fraction of the pixels that differ by more than 1/255
};

inline Difference differenceOf(const std::vector<float>& a, const std::vector<float>& b)
{
	REQUIRE(a.size() == b.size());
	Difference result;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		const auto d = static_cast<double>(a[i] - b[i]);
		result.mean += std::fabs(d) / static_cast<double>(a.size());
		result.signed_mean += d / static_cast<double>(a.size());
		result.worst = std::fmax(result.worst, std::fabs(d));
		result.beyond += std::fabs(d) <= 1.0 / 255.0 ? 0.0 : 1.0 / static_cast<double>(a.size());
	}
	return result;
}

// One picture drawn in two ways: close everywhere, except for one pixel in a thousand, where a comparison may go either way.
inline void checkSamePicture(const std::vector<float>& a, const std::vector<float>& b, double most_off = 1e-3)
{
	REQUIRE(a.size() == b.size());
	double sum = 0.0;
	std::size_t off = 0;
	for (std::size_t i = 0; i < a.size(); ++i)
	{
		const double difference = std::fabs(static_cast<double>(a[i] - b[i]));
		sum += difference;
		off += difference <= 1.0 / 255.0 ? 0U : 1U;
	}
	CHECK(sum / static_cast<double>(a.size()) <= 1e-4);
	CHECK(static_cast<double>(off) <= most_off * static_cast<double>(a.size()));
}

} // namespace nook::test
