// SPDX-License-Identifier: MIT
// Visibility of a few pixels → of all: AOV's filter for sparse sampling.
// This work is based on: M. McGuire, "Ambient Occlusion Volumes", HPG 2010 (AOV 5.5): Gaussian, across normals and 3D distance.
//
// Cells of nook.grid.x pixels, each evaluated at its upper left pixel; nook.radius.x: the reach of the volumes, metres.

// The mean over 5 x 5 cells around the nearest one. Where none of them shows the pixel's surface, that which is nearest to its
// tangent plane counts most.
float nookSparse(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	ivec2 middle = ivec2((pixel.x + nook.grid.x / 2) / nook.grid.x, (pixel.y + nook.grid.x / 2) / nook.grid.x);
	float sum = 0.0f;
	float weights = 0.0f;
	for (int i = 0; i < 25; ++i)
	{
		ivec2 there = ivec2(middle.x + i % 5 - 2, middle.y + i / 5 - 2);
		if (nookDrawn(there))
		{
			ivec2 taken = nookPixel(there);
			float apart = nookApart(centre, n, taken);
			if (apart < NOOK_SKY)
			{
				vec2 off = vec2(float(taken.x - pixel.x), float(taken.y - pixel.y)) / float(nook.grid.x);
				vec3 away = (nookPosition(taken, nookDepth(taken)) - centre) / nook.radius.x;
				// Narrow in cells, so that creases stay dark; in metres half of the reach. A plane through the cells instead of their
				// mean is 15 % closer on builtin:cornell, and no closer on builtin:suburb.
				float near = exp(-1.5f * dot(off, off) - 2.0f * dot(away, away));
				float weight = 1e-6f / (1.0f + 1e4f * apart) + near * nookAlike(centre, n, taken);
				sum += weight * nookVisibility(there);
				weights += weight;
			}
		}
	}
	if (weights > 0.0f)
	{
		return sum / weights;
	}
	return 1.0f;
}
