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

// nookMeanAlong for all four channels.
vec4 nookBentAlong(ivec2 cell, ivec2 axis)
{
	ivec2 first = nookFirstCell();
	ivec2 last = nookLastCell();
	vec4 own = nookPacked(cell);
	float width = 0.5f * float(NOOK_TAPS + 1);
	float link_x = float(axis.x);
	float link_y = float(axis.y);
	vec4 sum = nookLevel(cell, 0);
	float weights = 1.0f;
	float before = 1.0f;
	float after = link_x * own.y + link_y * own.z;
	for (int i = 1; i <= NOOK_TAPS; ++i)
	{
		float falls = exp(-0.5f * float(i * i) / (width * width));
		ivec2 there = ivec2(cell.x - i * axis.x, cell.y - i * axis.y);
		if (there.x < first.x || there.y < first.y)
		{
			before = 0.0f;
		}
		ivec2 one = ivec2(max(there.x, first.x), max(there.y, first.y));
		vec4 links = nookPacked(one);
		before *= link_x * links.y + link_y * links.z;
		ivec2 other = ivec2(min(cell.x + i * axis.x, last.x), min(cell.y + i * axis.y, last.y));
		sum = sum + (nookLevel(one, 0) * before + nookLevel(other, 0) * after) * falls;
		weights += falls * (before + after);
		links = nookPacked(other);
		after *= link_x * links.y + link_y * links.z;
	}
	return sum / weights;
}

// First pass of the filter.
vec4 nookBentX(ivec2 cell)
{
	return nookBentAlong(cell, ivec2(1, 0));
}

// Second pass of the filter.
vec4 nookBentY(ivec2 cell)
{
	return nookBent(cell, nookBentAlong(cell, ivec2(0, 1)));
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
