// SPDX-License-Identifier: MIT
// A file of `nook level` or `nook bake` → triangles, masks and cameras. Not a reader of glTF in general: `nook level` makes such a
// file of any level.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

// What ends the program: one line for people, and the exit code.
struct Failure : std::runtime_error
{
	Failure(int exit_code, const std::string& line) : std::runtime_error(line), code(exit_code) {}
	int code; // 1 usage, 2 file, 3 invalid input, 4 run time, 5 not supported
};

struct Vertex
{
	glm::vec3 position{0.0f}; // world space, metres, y up
	glm::vec3 normal{0.0f};   // 0: the triangle's own
	glm::vec2 uv{0.0f};
	glm::vec2 baked{1.0f}; // of `nook bake`: visibility, or a difference, of the front and of the back
};

// Triangles that are drawn at once.
struct Batch
{
	std::uint32_t first_index = 0;
	std::uint32_t index_count = 0;
	int mask = -1;       // of LevelFile::masks, or none
	float alpha = 1.0f;  // × mask ≥ cutoff: there is a surface
	float cutoff = 0.0f; // 0: always
	bool moves = false;  // drawn behind all that does not
};

struct Mask
{
	int width = 0;
	int height = 0;
	int wrap_u = 0; // as glTF and OpenGL have them
	int wrap_v = 0;
	std::vector<std::uint8_t> alpha; // rows from the top
};

struct Camera
{
	std::string name;
	glm::mat4 world_from_camera{1.0f}; // rotation and translation; it looks down −z
	bool orthographic = false;
	float fov_y_rad = 1.0f;     // whole angle
	float half_height_m = 1.0f; // orthographic
	float near_m = 0.1f;
	float far_m = std::numeric_limits<float>::infinity();
};

// What `nook bake` has put on the vertices.
enum class Baked
{
	none,
	visibility,
	difference, // to the level's volumes (`nook bake --volumes`)
};

struct LevelFile
{
	std::vector<Vertex> vertices;
	std::vector<std::uint32_t> indices;
	std::vector<Batch> batches;
	std::vector<Mask> masks;
	std::vector<Camera> cameras; // at least one
	Baked baked = Baked::none;
};

// Throws Failure.
LevelFile readLevel(const std::string& path);

// `level` with the triangles of the other one, which move.
void addMoving(LevelFile& level, const LevelFile& moving);
