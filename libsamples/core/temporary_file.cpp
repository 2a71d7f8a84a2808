// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/temporary_file.h"

#include "core/system.h"

#include <cerrno>
#include <csignal>
#include <utility>

namespace nook
{

// A handler may run at any time in any thread, so names are stored in entries that never move and are never freed.
struct TemporaryFile::Entry
{
	enum State
	{
		unused,
		changing,
		valid,
	};
	std::atomic<State> state = changing;
	bool is_folder = false;
	char path[4096] = "";
	Entry* next = nullptr;
};

std::atomic<TemporaryFile::Entry*> TemporaryFile::s_entries{nullptr};

namespace
{

constexpr int kEnding = -1;
std::atomic<int> held{0};    // nesting depth of holds, or kEnding
std::atomic<int> pending{0}; // signal received meanwhile
static_assert(std::atomic<int>::is_always_lock_free && std::atomic<void*>::is_always_lock_free);

// While another thread ends the program, no file may be created or renamed.
void waitIfEnding()
{
	while (held == kEnding)
	{
		waitForEnd();
	}
}

// Runs in a signal handler: async-signal-safe calls only.
void end(int signal)
{
	const int before = errno;
	int free = 0;
	while (!held.compare_exchange_strong(free, kEnding))
	{
		if (free == kEnding)
		{
			return; // a second signal
		}
		pending = signal;
		if (held != 0)
		{
			errno = before;
			return; // ~SignalsHeld() handles it
		}
		free = 0;
	}
	removeTemporaryFiles();
	endBySignal(signal);
}

} // namespace

void handleSignals()
{
	onEndingSignals(&end);
}

void removeTemporaryFiles()
{
	for (TemporaryFile::Entry* entry = TemporaryFile::s_entries; entry != nullptr; entry = entry->next)
	{
		if (entry->state == TemporaryFile::Entry::valid && !entry->is_folder)
		{
			removeFile(entry->path);
		}
	}
	// Each pass removes at least the innermost folders.
	constexpr int kDepth = 16;
	for (int i = 0; i < kDepth; ++i)
	{
		for (TemporaryFile::Entry* entry = TemporaryFile::s_entries; entry != nullptr; entry = entry->next)
		{
			if (entry->state == TemporaryFile::Entry::valid && entry->is_folder)
			{
				removeFolder(entry->path);
			}
		}
	}
}

SignalsHeld::SignalsHeld()
{
	for (int count = held; count == kEnding || !held.compare_exchange_weak(count, count + 1); count = held)
	{
		waitIfEnding();
	}
}

SignalsHeld::~SignalsHeld()
{
	held -= 1;
	const int signal = held == 0 ? pending.exchange(0) : 0;
	if (signal != 0)
	{
		std::raise(signal);
	}
}

TemporaryFile::Entry* TemporaryFile::entryOf(const std::string& path, bool is_folder)
{
	Entry* entry = s_entries;
	for (; entry != nullptr; entry = entry->next)
	{
		Entry::State unused = Entry::unused;
		if (entry->state.compare_exchange_strong(unused, Entry::changing))
		{
			break;
		}
	}
	if (entry == nullptr)
	{
		entry = new Entry; // NOLINT: there is no moment at which no handler may read it
		entry->next = s_entries;
		while (!s_entries.compare_exchange_weak(entry->next, entry))
		{
		}
	}
	const bool fits = path.size() < sizeof entry->path; // longer paths cannot exist
	entry->path[fits ? path.copy(entry->path, path.size()) : 0] = '\0';
	entry->is_folder = is_folder;
	entry->state = Entry::valid;
	return entry;
}

TemporaryFile::TemporaryFile(std::string path) : m_path(std::move(path)), m_entry(entryOf(m_path, false))
{
	waitIfEnding();
}

TemporaryFile::TemporaryFile(TemporaryFile&& other) noexcept
	: m_path(std::move(other.m_path)), m_entry(std::exchange(other.m_entry, nullptr))
{
}

TemporaryFile::~TemporaryFile()
{
	if (m_entry != nullptr)
	{
		removeFile(m_path.c_str());
		m_entry->state = Entry::unused;
	}
}

void TemporaryFile::rename(const std::string& target, std::error_code& failed)
{
	std::filesystem::rename(nativePath(m_path), nativePath(target), failed);
	if (!failed)
	{
		m_entry->state = Entry::unused;
		m_entry = nullptr;
	}
}

namespace
{

std::string textOf(const std::filesystem::path& path)
{
	const std::u8string text = path.u8string();
	return {text.begin(), text.end()};
}

} // namespace

void NewFolders::make(const std::filesystem::path& path, std::error_code& failed)
{
	failed.clear();
	std::filesystem::path so_far;
	for (const std::filesystem::path& part : path)
	{
		so_far /= part;
		if (part.empty() || std::filesystem::is_directory(so_far, failed))
		{
			continue;
		}
		const SignalsHeld both; // creation and registration must not be separated
		if (std::filesystem::create_directory(so_far, failed))
		{
			m_entries.push_back(TemporaryFile::entryOf(textOf(so_far), true));
		}
		if (failed)
		{
			return;
		}
	}
}

NewFolders::~NewFolders()
{
	for (; !m_entries.empty(); m_entries.pop_back())
	{
		removeFolder(m_entries.back()->path);
		m_entries.back()->state = TemporaryFile::Entry::unused;
	}
}

} // namespace nook
