// SPDX-License-Identifier: GPL-3.0-or-later
// One case of a stress run: its own random numbers, what the kernel returned, and what the twin says of it.
#pragma once

#include "core/random.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace nook::stress
{

// What one case says of itself when it is shown: a line a value.
class CaseNotes
{
public:
	void add(std::string_view name, double value);
	void add(std::string_view name, long double value);
	void add(std::string_view name, int value);
	void add(std::string_view name, std::string_view value);
	void add(std::string_view name, const glm::vec2& value);
	void add(std::string_view name, const glm::vec3& value);
	void add(std::string_view name, const glm::vec4& value);
	void add(std::string_view name, const glm::dvec3& value);
	void add(std::string_view name, const glm::ivec2& value);
	void add(std::string_view name, const glm::ivec4& value);

	const std::string& text() const
	{
		return m_text;
	}

private:
	void line(std::string_view name, std::span<const double> values, bool narrow);
	void whole(std::string_view name, std::span<const int> values);

	std::string m_text;
};

// Mixes two numbers into one that looks like neither (the finaliser of D. Stafford's "Mix13", as in splitmix64).
inline uint64_t mixed(uint64_t a, uint64_t b)
{
	uint64_t z = a + 0x9e3779b97f4a7c15ULL * (b + 1);
	z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9ULL;
	z = (z ^ (z >> 27U)) * 0x94d049bb133111ebULL;
	return z ^ (z >> 31U);
}

class Case
{
public:
	// key: of kernel and seed. twin: whether there is time for the twin. notes: null unless the case is shown.
	Case(uint64_t key, uint64_t index, bool twin, CaseNotes* notes)
		: random(mixed(key, index), mixed(index, key)), m_key(key), m_index(index), m_twin(twin), m_notes(notes)
	{
	}

	Random random;

	uint64_t index() const
	{
		return m_index;
	}
	// Random numbers that `span` cases in a row share: of a picture, of which each looks at another pixel.
	uint64_t sharedKey(uint64_t span) const
	{
		return mixed(m_key ^ 0x5bd1e995U, m_index / span);
	}
	bool hasTwin() const
	{
		return m_twin;
	}

	template <class Value> void note(std::string_view name, const Value& value)
	{
		if (m_notes != nullptr)
		{
			m_notes->add(name, value);
		}
	}
	bool shown() const
	{
		return m_notes != nullptr;
	}

	// A result of the kernel, which has to be a number from `least` to `most`.
	void result(std::string_view name, double found, double least, double most)
	{
		note(name, found);
		broken = broken || !std::isfinite(found);
		outside = outside || (std::isfinite(found) && !(found >= least && found <= most));
	}
	// A property of the result.
	void require(std::string_view name, bool holds)
	{
		outside = outside || !holds;
		if (!holds)
		{
			note(name, std::string_view("does not hold"));
		}
	}
	// Against the twin; one unit of the absolute error is `unit`.
	void compare(std::string_view name, double found, long double expected, double unit = 1.0)
	{
		compared = true;
		note(name, expected);
		if (!std::isfinite(found) || !std::isfinite(expected))
		{
			broken = true;
			return;
		}
		const auto off = static_cast<double>(std::fabs(static_cast<long double>(found) - expected));
		absolute = std::fmax(absolute, off / unit);
		if (expected != 0.0L)
		{
			relative = std::fmax(relative, static_cast<double>(static_cast<long double>(off) / std::fabs(expected)));
		}
	}
	// Rounding decides between two results that are both right.
	void leaveOpen()
	{
		compared = true;
		unsure = true;
	}

	bool broken = false;
	bool outside = false;
	bool compared = false;
	bool unsure = false;
	double absolute = 0.0;
	double relative = 0.0;

private:
	uint64_t m_key;
	uint64_t m_index;
	bool m_twin;
	CaseNotes* m_notes;
};

struct StressKernel
{
	std::string_view name;
	std::string_view family;
	std::string_view what;
	std::string_view unit;
	double most_absolute = 0.0;
	uint32_t share = 1;      // of all cases: about one over what a case costs
	uint32_t twin_every = 1; // cases a twin
	void (*run)(Case&) = nullptr;
};

// By file of this room.
std::span<const StressKernel> depthKernels();
std::span<const StressKernel> volumeKernels();
std::span<const StressKernel> maskKernels();
std::span<const StressKernel> gatherKernels();
std::span<const StressKernel> filterKernels();
std::span<const StressKernel> tableKernels();
std::span<const StressKernel> prismKernels();
std::span<const StressKernel> patternKernels();
std::span<const StressKernel> occluderKernels();

} // namespace nook::stress
