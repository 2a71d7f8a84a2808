// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/kept_answers.h"

#include "core/content_hash.h"
#include "core/error.h"
#include "core/file.h"

#include <cstdlib>
#include <filesystem>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace nook
{
namespace
{

constexpr std::size_t kSumBytes = 32;

std::string folder()
{
	const char* const path = std::getenv(kAnswersFolder);
	std::error_code failed;
	return path != nullptr && std::filesystem::is_directory(path, failed) ? path : "";
}

std::string pathOf(const std::string& key)
{
	ContentHash hash;
	hash.add(NOOK_WORKER_VERSION);
	hash.add(key);
	return folder() + "/" + hash.text() + ".decoded";
}

std::string sumOf(std::string_view answer)
{
	ContentHash sum;
	sum.add(answer);
	return sum.text();
}

std::optional<std::string> answerOf(const std::string& path)
{
	std::string bytes;
	try
	{
		bytes = readFile(path);
	}
	catch (const Error&)
	{
		return std::nullopt;
	}
	if (bytes.size() < kSumBytes)
	{
		return std::nullopt;
	}
	const std::string sum = bytes.substr(bytes.size() - kSumBytes);
	bytes.resize(bytes.size() - kSumBytes);
	return sumOf(bytes) == sum ? std::optional(std::move(bytes)) : std::nullopt;
}

} // namespace

bool keepsAnswers()
{
	return !folder().empty();
}

KeptAnswer::KeptAnswer(const std::string& key) : m_path(pathOf(key)), m_answer(answerOf(m_path))
{
	if (m_answer)
	{
		return;
	}
	m_lock = ::open((m_path + ".lock").c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
	if (m_lock >= 0 && ::flock(m_lock, LOCK_EX) == 0) // else each for itself, as where a folder of a network has no locks
	{
		m_answer = answerOf(m_path);
	}
}

KeptAnswer::~KeptAnswer()
{
	if (m_lock >= 0)
	{
		::close(m_lock);
	}
}

void KeptAnswer::keep(std::string_view answer) const
{
	if (answer.size() > kMaxFileBytes - kSumBytes)
	{
		return;
	}
	try
	{
		writeFile(m_path, std::string(answer) + sumOf(answer));
	}
	catch (const Error&)
	{
	}
}

} // namespace nook
