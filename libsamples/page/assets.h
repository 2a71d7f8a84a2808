// SPDX-License-Identifier: GPL-3.0-or-later
// The page's files, put into the library when it is built (embed.cmake).
#pragma once

#include <string_view>

namespace nook::assets
{

extern const std::string_view page_html;
extern const std::string_view page_css;
extern const std::string_view charts_js;
extern const std::string_view pictures_js;
extern const std::string_view page_js;
extern const std::string_view frame_html;
extern const std::string_view parts_js;
extern const std::string_view tune_html;
extern const std::string_view tune_css;
extern const std::string_view tune_page_js;
extern const std::string_view error_html;
extern const std::string_view error_css;
extern const std::string_view error_charts_js;
extern const std::string_view error_pictures_js;
extern const std::string_view error_page_js;
extern const std::string_view live_html;
extern const std::string_view live_css;
extern const std::string_view live_worker_js;
extern const std::string_view live_cells_js;
extern const std::string_view live_gl_js;
extern const std::string_view live_scene_js;
extern const std::string_view live_shade_js;
extern const std::string_view live_pattern_js;
extern const std::string_view live_page_js;

} // namespace nook::assets
