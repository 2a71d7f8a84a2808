#version 330 core
// SPDX-License-Identifier: MIT
in vec4 vertex;
in vec2 uv0;
out vec2 uv;

void main()
{
	uv = uv0;
	gl_Position = vertex;
}
