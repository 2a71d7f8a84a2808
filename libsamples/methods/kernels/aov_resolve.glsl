// SPDX-License-Identifier: MIT
// Corrects the sum of the occlusion of all volumes by the curve of the level (AOV section 5.4).

// Linear between 33 knots from 0 to nook.sum_range, constant beyond.
float nookCompensated(float sum)
{
	float place = clamp(sum / nook.sum_range, 0.0, 1.0) * 32.0;
	int knot = int(min(floor(place), 31.0));
	float share = place - float(knot);
	float before = nook.curve[knot / 4][knot % 4];
	float after = nook.curve[(knot + 1) / 4][(knot + 1) % 4];
	return before + share * (after - before);
}
