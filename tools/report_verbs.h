// SPDX-License-Identifier: GPL-3.0-or-later
// The verbs below nook report, each in a file of its own.
#pragma once

#include <CLI/CLI.hpp>

#include <functional>

namespace nook
{

// Adds `nook report error`; what it does once its options have been parsed.
std::function<void()> addReportError(CLI::App& report, CLI::App*& app);

} // namespace nook
