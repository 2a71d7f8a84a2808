#version 330 core
// SPDX-License-Identifier: MIT
// The engine's own shader: the level, with depth and normals for passes on the screen.
uniform mat4 worldview, projection;
in vec4 vertex;
in vec3 normal;
out vec3 view, turned, up;

void main()
{
	vec4 at = worldview * vertex;
	view = at.xyz;
	turned = mat3(worldview) * normal;
	up = normal;
	gl_Position = projection * at;
}
