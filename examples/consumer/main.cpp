// SPDX-License-Identifier: MIT
// Uses patterns made while this project was built: how much of the unit ball a wall beside it takes, by lines and by points.
#include "disk_005.h"
#include "disk_009.h"
#include "volume_012.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace
{

// The share of the ball that lies beyond the plane n·x > c, by line samples along z.
template <std::size_t Count> double byLines(const float (&lines)[Count][4], const double (&n)[3], double c)
{
	double share = 0.0;
	for (const float(&line)[4] : lines)
	{
		const double depth = (c - n[0] * line[0] - n[1] * line[1]) / n[2]; // the line leaves the free side here
		const double half_length = line[2];
		const double covered = std::clamp(half_length - depth, 0.0, 2.0 * half_length);
		share += half_length > 0.0f ? line[3] * covered / (2.0 * half_length) : 0.0;
	}
	return share;
}

template <std::size_t Count> double byPoints(const float (&points)[Count][4], const double (&n)[3], double c)
{
	double share = 0.0;
	for (const float(&point)[4] : points)
	{
		share += n[0] * point[0] + n[1] * point[1] + n[2] * point[2] > c ? point[3] : 0.0;
	}
	return share;
}

bool show(const char* what, double found, double expected, double allowed)
{
	const bool good = std::fabs(found - expected) <= allowed;
	std::printf("%-28s %.4f, exactly %.4f%s\n", what, found, expected, good ? "" : ": too far off");
	return good;
}

} // namespace

int main()
{
	const double n[3] = {0.48, 0.36, 0.8};
	const double c = 0.25;
	const double exact = (1.0 - c) * (1.0 - c) * (2.0 + c) / 4.0;
	bool good = show("5 lines, wall at 0.25", byLines(nook_disk_5_points, n, c), exact, 0.1);
	good &= show("9 lines, wall at 0.25", byLines(nook_disk_9_points, n, c), exact, 0.05);
	good &= show("12 points, wall at 0.25", byPoints(volume_12_points, n, c), exact, 0.15);
	good &= show("9 lines, wall through P", byLines(nook_disk_9_points, n, 0.0), 0.5, 0.03);
	double weights = 0.0;
	for (const auto& line : nook_disk_9_points)
	{
		weights += line[3];
	}
	good &= show("9 lines, sum of weights", weights, 1.0, 1e-6);
	return good ? 0 : 1;
}
