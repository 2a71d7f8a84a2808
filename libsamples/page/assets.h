// SPDX-License-Identifier: GPL-3.0-or-later
// The page's files, embedded in the library (embed.cmake).
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

} // namespace nook::assets
