// SPDX-License-Identifier: GPL-3.0-or-later
// Reports → JSON, for a file and for the page.
#pragma once

#include "error_report/error_report.h"

#include <nlohmann/json.hpp>

namespace nook
{

// What errorReportJson() writes.
nlohmann::ordered_json errorReportFields(const ErrorReport& report);

} // namespace nook
