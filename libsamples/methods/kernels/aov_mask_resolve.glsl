// SPDX-License-Identifier: MIT
// Counts covered directions (GLSL has bitCount only since 4.00).

uint nookBitsOf(uvec4 words)
{
	uvec4 n = words - ((words >> 1) & uvec4(0x55555555u, 0x55555555u, 0x55555555u, 0x55555555u));
	n = (n & uvec4(0x33333333u, 0x33333333u, 0x33333333u, 0x33333333u)) + ((n >> 2) & uvec4(0x33333333u, 0x33333333u, 0x33333333u, 0x33333333u));
	n = (((n + (n >> 4)) & uvec4(0x0f0f0f0fu, 0x0f0f0f0fu, 0x0f0f0f0fu, 0x0f0f0f0fu)) * 0x01010101u) >> 24;
	return n.x + n.y + n.z + n.w;
}
