// SPDX-License-Identifier: MIT
// A quad over the whole picture: the depth buffer as three bytes, because viewports have no 32-bit format.
shader_type spatial;
render_mode unshaded, depth_test_disable, depth_draw_never, cull_disabled;

void vertex()
{
	POSITION = vec4(2.0 * VERTEX.xy, 0.0, 1.0);
}

void fragment()
{
	int steps = int(round(texelFetch(DEPTH_TEXTURE, ivec2(FRAGCOORD.xy), 0).r * 16777215.0));
	ALBEDO = (vec3(ivec3(steps >> 16, (steps >> 8) & 255, steps & 255)) + 0.25) / 255.0;
}
