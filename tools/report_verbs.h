// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs below nook report, each in a file of its own.
#pragma once

#include "options.h"

namespace nook
{

// `nook report error`, of the component reports.
Verb addReportError(CLI::App& report);

// `nook report live`, likewise.
Verb addReportLive(CLI::App& report);

// The same two, or where the component is not in this build verbs that say so.
Verb addReportErrorVerb(CLI::App& report);
Verb addReportLiveVerb(CLI::App& report);

} // namespace nook
