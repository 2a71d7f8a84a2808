// SPDX-License-Identifier: GPL-3.0-or-later
// What parts of a report keep for the merge: measured candidates, and the reference that each of them has traced.
#pragma once

#include "error_report/error_report.h"

#include <optional>
#include <string>
#include <string_view>

namespace nook
{

// A point, or why there is none; in a part neither where it is another's.
struct TriedPoint
{
	std::optional<ErrorPoint> point;
	std::string failure;
	double expected_s = 0.0; // above 0: it was stopped, since a picture would take so long
};

// Before it is measured.
ErrorPoint emptyPoint(const Candidate& candidate);

// `renderer`: this machine's. Times of one renderer beside errors of another would say nothing.
std::string savedPoint(const TriedPoint& tried, const std::string& renderer);

// False where savedPoint() writes no such bytes. Throws Error (invalid_input) where they are of another renderer.
bool loadPoint(std::string_view bytes, const std::string& renderer, const Candidate& candidate, std::size_t pixels,
			   TriedPoint& tried);

std::string savedNumber(const std::optional<double>& number);
bool loadNumber(std::string_view bytes, std::optional<double>& number);

std::string savedReference(const Reference& reference);
bool loadReference(std::string_view bytes, std::size_t pixels, Reference& reference);

} // namespace nook
