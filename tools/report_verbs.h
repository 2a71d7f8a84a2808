// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs below nook report, each in a file of its own.
#pragma once

#include "options.h"

namespace nook
{

// `nook report error`, of the component reports.
Verb addReportError(CLI::App& report);

// The same, or where the component is not in this build a verb that says so.
Verb addReportErrorVerb(CLI::App& report);

} // namespace nook
