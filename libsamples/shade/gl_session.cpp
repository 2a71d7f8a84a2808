// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/gl_session.h"

#include <epoxy/gl.h>

namespace nook
{

GlSession::GlSession(std::optional<int> device) : m_context(GlApi::core, device) {}

GlSession::~GlSession()
{
	m_context.use();
	for (const auto& [source, program] : m_programs)
	{
		glDeleteProgram(program);
	}
}

const GlContext& GlSession::use() const
{
	m_context.use();
	return m_context;
}

unsigned GlSession::program(const std::string& fragment_source)
{
	const auto found = m_programs.find(fragment_source);
	return found != m_programs.end() ? found->second
									 : m_programs.emplace(fragment_source, fragmentProgram(fragment_source)).first->second;
}

} // namespace nook
