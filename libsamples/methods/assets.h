// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels' texts, embedded in the library.
#pragma once

#include <span>
#include <string_view>

namespace nook::assets
{

extern const std::string_view aov_faces_glsl;
extern const std::string_view aov_fragment_glsl;
extern const std::string_view aov_mask_fragment_glsl;
extern const std::string_view aov_mask_resolve_glsl;
extern const std::string_view aov_resolve_glsl;
extern const std::string_view aov_vertex_glsl;
extern const std::string_view aov_sparse_glsl;
extern const std::string_view camera_glsl;
extern const std::string_view depth_glsl;
extern const std::string_view reconstruct_glsl;
extern const std::string_view form_factor_glsl;
extern const std::string_view mask_glsl;
extern const std::string_view volume_glsl;

// runtime/nook_block.h
extern const std::string_view nook_block_h;

// rays.json: the `rays` recipes, as written by `nook fit`, without their errors (docs/measurements/rays.json).
extern const std::string_view rays_json;

// All screen-space kernels, each after those that it uses.
extern const std::span<const std::string_view> screen_kernels;

} // namespace nook::assets
