// SPDX-License-Identifier: MIT
// Everything that this program has to do with nook: a depth buffer and normals → visibility, by the module that nook emitted.
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
		const char* name;     // as nook calls it
		const char* function; // of the module
		const char* module;   // GLSL
		const char* half_module;
		bool moments;     // it reads moments of the depths, which are drawn before
		const char* tile; // the texture that its samples are read from, and what is in it
		int tile_width;
		int tile_height;
		const float (*texels)[4];
		nook_settings (*settings)(double reach);
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
		int frame = 0; // of the tiles: which samples
	};
	// Returns a texture, R8: 1 where open; that of the other resolution stays as it is. Throws Failure for a camera that the module
	// does not take.
	unsigned draw(const Method& method, const Input& input, bool half);

	// That the GPU took for the passes of the picture drawn before the last, which is finished by now; of the first where there is
	// no other.
	double milliseconds() const;

private:
	static constexpr int kMomentLevels = 6; // as the module's head says

	// What a pass draws.
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

	// A pass of a module, of a pixel of what it draws.
	struct Pass
	{
		std::string call;           // of `pixel`
		bool half = false;          // which module
		const char* type = "float"; // what it returns
	};
	static const Pass kMoments;
	void drawMoments(const Method& method, const Input& input);
	// `cells` is the picture that the pass before drew, or 0.
	void run(const Pass& pass, const Input& input, const Method& method, const Target& target, unsigned cells);
	static void begin(unsigned program, const Input& input, const Target& target);
	unsigned programFor(const Method& method, const Pass& pass); // compiled where it is new

	std::map<std::pair<const char*, std::string>, unsigned> m_programs; // by module and call
	std::map<std::string, unsigned> m_tiles;                            // by name
	std::array<Target, 2> m_full;
	std::array<Target, 3> m_half; // two of cells, the second with their surfaces, and the whole picture
	unsigned m_moments = 0;       // texture, with a frame for each of its levels
	std::array<Target, kMomentLevels> m_levels;
	unsigned m_block = 0;
	unsigned m_vertices = 0;
	std::array<unsigned, 2> m_timers{}; // in turn
	std::size_t m_drawn = 0;
	int m_width = 0;
	int m_height = 0;
};
