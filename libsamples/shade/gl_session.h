// SPDX-License-Identifier: GPL-3.0-or-later
// A context that stays, with the programs that were linked in it: of many pictures, drawn one after another, each shader is
// compiled once.
#pragma once

#include "shade/gl_context.h"

#include <map>
#include <optional>
#include <string>

namespace nook
{

class GlSession
{
public:
	// Throws Error (unsupported), as GlContext does.
	explicit GlSession(std::optional<int> device = std::nullopt);
	~GlSession();
	GlSession(const GlSession&) = delete;
	GlSession& operator=(const GlSession&) = delete;

	// Current on this thread from here on.
	const GlContext& use() const;

	// For GlPass; stays while the session does. Requires use(). Throws Error (runtime) with the compiler's first line.
	unsigned program(const std::string& fragment_source);

private:
	GlContext m_context;
	std::map<std::string, unsigned> m_programs; // by source
};

} // namespace nook
