// SPDX-License-Identifier: MIT
// Everything in this program that uses nook's modules: computes visibility from a depth buffer and normals.
#pragma once

#include <glm/mat4x4.hpp>

#include <array>
#include <map>
#include <string>
#include <utility>
#include <vector>

struct nook_settings;

class Obscurance
{
public:
	struct Method
	{
		const char* name;     // nook's name
		const char* function; // in the module
		const char* module;   // GLSL
		const char* half_module;
		bool moments;     // reads depth moments, which are drawn first
		const char* tile; // the texture for its samples, and its contents
		int tile_width;
		int tile_height;
		const float (*texels)[4];
		nook_settings (*settings)(double reach);
	};
	static const std::vector<Method>& methods();

	// Needs a current context, like everything here; its OpenGL objects are destroyed with the context.
	Obscurance();

	void resize(int width, int height);

	struct Input
	{
		unsigned depth = 0;    // texture: depth buffer
		unsigned normals = 0;  // texture: unit, in view space
		bool reversed = false; // 1 near, 0 far, z_ndc from 0 to 1
		glm::mat4 projection{1.0f};
		float radius_m = 1.0f;
		int frame = 0; // selects the tiles' samples
	};
	// Returns a texture, R8: 1 is open; the other resolution's picture is unchanged. Throws Failure for a camera that the module
	// rejects.
	unsigned draw(const Method& method, const Input& input, bool half);

	// GPU time of the passes for the frame before the last, which is finished by now; for the first frame, its own.
	double milliseconds() const;

private:
	static constexpr int kMomentLevels = 6; // stated in the module's introduction

	// Render target of a pass.
	struct Target
	{
		unsigned picture = 0;
		unsigned frame = 0;
		int width = 0;
		int height = 0;
	};
	static Target targetOf(int format, int width, int height);
	static void drop(const Target& target);
	void resizeMoments();

	// A pass of a module, evaluated per pixel of its target.
	struct Pass
	{
		std::string call;           // in terms of `pixel`
		bool half = false;          // which module
		const char* type = "float"; // return type
	};
	static const Pass kMoments;
	void drawMoments(const Method& method, const Input& input);
	// `cells` is the previous pass's picture, or 0.
	void run(const Pass& pass, const Input& input, const Method& method, const Target& target, unsigned cells);
	static void begin(unsigned program, const Input& input, const Target& target);
	unsigned programFor(const Method& method, const Pass& pass); // compiled on first use

	std::map<std::pair<const char*, std::string>, unsigned> m_programs; // by module and call
	std::map<std::string, unsigned> m_tiles;                            // by name
	std::array<Target, 2> m_full;
	std::array<Target, 3> m_half; // two of cells, the second with surface data for upsampling, and the full picture
	unsigned m_moments = 0;       // texture, with a framebuffer per level
	std::array<Target, kMomentLevels> m_levels;
	unsigned m_block = 0;
	unsigned m_vertices = 0;
	std::array<unsigned, 2> m_timers{}; // used alternately
	std::size_t m_drawn = 0;
	int m_width = 0;
	int m_height = 0;
};
