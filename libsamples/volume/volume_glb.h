// SPDX-License-Identifier: GPL-3.0-or-later
// Reads and writes occlusion volumes as a binary glTF file: layout in docs/reference/volumes_file.md, structures in
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
	polygons, // compact: corners, which a vertex shader expands to volumes; the scene shows the polygons
	prisms,   // also the volumes' points and triangles; the scene shows the volumes
};

struct VolumeFileSettings
{
	VolumeLayout layout = VolumeLayout::polygons;
	bool compress = false;                  // EXT_meshopt_compression
	std::size_t most_bytes = kMaxFileBytes; // file size limit; larger files throw
};

// Additional memory for making the file, bytes per triangle of the level: VolumeSettings::written_bytes.
constexpr uint64_t writtenBytes(VolumeLayout layout)
{
	return layout == VolumeLayout::prisms ? 600 : 200;
}

struct VolumeFile
{
	std::string bytes;
	PackedVolumes packed; // its contents
};

// glTF 2.0 binary: one node and mesh per cluster, with 16-bit positions (KHR_mesh_quantization); further data for renderers is in
// buffer views listed in asset.extras.nook_volumes. `level`: its name; `generator`: "nook 1.0".
// Requires clusters. Throws Error (unsupported) if the file would exceed most_bytes, by default readFile's limit.
VolumeFile volumeGlb(const VolumeSet& volumes, const VolumeFileSettings& settings, std::string_view level,
					 std::string_view generator, const RunSettings& run);

// Metadata of a file besides its volumes.
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

// Positions are as rounded to 16 bits, in file order. Throws Error: file, or invalid_input.
VolumeSet readVolumes(const std::string& path);
VolumeSet readVolumes(const std::string& path, VolumeFileFacts& facts);

// True if `bytes` begin like a file of volumes, complete or not.
bool holdsVolumes(std::string_view bytes);

} // namespace nook
