// SPDX-License-Identifier: GPL-3.0-or-later
// Occlusion volumes ↔ one binary glTF file: its layout is in docs/reference/volumes_file.md, its numbers in
// volume/runtime/nook_volumes.h.
#pragma once

#include "core/file.h"
#include "core/progress.h"
#include "volume/packed.h"
#include "volume/volumes.h"

#include <cstddef>
#include <string>
#include <string_view>

namespace nook
{

enum class VolumeLayout
{
	polygons, // compact: corners, which a vertex shader makes volumes of; the scene shows the polygons
	prisms,   // the volumes' points and triangles as well; the scene shows the volumes
};

struct VolumeFileSettings
{
	VolumeLayout layout = VolumeLayout::polygons;
	bool compress = false;                  // EXT_meshopt_compression
	std::size_t most_bytes = kMaxFileBytes; // of the file; larger ones are refused
};

// Memory that making the file takes, bytes a triangle of the level: VolumeSettings::written_bytes.
constexpr uint64_t writtenBytes(VolumeLayout layout)
{
	return layout == VolumeLayout::prisms ? 600 : 200;
}

struct VolumeFile
{
	std::string bytes;
	PackedVolumes packed; // what is in it
};

// glTF 2.0 binary: a node and a mesh for each cluster, with 16-bit positions (KHR_mesh_quantization), and what a renderer needs
// besides as buffer views that asset.extras.nook_volumes names. `level`: its name; `generator`: "nook 1.0".
// Requires clusters. Throws Error (unsupported) for a file that would be larger than that, readFile's own limit.
VolumeFile volumeGlb(const VolumeSet& volumes, const VolumeFileSettings& settings, std::string_view level,
					 std::string_view generator, const RunSettings& run);

// What a file says of itself beside its volumes.
struct VolumeFileFacts
{
	std::string level;
	std::string generator;
	VolumeLayout layout = VolumeLayout::polygons;
	bool compressed = false;
	double greatest_error_m = 0.0;
	std::size_t vertices = 0; // of prisms
	std::size_t indices = 0;
	std::size_t bytes = 0;
};

// Positions as 16 bits leave them, in the file's order. Throws Error: file, or invalid_input.
VolumeSet readVolumes(const std::string& path);
VolumeSet readVolumes(const std::string& path, VolumeFileFacts& facts);

// True where `bytes` begin as a file of volumes does, whole or not.
bool holdsVolumes(std::string_view bytes);

} // namespace nook
