// SPDX-License-Identifier: MIT
// Reads triangles, masks and cameras from files of `nook level` or `nook bake`. Not a general glTF reader: `nook level` converts
// any level to such a file.
#pragma once

#include <glm/mat4x4.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

// Ends the program with one line of text and an exit code.
struct Failure : std::runtime_error
{
	Failure(int exit_code, const std::string& line) : std::runtime_error(line), code(exit_code) {}
	int code; // 1 usage, 2 file, 3 invalid input, 4 run time, 5 not supported
};

struct Vertex
{
	glm::vec3 position{0.0f}; // world space, metres, y up
	glm::vec3 normal{0.0f};   // 0: use the triangle's normal
	glm::vec2 uv{0.0f};
	glm::vec2 baked{1.0f}; // from `nook bake`: visibility or difference, front and back
};

// Triangles of one draw call.
struct Batch
{
	std::uint32_t first_index = 0;
	std::uint32_t index_count = 0;
	int mask = -1;       // index into LevelFile::masks, or -1
	float alpha = 1.0f;  // the surface exists where alpha × mask ≥ cutoff
	float cutoff = 0.0f; // 0: everywhere
	bool moves = false;  // drawn after all static batches
};

struct Mask
{
	int width = 0;
	int height = 0;
	int wrap_u = 0; // as in glTF and OpenGL
	int wrap_v = 0;
	std::vector<std::uint8_t> alpha; // rows from the top
};

struct Camera
{
	std::string name;
	glm::mat4 world_from_camera{1.0f}; // rotation and translation; the camera looks down −z
	bool orthographic = false;
	float fov_y_rad = 1.0f;     // full angle
	float half_height_m = 1.0f; // orthographic
	float near_m = 0.1f;
	float far_m = std::numeric_limits<float>::infinity();
};

// Values that `nook bake` stored at the vertices.
enum class Baked
{
	none,
	visibility,
	difference, // from the level's volumes (`nook bake --volumes`)
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

// Adds the triangles of `moving` to `level`.
void addMoving(LevelFile& level, const LevelFile& moving);
