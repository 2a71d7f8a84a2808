// SPDX-License-Identifier: MIT
// Summed-area tables of unsigned integers, which wrap around: the sum over a rectangle is exact as long as it is itself below 2^32,
// whatever the tables' entries are.
// This work is based on: F. C. Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984, and J. Hensley, T. Scheuermann,
// G. Coombe, M. Singh, A. Lastra, "Fast Summed-Area Table Generation and its Applications", Eurographics 2005 (recursive doubling).
//
// A table has one row and column more than there are cells: entry (x, y) is the sum over the cells left of x and above y.

// One of the passes that sum along x (NOOK_AXIS = 0) or y (1): eight entries, NOOK_STRIDE apart. With strides 1, 8, 64, ... each
// entry becomes the sum of all before it and itself.
uvec4 nookTableSum(ivec2 texel)
{
	uvec4 sum = uvec4(0u, 0u, 0u, 0u);
	for (int i = 0; i < 8; ++i)
	{
		ivec2 there = ivec2(texel.x - i * NOOK_STRIDE * (1 - NOOK_AXIS), texel.y - i * NOOK_STRIDE * NOOK_AXIS);
		if (there.x >= 0 && there.y >= 0)
		{
			sum += nookTable(there, 0);
		}
	}
	return sum;
}

// Over the cells from (box.x, box.y) up to, without it, (box.z, box.w).
uvec4 nookTableBox(ivec4 box, int table)
{
	return nookTable(ivec2(box.z, box.w), table) - nookTable(ivec2(box.x, box.w), table) - nookTable(ivec2(box.z, box.y), table) +
		   nookTable(ivec2(box.x, box.y), table);
}
