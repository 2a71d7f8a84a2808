// SPDX-License-Identifier: GPL-3.0-or-later
// A plan and its folder: written whole, said, asked.
#pragma once

#include "summary.h"

#include "farm/folder_lock.h"
#include "farm/plan.h"

#include <memory>
#include <string>
#include <vector>

namespace nook
{

// Makes the folder and has it to itself. Throws Error: file; runtime where another plans or runs there.
std::unique_ptr<FolderLock> openPlanFolder(const std::string& folder);

// Replaces the plan there, where it is one of the same title, and forgets what its jobs made from other inputs. Throws Error: usage
// (a plan of another title), runtime (jobs of another plan run), file.
void writePlan(const Plan& plan, const std::string& folder);

// The whole name, whether anything is there or not.
std::string wholeName(const std::string& path);

// The whole name of a root that is there and has these folders in it. Throws Error: file, usage.
std::string rootFolder(const std::string& root, const std::vector<std::string>& folders);

// To the file of --json, and for people where that is not standard output.
void tellPlan(const std::string& json, const Summary& summary, const std::string& text);

// What it is, takes, and how it is started: for people, and the same facts for --json.
std::string planText(const Plan& plan, const std::string& folder, bool written);
void addPlanFacts(Summary& summary, const Plan& plan);

// nook plan --status.
Plan readPlanFolder(const std::string& folder);
std::string statusText(const Plan& plan, const std::string& folder);
void addStatusFacts(Summary& summary, const Plan& plan, const std::string& folder);

} // namespace nook
