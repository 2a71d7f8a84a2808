#version 330 core
// SPDX-License-Identifier: MIT
in vec3 view, turned, up;
layout(location = 0) out vec4 colour;
layout(location = 1) out float depth; // along the view direction
layout(location = 2) out vec4 facing; // unit normal in view space

void main()
{
	colour = vec4(mix(vec3(0.42, 0.37, 0.33), vec3(0.75, 0.82, 0.92), 0.5 + 0.5 * normalize(up).y), 1.0);
	depth = -view.z;
	facing = vec4(normalize(turned), 0.0);
}
