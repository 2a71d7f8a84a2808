#[compute]
#version 450
// SPDX-License-Identifier: MIT
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba16f) uniform image2D frame;
layout(set = 0, binding = 1) uniform sampler2D visibility;

void main()
{
	ivec2 pixel = ivec2(gl_GlobalInvocationID.xy);
	ivec2 size = imageSize(frame);
	if (pixel.x < size.x && pixel.y < size.y)
	{
		imageStore(frame, pixel, imageLoad(frame, pixel) * vec4(texelFetch(visibility, pixel, 0).rrr, 1.0));
	}
}
