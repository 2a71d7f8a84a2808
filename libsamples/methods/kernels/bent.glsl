// SPDX-License-Identifier: MIT
// From means of open directions to bent normals: a filter that stays on the surface of the pixel, and codes for textures.
// Bent normals are those of: H. Landis, "Production-Ready Global Illumination", SIGGRAPH 2002 courses.
//
// The including file provides nookLevel(cell, 0), a mean of open directions as xyz and visibility as w (nookSlicesOpen), and
// nookPacked(cell), the result of nookBentLinked.

// Bent normal, a unit vector, and visibility, from a mean of open directions and visibility. A mean that noise has turned below
// the surface is moved back to it; where nothing is open, the result is the normal. 0 for sky.
vec4 nookBent(ivec2 pixel, vec4 mean)
{
	if (nookDepth(pixel) >= NOOK_SKY)
	{
		return vec4(0.0f, 0.0f, 0.0f, 1.0f);
	}
	vec3 n = nookNormal(pixel);
	vec3 bent = vec3(mean.x, mean.y, mean.z);
	bent = bent - n * min(dot(bent, n), 0.0f);
	float square = dot(bent, bent);
	if (square < 1e-10f)
	{
		bent = n;
		square = dot(n, n);
	}
	float open = mean.w;
#if NOOK_SHAPED
	open = nookShaped(open);
#endif
	bent = bent / sqrt(square);
	return vec4(bent.x, bent.y, bent.z, open);
}

// The bent normal as xyz and visibility as w, without a filter.
vec4 nookSlicesBent(ivec2 pixel)
{
	return nookBent(pixel, nookSlicesOpen(pixel));
}

// Visibility, and whether the next cells along x and y show the same surface, for both passes of the filter.
vec4 nookBentLinked(ivec2 cell)
{
	return nookLinked(cell, nookLevel(cell, 0).w);
}

// First pass of the filter.
vec4 nookBentX(ivec2 cell)
{
	return nookMeanAlong(cell, ivec2(1, 0));
}

// Second pass of the filter.
vec4 nookBentY(ivec2 cell)
{
	return nookBent(cell, nookMeanAlong(cell, ivec2(0, 1)));
}

// A unit vector as two numbers, on the octahedron |x| + |y| + |z| = 1 whose lower half is folded outward.
vec2 nookFolded(vec3 n)
{
	float size = max(abs(n.x) + abs(n.y) + abs(n.z), 1e-20f); // sky has no normal
	float x = n.x / size;
	float y = n.y / size;
	if (n.z < 0.0f)
	{
		return vec2((1.0f - abs(y)) * (x < 0.0f ? -1.0f : 1.0f), (1.0f - abs(x)) * (y < 0.0f ? -1.0f : 1.0f));
	}
	return vec2(x, y);
}

// The unit vector that nookFolded stored.
vec3 nookUnfolded(vec2 folded)
{
	float below = max(abs(folded.x) + abs(folded.y) - 1.0f, 0.0f);
	float x = folded.x - (folded.x < 0.0f ? -below : below);
	float y = folded.y - (folded.y < 0.0f ? -below : below);
	vec3 n = vec3(x, y, 1.0f - abs(folded.x) - abs(folded.y));
	return n / sqrt(dot(n, n));
}

// A bent normal and visibility as numbers from 0 to 1, for a texture with 8 bits per channel or more: the vector on an
// octahedron, visibility, 1.
vec4 nookBentCoded(vec4 bent)
{
	vec2 folded = nookFolded(vec3(bent.x, bent.y, bent.z));
	return vec4(0.5f + 0.5f * folded.x, 0.5f + 0.5f * folded.y, bent.w, 1.0f);
}

// The inverse of nookBentCoded.
vec4 nookBentDecoded(vec4 code)
{
	return vec4(nookUnfolded(vec2(2.0f * code.x - 1.0f, 2.0f * code.y - 1.0f)), code.z);
}

// Half angle in radians of the cone around a bent normal that is as open as the pixel: visibility is the square of its sine.
float nookConeAngle(float open)
{
	return asin(sqrt(clamp(open, 0.0f, 1.0f)));
}
