#version 330 core
// SPDX-License-Identifier: MIT
uniform sampler2D frame, visibility;
in vec2 uv; // a window's rows go upward, but those of OGRE's textures downward
out vec4 colour;

void main()
{
	colour = texture(frame, uv) * texture(visibility, uv).r;
}
