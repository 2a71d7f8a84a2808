// Made by: nook emit --methods vo-line --patterns disk_009_tile4.json --filter window --glsl 430
// Version: nook 0.1.0
// Base pattern: nook tile --pattern disk_009.json --size 4
// SPDX-License-Identifier: MIT
//
// Visibility, 1 where open, of the pixel of a depth buffer:
//   float nookVoLine(ivec2 pixel): volumetric obscurance by lines, 9 samples, others in each pixel of 4 x 4
//   float nookWindow(ivec2 pixel): what one of these drew, as the mean over a window on the same surface
// Pixels count as texelFetch does. `nook emit -o FILE.h` writes the C++ that fills the block.
// Without #version, to be included after yours. All names begin with nook or NOOK.
//
// Any camera without a skew: positions from depth, and how large a length is in the picture.
//
// Volumetric obscurance: the open share of the ball around a point, by lines along the view direction or by points.
// This work is based on: B. J. Loos, P.-P. Sloan, "Volumetric Obscurance", I3D 2010 (VO).
//
// Noisy visibility → clean: filters that stay on the pixel's own surface, and half resolution back to full.
// The two one-dimensional passes are those of: M. McGuire, B. Osman, M. Bukowski, P. Hennessy, "The Alchemy Screen-Space Ambient
// Obscurance Algorithm", HPG 2011 (ALC 3.3), with other weights.
#ifndef NOOK_VO_LINE_GLSL
#define NOOK_VO_LINE_GLSL
#if __VERSION__ < 430
#error nook: this module needs #version 430 or later
#endif
#ifndef NOOK_SKY
#define NOOK_SKY 1e30
#endif

// Lengths are in metres, or whatever unit your depths have.
#ifndef NOOK_BLOCK_BINDING
#define NOOK_BLOCK_BINDING 0
#endif
layout(std140, binding = NOOK_BLOCK_BINDING) uniform nook_block
{
	vec4 size; // width and height of the picture in pixels, 1 / width, 1 / height
	vec4 across_x; // of the projection P: 1 / P00, P20 / P00, -P30 / P00 (P20: column 2, row 0)
	vec4 across_y; // 1 / P11 (negative where the first row of pixels is that of NDC y = -1), P21 / P11, -P31 / P11
	vec4 w; // w after the projection, of a depth d: x * d + y
	vec4 radius; // x: radius in metres, or in the unit of your depths
	vec4 alchemy; // Alchemy: sigma, contrast k, beta, epsilon
} nook;

// Depth along the view direction, > 0, linear; NOOK_SKY or more where there is no surface.
// Define NOOK_DEPTH(pixel) first to read yours in another way.
#ifndef NOOK_DEPTH
#ifndef NOOK_DEPTHS_BINDING
#define NOOK_DEPTHS_BINDING 1
#endif
layout(binding = NOOK_DEPTHS_BINDING) uniform sampler2D nook_depths;
#define NOOK_DEPTH(pixel) texelFetch(nook_depths, pixel, 0).r
#endif
float nookDepth(ivec2 pixel)
{
	return NOOK_DEPTH(pixel);
}

// Unit normal in view space: x right, y up, z toward the camera.
// Define NOOK_NORMAL(pixel) first to read yours in another way.
#ifndef NOOK_NORMAL
#ifndef NOOK_NORMALS_BINDING
#define NOOK_NORMALS_BINDING 2
#endif
layout(binding = NOOK_NORMALS_BINDING) uniform sampler2D nook_normals;
#define NOOK_NORMAL(pixel) texelFetch(nook_normals, pixel, 0).xyz
#endif
vec3 nookNormal(ivec2 pixel)
{
	return NOOK_NORMAL(pixel);
}

// Visibility as a method drew it.
// Define NOOK_VISIBILITY(pixel) first to read yours in another way.
#ifndef NOOK_VISIBILITY
#ifndef NOOK_CELLS_BINDING
#define NOOK_CELLS_BINDING 6
#endif
layout(binding = NOOK_CELLS_BINDING) uniform sampler2D nook_cells;
#define NOOK_VISIBILITY(pixel) texelFetch(nook_cells, pixel, 0).r
#endif
float nookVisibility(ivec2 pixel)
{
	return NOOK_VISIBILITY(pixel);
}

// x,y,half_length,weight of each sample, for a radius of 1: RGBA, 32-bit floats, 16 x 9 texels.
#ifndef NOOK_VO_LINE_TILE_BINDING
#define NOOK_VO_LINE_TILE_BINDING 3
#endif
layout(binding = NOOK_VO_LINE_TILE_BINDING) uniform sampler2D nook_vo_line_tile;
vec4 nookVoLineSample(int row, int i)
{
	return texelFetch(nook_vo_line_tile, ivec2(row, i), 0);
}
int nookVoLineVariant(ivec2 pixel)
{
	return (pixel.y % 4) * 4 + pixel.x % 4;
}

// View-space position of what a pixel shows at a depth. nook.across_x = (1/P00, P20/P00, -P30/P00), nook.across_y the same of the
// second row with P11, P21, P31; nook.w = (-P23, P33): w after the projection is nook.w.x * depth + nook.w.y.
vec3 nookPosition(ivec2 pixel, float depth)
{
	float w = nook.w.x * depth + nook.w.y;
	float ndc_x = (float(pixel.x) + 0.5f) * nook.size.z * 2.0f - 1.0f;
	float ndc_y = 1.0f - (float(pixel.y) + 0.5f) * nook.size.w * 2.0f;
	return vec3(ndc_x * w * nook.across_x.x + depth * nook.across_x.y + nook.across_x.z,
				ndc_y * w * nook.across_y.x + depth * nook.across_y.y + nook.across_y.z, -depth);
}

// Pixels per metre across the view direction at a depth: x to the right, y downward.
vec2 nookScale(float depth)
{
	float w = nook.w.x * depth + nook.w.y;
	return vec2(0.5f * nook.size.x / (w * nook.across_x.x), 0.5f * nook.size.y / (w * nook.across_y.x));
}

ivec2 nookInside(ivec2 pixel)
{
	return ivec2(clamp(pixel.x, 0, int(nook.size.x) - 1), clamp(pixel.y, 0, int(nook.size.y) - 1));
}

// The pixel that lies `offset` metres (x right, y up) from the middle of a pixel, or the nearest one of the picture.
ivec2 nookNeighbour(ivec2 pixel, vec2 offset, vec2 scale)
{
	float x = float(pixel.x) + 0.5f + offset.x * scale.x;
	float y = float(pixel.y) + 0.5f - offset.y * scale.y;
	return nookInside(ivec2(int(floor(x)), int(floor(y))));
}

// Depth at which another pixel's line of sight is `height` metres above the tangent plane of a pixel, less the depth of that pixel;
// NOOK_SKY where the plane does not face the camera there. From the distance between the pixels alone: the depths themselves would
// leave nothing of it far away.
float nookPlaneRise(ivec2 pixel, ivec2 there, vec3 n, float depth, float height)
{
	float w = nook.w.x * depth + nook.w.y;
	float x = float(there.x - pixel.x) * nook.size.z * 2.0f * w * nook.across_x.x;
	float y = float(pixel.y - there.y) * nook.size.w * 2.0f * w * nook.across_y.x;
	float fall = dot(n, nookPosition(there, 1.0f) - nookPosition(there, 0.0f));
	if (fall > -1e-6f)
	{
		return NOOK_SKY;
	}
	return (height - (n.x * x + n.y * y)) / fall;
}

// VO 4.1 and 4.4. Lines of the disk: (x, y, half length z_s, weight). With the normal the lines end at the tangent plane, and the sum
// is divided by what it would be with nothing in the way. Without it an open surface that faces the camera reads 1/2.
float nookVoLine(ivec2 pixel)
{
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	float radius = nook.radius.x;
	vec2 scale = nookScale(depth) * radius;
	if (max(scale.x, scale.y) < 0.5f)
	{
		return 1.0f; // every sample falls on the pixel itself
	}
	vec3 n = nookNormal(pixel);
	int row = nookVoLineVariant(pixel);
	float seen = 0.0f;
	float whole = 0.0f;
	for (int i = 0; i < 9; ++i)
	{
		vec4 line = nookVoLineSample(row, i);
		ivec2 there = nookNeighbour(pixel, vec2(line.x, line.y), scale);
		float end = line.z;
		end = min(end, nookPlaneRise(pixel, there, n, depth, 0.0f) / radius);
		float front = (nookDepth(there) - depth) / radius;
		float share = line.w / (2.0f * line.z);
		seen += share * max(min(end, front) + line.z, 0.0f);
		whole += share * max(end + line.z, 0.0f);
	}
	if (whole > 0.0f)
	{
		return seen / whole;
	}
	return 1.0f;
}

ivec2 nookPixel(ivec2 cell)
{
	return cell * 1;
}

ivec2 nookLastCell()
{
	return ivec2((int(nook.size.x) - 1) / 1, (int(nook.size.y) - 1) / 1);
}

// How far, as a share of the radius, a pixel's position is from the tangent plane that it shares with another one; NOOK_SKY for sky.
// The plane between the two normals: it holds both ends of any arc of a circle, so that columns are as smooth as walls. Unlike a
// difference of depths it is 0 along a plane at any slope; and visibility can change by no more than about its size.
float nookApart(vec3 centre, vec3 n, ivec2 there)
{
	float depth = nookDepth(there);
	if (depth >= NOOK_SKY)
	{
		return NOOK_SKY;
	}
	return abs(dot(n + nookNormal(there), nookPosition(there, depth) - centre)) / (2.0f * nook.radius.x);
}

// Does a pixel show the same surface: 1 yes, 0 no. Flat at both ends, so that on a smooth surface all pixels count alike, which is
// what makes the mean of a window of variants exact. Chosen by eye on builtin:courtyard, not swept.
float nookAlike(vec3 centre, vec3 n, ivec2 there)
{
	float beside = clamp(2.0f - nookApart(centre, n, there) * 20.0f, 0.0f, 1.0f);
	float turned = clamp(dot(n, nookNormal(there)) * 5.0f - 3.5f, 0.0f, 1.0f);
	return beside * turned;
}

// The mean over the window of the tile: every variant once. All cells that show the same surface count alike.
float nookWindow(ivec2 cell)
{
	ivec2 pixel = nookPixel(cell);
	float depth = nookDepth(pixel);
	if (depth >= NOOK_SKY)
	{
		return 1.0f;
	}
	vec3 n = nookNormal(pixel);
	vec3 centre = nookPosition(pixel, depth);
	ivec2 last = nookLastCell();
	int first = -((4 - 1) / 2);
	float sum = nookVisibility(cell);
	float weights = 1.0f;
	for (int y = first; y < first + 4; ++y)
	{
		for (int x = first; x < first + 4; ++x)
		{
			ivec2 there = ivec2(cell.x + x, cell.y + y);
			bool other = x != 0 || y != 0;
			if (other && there.x >= 0 && there.y >= 0 && there.x <= last.x && there.y <= last.y)
			{
				float weight = nookAlike(centre, n, nookPixel(there));
				sum += weight * nookVisibility(there);
				weights += weight;
			}
		}
	}
	return sum / weights;
}

#endif // NOOK_VO_LINE_GLSL
