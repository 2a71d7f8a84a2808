// SPDX-License-Identifier: MIT
// Everything that this program has to do with nook: a depth buffer and normals → visibility, by the module that nook emitted.
#pragma once

#include <glm/mat4x4.hpp>

#include <array>
#include <map>
#include <string>
#include <vector>

class Obscurance
{
public:
	struct Method
	{
		const char* name;                // as nook calls it
		std::vector<const char*> passes; // functions of the module; each reads the picture that the one before drew
		const char* tile;                // the texture that its samples are read from, and what is in it
		int tile_width;
		int tile_height;
		const float (*texels)[4];
	};
	static const std::vector<Method>& methods();

	// Needs a current context, as all else here; what it makes there goes with the context.
	Obscurance();

	void resize(int width, int height);

	struct Input
	{
		unsigned depth = 0;    // texture: a depth buffer as it is
		unsigned normals = 0;  // texture: unit, in view space
		bool reversed = false; // 1 near, 0 far, z_ndc from 0 to 1
		glm::mat4 projection{1.0f};
		float radius_m = 1.0f;
	};
	// Returns a texture, R8: 1 where open. Throws Failure for a camera that the module does not take.
	unsigned draw(const Method& method, const Input& input);

	// That the GPU took for the passes of the picture before the last, which is finished by now; of the first where there is no
	// other.
	double milliseconds() const;

private:
	void run(unsigned program, const Input& input, const Method& method, std::size_t target);

	std::map<std::string, unsigned> m_programs; // by function of the module
	std::map<std::string, unsigned> m_tiles;    // by name
	std::array<unsigned, 2> m_pictures{};       // passes draw them in turn
	std::array<unsigned, 2> m_frames{};
	unsigned m_block = 0;
	unsigned m_vertices = 0;
	std::array<unsigned, 2> m_timers{}; // in turn
	std::size_t m_drawn = 0;
	int m_width = 0;
	int m_height = 0;
};
