// SPDX-License-Identifier: MIT
// Summed-area tables of unsigned integers. Overflow wraps around, so the sum over a rectangle is exact as long as the sum
// itself is below 2^32, whatever the entries of the table are.
// This work is based on: F. C. Crow, "Summed-Area Tables for Texture Mapping", SIGGRAPH 1984, and J. Hensley, T. Scheuermann,
// G. Coombe, M. Singh, A. Lastra, "Fast Summed-Area Table Generation and its Applications", Eurographics 2005 (recursive
// doubling).
//
// A table has one row and one column more than there are cells: entry (x, y) is the sum over the cells left of x and above y.

// A pass that sums along x (axis NOOK_AXIS = 0) or y (1): adds eight entries that are NOOK_STRIDE apart. After passes with
// strides 1, 8, 64, ... each entry is the sum of itself and all entries before it.
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

// Sum over the cells from (box.x, box.y) up to, but without, (box.z, box.w).
uvec4 nookTableBox(ivec4 box, int table)
{
	return nookTable(ivec2(box.z, box.w), table) - nookTable(ivec2(box.x, box.w), table) - nookTable(ivec2(box.z, box.y), table) +
		   nookTable(ivec2(box.x, box.y), table);
}
