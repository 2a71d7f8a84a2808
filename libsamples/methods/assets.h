// SPDX-License-Identifier: GPL-3.0-or-later
// The kernels' texts, inside the library.
#pragma once

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
extern const std::string_view debug_glsl;
extern const std::string_view debug_statvo_glsl;
extern const std::string_view depth_glsl;
extern const std::string_view depth_levels_glsl;
extern const std::string_view vo_area_glsl;
extern const std::string_view vo_glsl;
extern const std::string_view alchemy_glsl;
extern const std::string_view reconstruct_glsl;
extern const std::string_view tables_glsl;
extern const std::string_view statvo_tables_glsl;
extern const std::string_view statvo_flags_glsl;
extern const std::string_view statvo_glsl;
extern const std::string_view rivals_crytek_glsl;
extern const std::string_view rivals_hbao_glsl;
extern const std::string_view rivals_sao_glsl;
extern const std::string_view rivals_volumetric_glsl;
extern const std::string_view form_factor_glsl;
extern const std::string_view mask_glsl;
extern const std::string_view volume_glsl;

} // namespace nook::assets
